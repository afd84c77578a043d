// A batch of rays.

// Origin and the parameter from which hits count; direction and that up to which they do.
@group(0) @binding(1) var<storage, read> rays: array<vec4<u32>>;
// Per ray a primitive, NONE or UNSURE; and how many nodes and primitives were looked at, 16 bits each.
@group(0) @binding(2) var<storage, read_write> answers: array<vec2<u32>>;

override ANY: bool = false;

@compute @workgroup_size(64)
fn cast_rays(@builtin(global_invocation_id) id: vec3<u32>) {
    let ray = id.x;
    if ray >= arrayLength(&answers) {
        return;
    }
    let a = rays[2u * ray];
    let b = rays[2u * ray + 1u];
    // In whole numbers, which have no infinities: from 0 or more to anything, but no NaN.
    if (a.w > INFINITE && a.w != 0x80000000u) || b.w > INFINITE {
        answers[ray] = vec2(UNSURE, 0u);
        return;
    }
    let from_t = bitcast<f32>(min(a.w & 0x7fffffffu, bitcast<u32>(FAR)));
    let to_t = bitcast<f32>(min(b.w, bitcast<u32>(FAR)));
    let world = line(bitcast<vec3<f32>>(a.xyz), bitcast<vec3<f32>>(b.xyz), vec3(0.0), vec3(0.0));
    let search = search_all(world, from_t, to_t, ANY);
    var answer = verdict(search);
    // One is enough, whatever else there may be.
    if ANY && search.usable && search.best != NONE {
        answer = search.best;
    }
    answers[ray] = vec2(answer, min(visited, 0xffffu) | (min(tested, 0xffffu) << 16u));
}
