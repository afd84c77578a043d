// Walks through structures: those of the library, with a margin around each plane in the place of its rounding rules.

// No structure is deeper.
const DEPTH = 32u;

struct Walk {
    structure: u32,
    nodes: u32,
    planes: Planes,
    descending: u32,
    // The node to go on with and the part of the line in its cell, if there is one.
    live: bool,
    node: u32,
    enter: f32,
    leave: f32,
    // Those that wait, the nearest on top.
    height: u32,
    waiting: array<u32, DEPTH>,
    parts: array<vec2<f32>, DEPTH>,
}

struct Leaf {
    first: u32,
    // None: there is no further leaf.
    count: u32,
    // Whether the first is the primitive itself.
    direct: bool,
}

// Nodes looked at, in all walks of this ray.
var<private> visited: u32;

// A walk through a part, along a line, between two parameters.
fn begin(walk: ptr<function, Walk>, part: Part, line: Line, from_t: f32, to_t: f32) {
    (*walk).structure = part.structure;
    (*walk).nodes = part.header + HEADER_WORDS;
    (*walk).descending = line.descending;
    (*walk).height = 0u;
    (*walk).node = select(0u, part.root, part.structure == BVH);
    let low = vector(part.header + BOX_WORD);
    let high = vector(part.header + BOX_WORD + 3u);
    var first = low;
    var last = high;
    if part.structure == KD_TREE {
        (*walk).planes = planes(line, vec3(0.0), vec3(1.0), low, high);
    } else {
        (*walk).planes = planes(line, low, lattice_step(low, high), low, high);
        first = vec3(0.0);
        last = vec3(65535.0);
    }
    // An empty part has an infinite box, of which nothing can be computed.
    (*walk).live = part.primitives > 0u;
    if (*walk).live {
        let falls = vec3((line.descending & 1u) != 0u, (line.descending & 2u) != 0u, (line.descending & 4u) != 0u);
        let enter = select(first, last, falls) * (*walk).planes.scale + (*walk).planes.enter;
        let leave = select(last, first, falls) * (*walk).planes.scale + (*walk).planes.leave;
        (*walk).enter = max(max(enter.x, enter.y), max(enter.z, from_t));
        (*walk).leave = min(min(leave.x, leave.y), min(leave.z, to_t));
        (*walk).live = (*walk).enter <= (*walk).leave;
    }
}

fn push(walk: ptr<function, Walk>, node: u32, enter: f32, leave: f32) {
    let height = (*walk).height;
    (*walk).waiting[height] = node;
    (*walk).parts[height] = vec2(enter, leave);
    (*walk).height = height + 1u;
}

// Goes on with the nearest that begins before `end`.
fn pop(walk: ptr<function, Walk>, end: f32) -> bool {
    while (*walk).height > 0u {
        (*walk).height -= 1u;
        let part = (*walk).parts[(*walk).height];
        if part.x <= end {
            (*walk).node = (*walk).waiting[(*walk).height];
            (*walk).enter = part.x;
            (*walk).leave = min(part.y, end);
            (*walk).live = true;
            return true;
        }
    }
    return false;
}

fn entered(walk: ptr<function, Walk>, axis: u32, plane: f32) -> f32 {
    return rough1(rough1(plane * of_axis((*walk).planes.scale, axis)) + of_axis((*walk).planes.enter, axis));
}

fn left(walk: ptr<function, Walk>, axis: u32, plane: f32) -> f32 {
    return rough1(rough1(plane * of_axis((*walk).planes.scale, axis)) + of_axis((*walk).planes.leave, axis));
}

// Two cells, of which the near one ends at one plane and the far one begins at another.
fn divide(walk: ptr<function, Walk>, near: u32, far: u32, ends: f32, begins: f32) {
    if ends < (*walk).enter {
        (*walk).node = far;
        (*walk).enter = max(begins, (*walk).enter);
        (*walk).live = (*walk).enter <= (*walk).leave;
        return;
    }
    if begins <= (*walk).leave {
        push(walk, far, max(begins, (*walk).enter), (*walk).leave);
    }
    (*walk).node = near;
    (*walk).leave = min(ends, (*walk).leave);
}

// One cell that begins or ends at a plane.
fn shrink(walk: ptr<function, Walk>, axis: u32, plane: f32, begins: bool) {
    if begins {
        (*walk).enter = max(entered(walk, axis, plane), (*walk).enter);
    } else {
        (*walk).leave = min(left(walk, axis, plane), (*walk).leave);
    }
    (*walk).live = (*walk).enter <= (*walk).leave;
}

// A step that may come to a leaf: what it returns has none, one or many primitives. (src/accel/kdtree/traverse.rs)
fn step_kd_tree(walk: ptr<function, Walk>) -> Leaf {
    let node = pair(((*walk).nodes >> 1u) + (*walk).node);
    let axis = node.y & 3u;
    let right = node.y >> 4u;
    if axis == 3u {
        (*walk).live = false;
        return Leaf(node.x, right, right == 1u);
    }
    let plane = bitcast<f32>(node.x);
    let falls = (((*walk).descending >> axis) & 1u) != 0u;
    let below = (*walk).node + 1u;
    if (node.y & 12u) != 0u {
        (*walk).node = below;
        shrink(walk, axis, plane, ((node.y & 8u) != 0u) == falls);
        return Leaf(0u, 0u, false);
    }
    let near = select(below, right, falls);
    let far = select(right, below, falls);
    divide(walk, near, far, left(walk, axis, plane), entered(walk, axis, plane));
    return Leaf(0u, 0u, false);
}

// The same (src/accel/dualsplit/traverse.rs)
fn step_dual_split(walk: ptr<function, Walk>) -> Leaf {
    let at = (*walk).nodes + (*walk).node;
    let head = word(at);
    let axis = head & 3u;
    if axis == 3u {
        (*walk).live = false;
        return Leaf(head >> 6u, (head >> 2u) & 15u, false);
    }
    let planes = word(at + 1u);
    let child = (*walk).node + 2u;
    let falls = (((*walk).descending >> axis) & 1u) != 0u;
    if (head & 4u) != 0u {
        (*walk).node = child;
        shrink(walk, axis, f32(planes & 0xffffu), ((head & 8u) != 0u) == falls);
        if (*walk).live {
            let other = head >> 4u;
            let second = other & 3u;
            let second_falls = (((*walk).descending >> second) & 1u) != 0u;
            shrink(walk, second, f32(planes >> 16u), ((other & 8u) != 0u) == second_falls);
        }
        return Leaf(0u, 0u, false);
    }
    let right = head >> 4u;
    let lower = f32(planes & 0xffffu);
    let upper = f32(planes >> 16u);
    let near = select(child, right, falls);
    let far = select(right, child, falls);
    let ends = left(walk, axis, select(lower, upper, falls));
    divide(walk, near, far, ends, entered(walk, axis, select(upper, lower, falls)));
    return Leaf(0u, 0u, false);
}

// Where a line enters and leaves a box of a BVH, within the part of it that counts.
fn interval(walk: ptr<function, Walk>, planes: vec3<u32>, end: f32) -> vec2<f32> {
    let lower = vec3<f32>(planes & vec3(0xffffu));
    let upper = vec3<f32>(planes >> vec3(16u));
    let bits = vec3((*walk).descending) & vec3(1u, 2u, 4u);
    let falls = bits != vec3(0u);
    let enter = rough(rough(select(lower, upper, falls) * (*walk).planes.scale) + (*walk).planes.enter);
    let leave = rough(rough(select(upper, lower, falls) * (*walk).planes.scale) + (*walk).planes.leave);
    return vec2(
        max(max(enter.x, enter.y), max(enter.z, (*walk).enter)),
        min(min(leave.x, leave.y), min(leave.z, end)),
    );
}

// The same (src/accel/bvh/traverse.rs)
fn step_bvh(walk: ptr<function, Walk>, end: f32) -> Leaf {
    let link = (*walk).node;
    if (link & 15u) != 0u {
        (*walk).live = false;
        return Leaf(link >> 4u, link & 15u, false);
    }
    let at = ((*walk).nodes >> 1u) + (link >> 4u) * 4u;
    let w0 = pair(at);
    let w1 = pair(at + 1u);
    let w2 = pair(at + 2u);
    let w3 = pair(at + 3u);
    let one = interval(walk, vec3(w0, w1.x), end);
    let two = interval(walk, vec3(w2, w3.x), end);
    let meets_one = one.x <= one.y;
    let meets_two = two.x <= two.y;
    let two_first = meets_two && (!meets_one || two.x < one.x);
    if meets_one && meets_two {
        push(walk, select(w3.y, w1.y, two_first), max(one.x, two.x), end);
    }
    (*walk).live = meets_one || meets_two;
    (*walk).node = select(w1.y, w3.y, two_first);
    (*walk).enter = select(one.x, two.x, two_first);
    return Leaf(0u, 0u, false);
}

// The next leaf that may hold something before `end`.
fn next_leaf(walk: ptr<function, Walk>, end: f32) -> Leaf {
    loop {
        if !(*walk).live && !pop(walk, end) {
            return Leaf(0u, 0u, false);
        }
        visited += 1u;
        var leaf: Leaf;
        if (STRUCTURES & 1u) != 0u && (*walk).structure == KD_TREE {
            leaf = step_kd_tree(walk);
        } else if (STRUCTURES & 2u) != 0u && (*walk).structure == DUAL_SPLIT {
            leaf = step_dual_split(walk);
        } else {
            leaf = step_bvh(walk, end);
        }
        if leaf.count > 0u {
            return leaf;
        }
    }
    return Leaf(0u, 0u, false);
}
