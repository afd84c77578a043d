// Rays, and how far what is known of them may be off.

// An operation may be off by so much of its result: one ulp, since WGSL leaves the direction of rounding open.
const EPSILON = 1.0 / 8388608.0;

// 2^-100: more than what flushed denormals can take from a sum, and far from being one.
const TINY = 7.888609e-31;

// 2^100: farther than any hit.
const FAR = 1.2676506e30;

// Along an axis where a direction is 0, planes so many parts of all distances apart are as far apart as the line is long.
const STEEP = 524288.0;

// 2^-20: distances below are not told apart there.
const FINE = 9.5367432e-7;

// The bits of 2^30, 2^-40, 2^40 and 2^-60: coordinates, largest and other components of directions that are calculated
// with. No product here overflows, and what vanishes is covered by TINY.
const COORDINATES = 0x4e800000u;
const SHORTEST = 0x2b800000u;
const LONGEST = 0x53800000u;
const FLATTEST = 0x21800000u;

const INFINITE = 0x7f800000u;

// For tests: whether to compute as a GPU may that rounds otherwise, each step an ulp off.
override ROUGH: bool = false;

fn rough1(x: f32) -> f32 {
    if !ROUGH {
        return x;
    }
    let bits = bitcast<u32>(x);
    return x + x * select(-0.5 * EPSILON, 0.5 * EPSILON, ((bits ^ (bits >> 5u)) & 1u) == 1u);
}

fn rough(v: vec3<f32>) -> vec3<f32> {
    return vec3(rough1(v.x), rough1(v.y), rough1(v.z));
}

struct Line {
    origin: vec3<f32>,
    direction: vec3<f32>,
    // One over the direction; 0 where its sign is not known, and 1 where it is 0.
    inverse: vec3<f32>,
    // By how much of itself the inverse may be off besides rounding; FAR where the sign is not known, -1 where it is 0.
    vague: vec3<f32>,
    // By how much the origin and the direction may be off.
    off: vec3<f32>,
    error: vec3<f32>,
    // A bit per axis along which it falls.
    descending: u32,
    // The axis along which it is fastest, and the direction along the other two over that.
    major: u32,
    slope: vec2<f32>,
    // How far the coordinates of a point at depth 1 may be off for the slopes' sake.
    slope_error: f32,
    // One over the direction along the major axis, and by how much of itself a parameter may be off.
    along: f32,
    tolerance: f32,
    // Whether the rest means anything: if not, the ray is not for this arithmetic.
    usable: bool,
}

// The bits of a number without its sign order as magnitudes do.
fn magnitude(x: f32) -> u32 {
    return bitcast<u32>(x) & 0x7fffffffu;
}

// The coordinates in cyclic order, that of the axis last.
fn ordered(v: vec3<f32>, axis: u32) -> vec3<f32> {
    return select(select(v, v.zxy, axis == 1u), v.yzx, axis == 0u);
}

fn of_axis(v: vec3<f32>, axis: u32) -> f32 {
    return select(select(v.x, v.y, axis == 1u), v.z, axis == 2u);
}

// A ray and how far its origin and its direction may be off.
fn line(origin: vec3<f32>, direction: vec3<f32>, off: vec3<f32>, error: vec3<f32>) -> Line {
    var result: Line;
    result.origin = origin;
    result.direction = direction;
    result.off = off;
    result.error = error;
    let far_out = max(max(magnitude(origin.x), magnitude(origin.y)), magnitude(origin.z));
    let size = vec3(magnitude(direction.x), magnitude(direction.y), magnitude(direction.z));
    let largest = max(max(size.x, size.y), size.z);
    let lost = max(max(magnitude(off.x), magnitude(off.y)), magnitude(off.z));
    result.usable = max(far_out, lost) <= COORDINATES && largest >= SHORTEST && largest <= LONGEST;
    if !result.usable {
        return result;
    }
    for (var axis = 0u; axis < 3u; axis++) {
        let d = of_axis(direction, axis);
        let bits = magnitude(d);
        let uncertain = of_axis(error, axis);
        if bits == 0u && uncertain == 0.0 {
            result.inverse[axis] = 1.0;
            result.vague[axis] = -1.0;
        } else if bits < FLATTEST || abs(d) <= 4.0 * uncertain {
            // Vanishing ones are for who has infinities; unknown ones decide nothing.
            result.usable = result.usable && uncertain != 0.0;
            result.inverse[axis] = 0.0;
            result.vague[axis] = FAR;
        } else {
            result.inverse[axis] = rough1(rough1(1.0 / d));
            result.vague[axis] = 2.0 * uncertain / abs(d);
        }
    }
    result.descending = select(0u, 1u, result.inverse.x < 0.0) | select(0u, 2u, result.inverse.y < 0.0)
        | select(0u, 4u, result.inverse.z < 0.0);
    result.major = select(select(2u, 1u, size.y == largest), 0u, size.x == largest);
    let turned = ordered(direction, result.major);
    let turned_error = ordered(error, result.major);
    result.along = of_axis(result.inverse, result.major);
    let length = abs(turned.z);
    result.usable = result.usable && turned_error.z * 64.0 <= length;
    result.slope = rough(rough(vec3(turned.xy / turned.z, 0.0))).xy;
    let steepest = max(abs(result.slope.x), abs(result.slope.y));
    let bent = (max(turned_error.x, turned_error.y) + turned_error.z) / length;
    result.slope_error = 12.0 * EPSILON * steepest + 2.0 * bent;
    result.tolerance = 3.0 / 262144.0 + 2.0 * turned_error.z / length;
    return result;
}

// How the planes of a structure lie on a line: a plane at `p` is entered at `p * scale + enter` or later, and left at
// `p * scale + leave` or earlier.
struct Planes {
    scale: vec3<f32>,
    enter: vec3<f32>,
    leave: vec3<f32>,
}

// Of planes at `low + number * step`, in a box that ends at `high`; by position if the step is 1 and `low` counts as 0.
fn planes(line: Line, start: vec3<f32>, step: vec3<f32>, low: vec3<f32>, high: vec3<f32>) -> Planes {
    let reach = abs(line.origin) + max(abs(low), abs(high)) + (high - low);
    // Nothing in the box is farther. Where the direction is 0, what is before the origin ends before 0, and what is behind
    // begins behind all that counts: closed containment, but for the margin.
    let longest = 2.0 * of_axis(reach, line.major) * abs(line.along);
    let level = line.vague < vec3(0.0);
    let steep = longest * STEEP / max(reach + line.off * STEEP, vec3(FINE));
    let inverse = select(line.inverse, steep, level);
    let vague = clamp(line.vague, vec3(0.0), vec3(1.0));
    // 20 roundings at most, each of something within reach.
    let margin = abs(inverse) * (reach * (32.0 * EPSILON + vague) + 2.0 * line.off + TINY)
        + select(vec3(TINY), vec3(2.0 * longest), level);
    let base = rough(rough(start - line.origin) * inverse);
    let unknown = line.vague >= vec3(1.0);
    let enter = select(base - margin, vec3(-FAR), unknown);
    let leave = select(base + margin, vec3(FAR), unknown);
    return Planes(rough(inverse * step), rough(enter), rough(leave));
}
