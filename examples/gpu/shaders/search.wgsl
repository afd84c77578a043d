// Queries: the closest hit, or whether there is one, with a bound around everything that is not certain.

const NONE = 0xffffffffu;
const UNSURE = 0xfffffffeu;

// 1 + 2^-15: what lies before a parameter that the library finds, the real one included, lies before this times it.
const BEYOND = 1.0 + 1.0 / 32768.0;

struct Search {
    // Where hits count.
    from_t: f32,
    to_t: f32,
    // The certain hit that ends first, and between which parameters it is.
    best: u32,
    // The word of the instance that it is in, or NONE.
    owner: u32,
    near: f32,
    far: f32,
    // Where the first of all others begins that may be hits.
    rival: f32,
    // Whether everything was within what can be calculated with.
    usable: bool,
}

// What is known of a search when all is done: a primitive, NONE or UNSURE.
fn verdict(search: Search) -> u32 {
    if !search.usable {
        return UNSURE;
    }
    return select(search.best, UNSURE, search.rival <= search.far);
}

// Takes what a line and a triangle have in common.
fn take(search: ptr<function, Search>, primitive: u32, owner: u32, meeting: Meeting) {
    if meeting.verdict == MISS || meeting.far < (*search).from_t || meeting.near > (*search).to_t {
        return;
    }
    if meeting.near > (*search).far || primitive == (*search).best {
        return;
    }
    let certain = meeting.verdict == HIT && meeting.near >= (*search).from_t && meeting.far <= (*search).to_t;
    if certain && meeting.far < (*search).far {
        (*search).rival = min((*search).rival, (*search).near);
        (*search).best = primitive;
        (*search).owner = owner;
        (*search).near = meeting.near;
        (*search).far = meeting.far;
    } else {
        (*search).rival = min((*search).rival, meeting.near);
    }
}

fn end_of(search: ptr<function, Search>) -> f32 {
    return min((*search).far, (*search).to_t) * BEYOND;
}

// Primitives tested.
var<private> tested: u32;

// Everything in a part of triangles; whether that is enough.
fn search_part(search: ptr<function, Search>, part: Part, line: Line, first: u32, owner: u32, any: bool) -> bool {
    var walk: Walk;
    begin(&walk, part, line, (*search).from_t / BEYOND, end_of(search));
    loop {
        let leaf = next_leaf(&walk, end_of(search));
        if leaf.count == 0u {
            return false;
        }
        for (var i = 0u; i < leaf.count; i++) {
            var primitive = leaf.first + i;
            if !leaf.direct {
                primitive = listed(part, primitive);
            }
            tested += 1u;
            take(search, first + primitive, owner, meet(line, corners(part, primitive)));
            if any && (*search).best != NONE {
                return true;
            }
        }
    }
    return false;
}

// The line in the coordinates of a placed part: mapped back as the library does, but for roundings.
fn placed(instance: u32, world: Line) -> Line {
    let x = vector(instance + INVERSE);
    let y = vector(instance + INVERSE + 3u);
    let z = vector(instance + INVERSE + 6u);
    let from_origin = rough(world.origin - vector(instance + TRANSLATION));
    let size = abs(from_origin);
    let origin = rough(rough(x * from_origin.x + rough(y * from_origin.y)) + z * from_origin.z);
    let off = (abs(x) * size.x + abs(y) * size.y + abs(z) * size.z) * (8.0 * EPSILON) + TINY;
    let d = world.direction;
    let direction = rough(rough(x * d.x + rough(y * d.y)) + z * d.z);
    let error = (abs(x) * abs(d.x) + abs(y) * abs(d.y) + abs(z) * abs(d.z)) * (8.0 * EPSILON);
    return line(origin, direction, off, error);
}

// Everything along a ray between two parameters.
fn search_all(world: Line, from_t: f32, to_t: f32, any: bool) -> Search {
    var search = Search(from_t, to_t, NONE, NONE, FAR, FAR, 2.0 * FAR, world.usable);
    visited = 0u;
    tested = 0u;
    if !world.usable {
        return search;
    }
    let top = parts[0];
    if !PLACED {
        search_part(&search, top, world, 0u, NONE, any);
        return search;
    }
    var walk: Walk;
    begin(&walk, top, world, from_t / BEYOND, end_of(&search));
    loop {
        let leaf = next_leaf(&walk, end_of(&search));
        if leaf.count == 0u {
            return search;
        }
        for (var i = 0u; i < leaf.count; i++) {
            var index = leaf.first + i;
            if !leaf.direct {
                index = listed(top, index);
            }
            let instance = top.vertices + index * INSTANCE_WORDS;
            if word(instance + MASK) == 0u {
                continue;
            }
            let local = placed(instance, world);
            if !local.usable {
                search.usable = false;
                return search;
            }
            let part = parts[1u + word(instance + SCENE)];
            if search_part(&search, part, local, word(instance + FIRST), instance, any) {
                return search;
            }
        }
    }
    return search;
}
