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

// The shear test of Woop, Benthin and Wald, Watertight ray/triangle intersection, JCGT 2013, with bounds on all errors.
fn meet(line: Line, triangle: Corners) -> Meeting {
    let origin = ordered(line.origin, line.major);
    let a = ordered(triangle.a, line.major) - origin;
    let b = ordered(triangle.b, line.major) - origin;
    let c = ordered(triangle.c, line.major) - origin;
    let off = triangle.off + max(max(line.off.x, line.off.y), line.off.z);
    let p = a.xy - line.slope * a.z;
    let q = b.xy - line.slope * b.z;
    let r = c.xy - line.slope * c.z;
    let u = r.x * q.y - r.y * q.x;
    let v = p.x * r.y - p.y * r.x;
    let w = q.x * p.y - q.y * p.x;

    let depths = vec3(a.z, b.z, c.z);
    let depth = abs(a.z) + abs(b.z) + abs(c.z);
    let spread = (abs(p.x) + abs(p.y)) + (abs(q.x) + abs(q.y)) + (abs(r.x) + abs(r.y));
    let error = (line.slope_error * depth + 4.0 * EPSILON * spread + 4.0 * off + TINY) * (spread + 8.0 * off) + TINY;
    let least = min(min(u, v), w);
    let most = max(max(u, v), w);
    if most > error && least < -error {
        return Meeting(MISS, 0.0, 0.0);
    }

    // Wherever it is met, that is between its corners.
    let slack = 4.0 * EPSILON * depth + 4.0 * off + TINY;
    var low = min(min(a.z, b.z), c.z) - slack;
    var high = max(max(a.z, b.z), c.z) + slack;
    var verdict = PERHAPS;
    if least > error || most < -error {
        verdict = HIT;
        let determinant = (u + v) + w;
        let area = abs(determinant);
        if area > 16.0 * error {
            let d = b.z - a.z;
            let e = c.z - a.z;
            let at = a.z + (v * d + w * e) / determinant;
            let extent = abs(d) + abs(e);
            let about = 6.0 * error * extent / area + 16.0 * EPSILON * (depth + extent) + 4.0 * off + TINY;
            low = max(low, at - about);
            high = min(high, at + about);
        }
    }
    let first = low * line.along;
    let second = high * line.along;
    let near = min(first, second);
    let far = max(first, second);
    return Meeting(verdict, near - abs(near) * line.tolerance - TINY, far + abs(far) * line.tolerance + TINY);
}
