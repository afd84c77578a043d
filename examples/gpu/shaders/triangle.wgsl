// Whether a line meets a triangle, as far as this arithmetic can tell, and where.

const MISS = 0u;
const PERHAPS = 1u;
const HIT = 2u;

struct Meeting {
    verdict: u32,
    // The parameter that the library finds, if it finds one, is not less and not more.
    near: f32,
    far: f32,
}

fn sum(v: vec3<f32>) -> f32 {
    return v.x + v.y + v.z;
}

fn turned(v: vec3<f32>, w: vec3<f32>) -> vec3<f32> {
    return v.yzx * w.zxy;
}

// Between which parameters the line crosses the triangle's plane.
fn cross_plane(line: Line, triangle: Corners) -> vec2<f32> {
    let d = rough(triangle.b - triangle.a);
    let e = rough(triangle.c - triangle.a);
    let normal = rough(rough(turned(d, e)) - rough(turned(e, d)));
    // Eight roundings from here to the sums, each of something not larger than this, and what corners may be off.
    let large_d = abs(d) + TINY;
    let large_e = abs(e) + TINY;
    let lost = 2.0 * triangle.off;
    let error = (turned(large_d, large_e) + turned(large_e, large_d)) * (10.0 * EPSILON)
        + lost * (sum(large_d) + sum(large_e) + 2.0 * lost);
    let size = abs(normal) + error;
    // From the nearest corner: what is behind a start close to a large triangle is known to be.
    let a = rough(triangle.a - line.origin);
    let b = rough(triangle.b - line.origin);
    let c = rough(triangle.c - line.origin);
    var to_plane = select(b, a, sum(abs(a)) < sum(abs(b)));
    to_plane = select(c, to_plane, sum(abs(to_plane)) < sum(abs(c)));
    let distance = rough1(sum(rough(normal * to_plane)));
    let distance_error = sum(error * abs(to_plane) + size * (line.off + triangle.off)) + TINY * (1.0 + sum(abs(to_plane)));
    let speed = rough1(sum(rough(normal * line.direction)));
    let speed_error = sum(error * abs(line.direction) + size * line.error) + TINY * (1.0 + sum(abs(line.direction)));
    if abs(speed) <= 4.0 * speed_error {
        return vec2(-FAR, FAR);
    }
    let t = rough1(rough1(distance / speed));
    let about = 1.5 * ((distance_error + abs(t) * speed_error) / abs(speed)) + 4.0 * EPSILON * abs(t);
    return vec2(t - about, t + about);
}

// A corner as the ray sees it that runs along the third axis.
fn sheared(corner: vec3<f32>, slope: vec2<f32>) -> vec2<f32> {
    let moved = rough(vec3(slope * corner.z, 0.0)).xy;
    return rough(vec3(corner.xy - moved, 0.0)).xy;
}

// Twice the area that the ray spans with an edge.
fn edge(from_corner: vec2<f32>, to_corner: vec2<f32>) -> f32 {
    return rough1(rough1(from_corner.x * to_corner.y) - rough1(from_corner.y * to_corner.x));
}

// The shear test of Woop, Benthin and Wald, Watertight ray/triangle intersection, JCGT 2013, with bounds on all errors.
fn meet(line: Line, triangle: Corners) -> Meeting {
    let origin = ordered(line.origin, line.major);
    let a = rough(ordered(triangle.a, line.major) - origin);
    let b = rough(ordered(triangle.b, line.major) - origin);
    let c = rough(ordered(triangle.c, line.major) - origin);
    let off = triangle.off + max(max(line.off.x, line.off.y), line.off.z);
    let p = sheared(a, line.slope);
    let q = sheared(b, line.slope);
    let r = sheared(c, line.slope);
    let u = edge(r, q);
    let v = edge(p, r);
    let w = edge(q, p);

    let depth = max(max(abs(a.z), abs(b.z)), abs(c.z));
    let spread = (abs(p.x) + abs(p.y)) + (abs(q.x) + abs(q.y)) + (abs(r.x) + abs(r.y));
    let error = (line.slope_error * depth + 4.0 * EPSILON * spread + 4.0 * off + TINY) * (spread + 8.0 * off) + TINY;
    let least = min(min(u, v), w);
    let most = max(max(u, v), w);
    if most > error && least < -error {
        return Meeting(MISS, 0.0, 0.0);
    }

    // Wherever it is met, that is between its corners, and in its plane.
    let slack = 4.0 * EPSILON * depth + 4.0 * off + TINY;
    let first = (min(min(a.z, b.z), c.z) - slack) * line.along;
    let second = (max(max(a.z, b.z), c.z) + slack) * line.along;
    let plane = cross_plane(line, triangle);
    let near = max(min(first, second), plane.x);
    let far = min(max(first, second), plane.y);
    if near > far {
        return Meeting(MISS, 0.0, 0.0);
    }
    let verdict = select(PERHAPS, HIT, least > error || most < -error);
    return Meeting(verdict, near - abs(near) * line.tolerance - TINY, far + abs(far) * line.tolerance + TINY);
}
