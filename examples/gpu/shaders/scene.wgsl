// The words of an asset as they lie in the file, and where in them its parts are.

// A structure with its primitives; the first part is the scene itself.
struct Part {
    structure: u32,
    // Words at which something begins.
    header: u32,
    list: u32,
    vertices: u32,
    indices: u32,
    // Bits 0, 1: bytes of a number in the list over 2; bit 2: vertices are on a lattice; bit 3: corners take 16 bits.
    form: u32,
    // Of a BVH, the link to begin with.
    root: u32,
    primitives: u32,
}

const KD_TREE = 0u;
const DUAL_SPLIT = 1u;
const BVH = 2u;

// Words before the nodes of all three structures, and before the box in them.
const HEADER_WORDS = 10u;
const BOX_WORD = 4u;

// Words of an instance, and where in it things are.
const INSTANCE_WORDS = 24u;
const INVERSE = 9u;
const TRANSLATION = 18u;
const SCENE = 21u;
const MASK = 22u;
const FIRST = 23u;

// Which structures there are, a bit each, and whether the scene's primitives are placed parts: what is not there is not
// compiled.
override STRUCTURES: u32 = 7u;
override PLACED: bool = false;

@group(0) @binding(0) var<storage, read> parts: array<Part>;

fn word(index: u32) -> u32 {
    let two = pair(index >> 1u);
    return select(two.x, two.y, (index & 1u) == 1u);
}

fn half_word(start: u32, index: u32) -> u32 {
    return (word(start + (index >> 1u)) >> ((index & 1u) * 16u)) & 0xffffu;
}

fn byte(start: u32, index: u32) -> u32 {
    return (word(start + (index >> 2u)) >> ((index & 3u) * 8u)) & 0xffu;
}

fn number(index: u32) -> f32 {
    return bitcast<f32>(word(index));
}

fn vector(index: u32) -> vec3<f32> {
    return vec3(number(index), number(index + 1u), number(index + 2u));
}

// The primitive behind a reference.
fn listed(part: Part, reference: u32) -> u32 {
    switch part.form & 3u {
        case 1u: { return half_word(part.list, reference); }
        case 2u: { return word(part.list + reference); }
        default: { return reference; }
    }
}

// From plane to plane of a lattice of 16 bits over a box.
fn lattice_step(low: vec3<f32>, high: vec3<f32>) -> vec3<f32> {
    return (high - low) / 65535.0 * (1.0 + 1.0 / 4194304.0);
}

struct Corners {
    a: vec3<f32>,
    b: vec3<f32>,
    c: vec3<f32>,
    // By how much a coordinate may be off.
    off: f32,
}

fn corners(part: Part, triangle: u32) -> Corners {
    var at: vec3<u32>;
    if (part.form & 8u) != 0u {
        let first = triangle * 3u;
        at = vec3(
            half_word(part.indices, first),
            half_word(part.indices, first + 1u),
            half_word(part.indices, first + 2u),
        );
    } else if (part.form & 16u) != 0u {
        // Bytes behind a first vertex for each 64 triangles.
        let bytes = part.indices + ((part.primitives + 63u) >> 6u);
        let first = triangle * 3u;
        at = vec3(byte(bytes, first), byte(bytes, first + 1u), byte(bytes, first + 2u))
            + vec3(word(part.indices + (triangle >> 6u)));
    } else {
        let first = part.indices + triangle * 3u;
        at = vec3(word(first), word(first + 1u), word(first + 2u));
    }
    if (part.form & 4u) == 0u {
        let first = vec3(part.vertices) + at * 3u;
        return Corners(vector(first.x), vector(first.y), vector(first.z), 0.0);
    }
    // The frame stands before the vertices. What the lattice's arithmetic may be off here, the bounds make up for.
    let low = vector(part.vertices - 6u);
    let high = vector(part.vertices - 3u);
    let step = lattice_step(low, high);
    let reach = abs(low) + (high - low);
    let off = 16.0 * EPSILON * max(max(reach.x, reach.y), reach.z) + TINY;
    let a = on_lattice(part.vertices, at.x, low, step);
    let b = on_lattice(part.vertices, at.y, low, step);
    let c = on_lattice(part.vertices, at.z, low, step);
    return Corners(a, b, c, off);
}

fn on_lattice(vertices: u32, vertex: u32, low: vec3<f32>, step: vec3<f32>) -> vec3<f32> {
    let first = vertex * 3u;
    let planes = vec3(
        half_word(vertices, first),
        half_word(vertices, first + 1u),
        half_word(vertices, first + 2u),
    );
    return rough(low + rough(vec3<f32>(planes) * step));
}
