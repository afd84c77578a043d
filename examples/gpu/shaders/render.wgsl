// A picture: Whitted's loop with Phong's terms, as src/render of the library has them.

struct Stage {
    // The ray through the upper left corner, and how it changes from pixel to pixel.
    origin: vec3<f32>,
    width: u32,
    origin_x: vec3<f32>,
    height: u32,
    origin_y: vec3<f32>,
    samples: u32,
    direction: vec3<f32>,
    bounces: u32,
    direction_x: vec3<f32>,
    lights: u32,
    direction_y: vec3<f32>,
    // The row to begin with.
    row: u32,
    up: vec3<f32>,
    // How many materials there are.
    materials: u32,
    ambient: vec3<f32>,
    // Words at which the material numbers, and the primitives' numbers of old, begin; 0 if there are none.
    numbers: u32,
    below: vec3<f32>,
    order: u32,
    above: vec3<f32>,
    order_is_narrow: u32,
    // Per light: where it is or shines to, and 1 if it is at a place; its colour. Then materials, 8 numbers each.
    list: array<vec4<f32>>,
}

@group(0) @binding(1) var<storage, read> stage: Stage;
// Linear red, green, blue, and the number of rays; less than 0 if the pixel is not certain.
@group(0) @binding(2) var<storage, read_write> pixels: array<vec4<f32>>;

struct Material {
    diffuse: vec3<f32>,
    specular: vec3<f32>,
    shininess: f32,
    reflectivity: f32,
}

struct Surface {
    point: vec3<f32>,
    normal: vec3<f32>,
    front: bool,
    error: f32,
}

// Rays of this pixel, and whether all was certain.
var<private> asked: f32;
var<private> certain: bool;

fn unit(v: vec3<f32>) -> vec3<f32> {
    let largest = max(max(abs(v.x), abs(v.y)), abs(v.z));
    if largest < TINY {
        return vec3(1.0, 0.0, 0.0);
    }
    let scaled = v / largest;
    return scaled / sqrt(dot(scaled, scaled));
}

fn mirror(direction: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    return direction - normal * (2.0 * dot(direction, normal));
}

fn material_of(place: u32) -> Material {
    var number = place;
    if stage.order != 0u {
        if stage.order_is_narrow != 0u {
            number = half_word(stage.order, place);
        } else {
            number = word(stage.order + place);
        }
    }
    if stage.numbers != 0u {
        number = half_word(stage.numbers, number);
    } else {
        number = 0u;
    }
    let at = 2u * (stage.lights + min(number, stage.materials - 1u));
    let a = stage.list[at];
    let b = stage.list[at + 1u];
    return Material(a.xyz, vec3(a.w, b.xy), b.z, b.w);
}

fn search(origin: vec3<f32>, direction: vec3<f32>, to_t: f32, any: bool) -> Search {
    asked += 1.0;
    return search_all(line(origin, direction, vec3(0.0), vec3(0.0)), 0.0, to_t, any);
}

// The surface of the triangle that was found.
fn surface(origin: vec3<f32>, direction: vec3<f32>, found: Search) -> Surface {
    var part = parts[0];
    var ray = line(origin, direction, vec3(0.0), vec3(0.0));
    var triangle = found.best;
    if PLACED {
        part = parts[1u + word(found.owner + SCENE)];
        ray = placed(found.owner, ray);
        triangle -= word(found.owner + FIRST);
    }
    let at = corners(part, triangle);
    let start = ordered(ray.origin, ray.major);
    let a = ordered(at.a, ray.major) - start;
    let b = ordered(at.b, ray.major) - start;
    let c = ordered(at.c, ray.major) - start;
    let p = sheared(a, ray.slope);
    let q = sheared(b, ray.slope);
    let r = sheared(c, ray.slope);
    let u = edge(r, q);
    let v = edge(p, r);
    let w = edge(q, p);
    let sum = abs(u) + abs(v) + abs(w);
    var weights = vec2(1.0 / 3.0);
    if sum > TINY {
        weights = abs(vec2(v, w)) / sum;
    }
    var result: Surface;
    result.point = at.a * (1.0 - weights.x - weights.y) + at.b * weights.x + at.c * weights.y;
    result.normal = unit(cross(at.b - at.a, at.c - at.a));
    result.front = ((u + v) + w > 0.0) == (ray.along > 0.0);
    let reach = abs(at.a) + abs(at.b) + abs(at.c);
    result.error = max(max(reach.x, reach.y), reach.z) * (8.0 * EPSILON) + at.off;
    if PLACED {
        let x = vector(found.owner);
        let y = vector(found.owner + 3u);
        let z = vector(found.owner + 6u);
        let back = mat3x3(
            vector(found.owner + INVERSE),
            vector(found.owner + INVERSE + 3u),
            vector(found.owner + INVERSE + 6u),
        );
        let there = mat3x3(x, y, z);
        let far = mat3x3(abs(x), abs(y), abs(z));
        let away = mat3x3(abs(back[0]), abs(back[1]), abs(back[2]));
        let moved = vector(found.owner + TRANSLATION);
        let own = (far * (away * (far * abs(result.point))) + abs(moved)) * (16.0 * EPSILON);
        let stretch = far * vec3(1.0);
        result.error = result.error * max(max(stretch.x, stretch.y), stretch.z) + max(max(own.x, own.y), own.z);
        result.point = there * result.point + moved;
        result.normal = unit(transpose(back) * result.normal);
    }
    return result;
}

// Where a ray that leaves along `direction` starts, so as not to meet the surface again.
fn start_towards(at: Surface, direction: vec3<f32>) -> vec3<f32> {
    let normal = select(at.normal, -at.normal, dot(direction, at.normal) < 0.0);
    let reach = at.error * (abs(normal.x) + abs(normal.y) + abs(normal.z));
    let moved = at.point + normal * reach;
    return moved + sign(normal) * abs(moved) * (2.0 * EPSILON);
}

fn phong(at: Surface, material: Material, to_viewer: vec3<f32>) -> vec3<f32> {
    var light = stage.ambient * material.diffuse;
    let normal = select(-at.normal, at.normal, at.front);
    for (var i = 0u; i < stage.lights; i++) {
        let place = stage.list[2u * i];
        let color = stage.list[2u * i + 1u].xyz;
        let is_point = place.w > 0.0;
        let to_light = unit(select(-place.xyz, place.xyz - at.point, is_point));
        let cosine = dot(normal, to_light);
        if cosine <= 0.0 {
            continue;
        }
        let start = start_towards(at, to_light);
        let direction = select(-place.xyz, place.xyz - start, is_point);
        let shadow = search(start, direction, select(FAR, 1.0, is_point), true);
        if shadow.usable && shadow.best != NONE {
            continue;
        }
        certain = certain && verdict(shadow) != UNSURE;
        light += color * material.diffuse * cosine;
        let highlight = dot(mirror(-to_light, normal), to_viewer);
        if highlight > 0.0 {
            light += color * material.specular * pow(highlight, material.shininess);
        }
    }
    return light;
}

fn sky(direction: vec3<f32>) -> vec3<f32> {
    return mix(stage.below, stage.above, dot(unit(direction), stage.up) * 0.5 + 0.5);
}

fn light_along(first_origin: vec3<f32>, first_direction: vec3<f32>) -> vec3<f32> {
    var origin = first_origin;
    var direction = first_direction;
    var light = vec3(0.0);
    var share = 1.0;
    for (var depth = 0u; depth <= stage.bounces; depth++) {
        let found = search(origin, direction, FAR, false);
        let best = verdict(found);
        if best == UNSURE {
            certain = false;
            return light;
        }
        if best == NONE {
            return light + sky(direction) * share;
        }
        let at = surface(origin, direction, found);
        let material = material_of(best);
        let along = unit(direction);
        let mirrored = select(0.0, material.reflectivity, depth < stage.bounces);
        light += phong(at, material, -along) * (share * (1.0 - mirrored));
        share *= mirrored;
        if share <= 0.0 || !certain {
            break;
        }
        direction = mirror(along, at.normal);
        origin = start_towards(at, direction);
    }
    return light;
}

@compute @workgroup_size(8, 8)
fn render(@builtin(global_invocation_id) id: vec3<u32>) {
    let x = id.x;
    let y = id.y + stage.row;
    if x >= stage.width || y >= stage.height {
        return;
    }
    asked = 0.0;
    certain = true;
    let step = 1.0 / f32(stage.samples);
    var sum = vec3(0.0);
    for (var j = 0u; j < stage.samples && certain; j++) {
        for (var i = 0u; i < stage.samples && certain; i++) {
            let u = f32(x) + (f32(i) + 0.5) * step;
            let v = f32(y) + (f32(j) + 0.5) * step;
            let origin = stage.origin + stage.origin_x * u + stage.origin_y * v;
            sum += light_along(origin, stage.direction + stage.direction_x * u + stage.direction_y * v);
        }
    }
    pixels[y * stage.width + x] = vec4(sum * (step * step), select(-asked, asked, certain));
}
