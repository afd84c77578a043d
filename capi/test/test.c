/**
 * Every status that C can cause, and the same bits from every structure, built here or baked. Prints a hash of all answers,
 * which must be the same on every machine.
 */
#include "board.h"
#include "hitscan.h"

enum { TRIANGLES = 200, RAYS = 300, WORDS = 1 << 16 };

/** Assets of one mesh, with each of the structures, then on a lattice, in pairs, and both; at multiples of 4 bytes, each up to the next. */
extern const unsigned char *const baked[];
enum { BAKED = 7, LATTICE = BAKED, PAIRS_LIST, PAIRS, LATTICE_PAIRS };

static int failures;
static uint32_t hash = 2166136261u, seed = 1;
static hitscan_vec3 vertices[TRIANGLES * 3];
static uint16_t narrow[TRIANGLES * 3];
static uint32_t wide[TRIANGLES * 3], masks[TRIANGLES], memory[WORDS];

static void put_hex(uint32_t number) {
    char text[9] = {0};
    for (int i = 0; i < 8; i++) text[i] = "0123456789abcdef"[number >> (28 - 4 * i) & 15];
    put(text);
}

/** Complains if a status is not the one expected. */
static void expect(const char *what, hitscan_status found, hitscan_status expected) {
    if (found == expected) return;
    failures++;
    put(what);
    put(": ");
    put(hitscan_status_text(found));
    put(", not: ");
    put(hitscan_status_text(expected));
    put("\n");
}

#define EXPECT(call, status) expect(#call, call, HITSCAN_##status)
#define CHECK(condition) expect(#condition, (condition) ? HITSCAN_OK : HITSCAN_MISS, HITSCAN_OK)

static uint32_t random_bits(void) { return seed = seed * 1664525u + 1013904223u; }

/** Between -1 and 1. */
static float random_float(void) { return (float)(int32_t)(random_bits() >> 8) / 8388608.0f - 1.0f; }

static hitscan_vec3 random_point(float scale) {
    const float x = random_float(), y = random_float(), z = random_float();
    return (hitscan_vec3){x * scale, y * scale, z * scale};
}

static void add(uint32_t word) { hash = (hash ^ word) * 16777619u; }

static void add_float(float number) {
    union {
        float number;
        uint32_t word;
    } bits = {number};
    add(bits.word);
}

static void add_point(hitscan_vec3 point) {
    add_float(point.x);
    add_float(point.y);
    add_float(point.z);
}

/** The hash of all answers of a scene to the same questions. */
static uint32_t answers(const hitscan_scene *scene) {
    const uint32_t seed_before = seed, hash_before = hash;
    hash = 2166136261u;
    for (int i = 0; i < RAYS; i++) {
        const hitscan_vec3 origin = random_point(1.5f), direction = random_point(1.0f);
        hitscan_ray ray = hitscan_ray_new(origin, direction);
        ray.mask = i % 3 ? UINT32_MAX : 1;
        hitscan_hit hit = {-1.0f, 0}, all[12];
        hitscan_nearest nearest = {{0, 0, 0}, -1.0f, 0};
        hitscan_surface surface;
        size_t count;
        const hitscan_status status = hitscan_closest_hit(scene, &ray, &hit);
        expect("any", hitscan_any_hit(scene, &ray), status);
        expect("all", hitscan_all_hits(scene, &ray, all, 12, &count), status);
        add_float(hit.t);
        add(hit.triangle);
        add((uint32_t)count);
        for (size_t j = 0; j < count; j++) add_float(all[j].t), add(all[j].triangle);
        if (status == HITSCAN_HIT) {
            CHECK(all[0].t == hit.t && all[0].triangle == hit.triangle);
            EXPECT(hitscan_surface_at(scene, &ray, &hit, &surface), OK);
            add_point(surface.point), add_point(surface.normal), add_point(surface.start);
            add_float(surface.u), add_float(surface.v), add(surface.front);
        }
        add((uint32_t)hitscan_nearest_point(scene, ray.origin, 0.3f, &nearest));
        add_point(nearest.point), add_float(nearest.distance), add(nearest.triangle);
    }
    const uint32_t found = hash;
    seed = seed_before, hash = hash_before;
    return found;
}

static void same(const char *what, const hitscan_scene *scene, uint32_t expected) {
    const uint32_t found = answers(scene);
    if (found == expected) return;
    failures++;
    put(what);
    put(": other answers\n");
}

static hitscan_mesh soup(void) {
    for (uint32_t i = 0; i < TRIANGLES * 3; i++) {
        const hitscan_vec3 at = i % 3 ? vertices[i - i % 3] : random_point(1.0f), by = random_point(0.3f);
        vertices[i] = i % 3 ? (hitscan_vec3){at.x + by.x, at.y + by.y, at.z + by.z} : at;
        narrow[i] = (uint16_t)i, wide[i] = i;
        masks[i / 3] = i / 3 % 2 ? UINT32_MAX : 2;
    }
    return (hitscan_mesh){.vertices = vertices,
                          .vertex_count = TRIANGLES * 3,
                          .indices16 = narrow,
                          .triangle_count = TRIANGLES,
                          .masks = masks};
}

static void test_build(hitscan_mesh mesh) {
    hitscan_scene list, scene;
    hitscan_arena arena = {NULL, 0};
    EXPECT(hitscan_build(&list, &arena, &mesh, HITSCAN_LIST, HITSCAN_SMALL), OK);
    const uint32_t expected = answers(&list);
    add(expected);
    for (uint32_t structure = HITSCAN_LIST; structure <= HITSCAN_DUAL_SPLIT; structure++) {
        for (uint32_t preset = HITSCAN_SMALL; preset <= HITSCAN_FAST; preset++) {
            mesh.indices16 = preset % 2 ? NULL : narrow, mesh.indices32 = preset % 2 ? wide : NULL;
            const size_t words = hitscan_build_words(structure, preset, TRIANGLES);
            arena = (hitscan_arena){memory, words};
            CHECK(words <= WORDS);
            EXPECT(hitscan_build(&scene, &arena, &mesh, structure, preset), OK);
            const size_t used = (size_t)(arena.words - memory);
            CHECK(used + arena.count == words && (used > 0) == (structure != HITSCAN_LIST));
            for (size_t i = 0; i < used; i++) add(memory[i]);
            same("built", &scene, expected);
        }
    }
    arena = (hitscan_arena){memory, 5};
    EXPECT(hitscan_build(&scene, &arena, &mesh, HITSCAN_GRID, HITSCAN_SMALL), FULL);
    CHECK(arena.words == memory && arena.count == 5);
    EXPECT(hitscan_any_hit(&scene, &(hitscan_ray){0}), CLOSED);
    EXPECT(hitscan_build(&scene, &arena, &mesh, 7, HITSCAN_SMALL), CHOICE);
    EXPECT(hitscan_build(&scene, &arena, &mesh, HITSCAN_GRID, 3), CHOICE);
    CHECK(hitscan_build_words(7, 0, 1) == 0);
    EXPECT(hitscan_build(NULL, &arena, &mesh, HITSCAN_GRID, 0), NULL);
    EXPECT(hitscan_build(&scene, NULL, &mesh, HITSCAN_GRID, 0), NULL);
    EXPECT(hitscan_build(&scene, &arena, NULL, HITSCAN_GRID, 0), NULL);
    arena.words = NULL;
    EXPECT(hitscan_build(&scene, &arena, &mesh, HITSCAN_GRID, 0), NULL);
    arena = (hitscan_arena){memory, SIZE_MAX};
    EXPECT(hitscan_build(&scene, &arena, &mesh, HITSCAN_GRID, 0), LENGTH);
}

static void test_mesh(hitscan_mesh mesh) {
    uint32_t triangle = 77;
    EXPECT(hitscan_mesh_check(&mesh, &triangle), OK);
    CHECK(triangle == 77);
    EXPECT(hitscan_mesh_check(&mesh, NULL), NULL);
    narrow[9] = TRIANGLES * 3;
    EXPECT(hitscan_mesh_check(&mesh, &triangle), INDEX);
    CHECK(triangle == 3);
    narrow[9] = 9;
    vertices[13].y = 1.0f / 0.0f;
    EXPECT(hitscan_mesh_check(&mesh, &triangle), VERTEX);
    CHECK(triangle == 4);
    vertices[13].y = 0.0f;
    mesh.triangle_count = SIZE_MAX;
    EXPECT(hitscan_mesh_check(&mesh, &triangle), LENGTH);
    mesh.triangle_count = SIZE_MAX / 3;
    EXPECT(hitscan_mesh_check(&mesh, &triangle), LENGTH);
    mesh.triangle_count = TRIANGLES;
    mesh.indices32 = wide;
    EXPECT(hitscan_mesh_check(&mesh, &triangle), NULL);
    mesh.indices16 = NULL, mesh.indices32 = (const uint32_t *)(const void *)(narrow + 1);
    EXPECT(hitscan_mesh_check(&mesh, &triangle), MISALIGNED);
    mesh.indices32 = NULL;
    EXPECT(hitscan_mesh_check(&mesh, &triangle), NULL);
    hitscan_scene scene;
    hitscan_arena arena = {memory, WORDS};
    const hitscan_mesh none = {0};
    EXPECT(hitscan_build(&scene, &arena, &none, HITSCAN_KD_TREE, HITSCAN_FAST), OK);
    EXPECT(hitscan_any_hit(&scene, &(hitscan_ray){0}), MISS);
}

/** Opens a damaged copy of an asset, with its checksum made anew or not. */
static hitscan_status opened(size_t bytes, uint32_t word, uint32_t flip, bool summed) {
    hitscan_scene scene;
    const uint32_t *const words = (const uint32_t *)(const void *)baked[0];
    CHECK(bytes <= sizeof memory);
    for (size_t i = 0; i < bytes / 4; i++) memory[i] = words[i];
    memory[word] ^= flip;
    if (summed) {
        uint32_t sum = 0x811c9dc5;
        for (size_t i = 0; i < bytes / 4; i++) {
            if (i == 4) continue;
            sum = (sum ^ memory[i]) * 0x01000193;
            sum = sum << 13 | sum >> 19;
        }
        memory[4] = sum;
    }
    const hitscan_status status = hitscan_open(&scene, memory, bytes);
    const hitscan_ray ray = hitscan_ray_new((hitscan_vec3){0, 0, 0}, (hitscan_vec3){1, 0, 0});
    if (status < 0) EXPECT(hitscan_any_hit(&scene, &ray), CLOSED);
    return status;
}

static hitscan_scene open_baked(int number) {
    hitscan_scene scene;
    EXPECT(hitscan_open(&scene, baked[number], (size_t)(baked[number + 1] - baked[number])), OK);
    return scene;
}

static void test_assets(void) {
    uint32_t expected = 0;
    for (int i = 0; i < BAKED; i++) {
        const hitscan_scene scene = open_baked(i), copy = scene;
        if (i == 0) add(expected = answers(&copy));
        same("baked", &copy, expected);
    }
    const hitscan_scene moved = open_baked(LATTICE), pairs = open_baked(PAIRS), both = open_baked(LATTICE_PAIRS);
    add(answers(&moved));
    const hitscan_scene list = open_baked(PAIRS_LIST);
    add(expected = answers(&list));
    same("pairs", &pairs, expected);
    add(answers(&both));
    const size_t bytes = (size_t)(baked[1] - baked[0]);
    CHECK(opened(bytes, 0, 0, false) == HITSCAN_OK);
    EXPECT(opened(bytes, 0, 1, false), MAGIC);
    EXPECT(opened(bytes, 1, 1, false), BYTE_ORDER);
    EXPECT(opened(bytes, 2, 8, false), VERSION);
    EXPECT(opened(bytes, 3, 1, false), LENGTH);
    EXPECT(opened(bytes, 9, 1, false), CHECKSUM);
    EXPECT(opened(bytes, 6, 1, true), MISSING);
    EXPECT(opened(bytes, 8, 4, true), MALFORMED);
    EXPECT(opened(bytes - 4, 0, 0, false), LENGTH);
    EXPECT(opened(bytes - 1, 0, 0, false), LENGTH);
    EXPECT(opened(0, 0, 0, false), LENGTH);
    hitscan_scene scene = {0};
    EXPECT(hitscan_open(NULL, baked[0], bytes), NULL);
    EXPECT(hitscan_open(&scene, NULL, bytes), NULL);
    EXPECT(hitscan_open(&scene, baked[0] + 1, bytes), MISALIGNED);
}

static void test_queries(void) {
    hitscan_scene closed = {0}, scene;
    hitscan_ray ray = hitscan_ray_new((hitscan_vec3){0, 0, 0}, (hitscan_vec3){1, 0, 0});
    hitscan_hit hit = {0, 0};
    hitscan_surface surface;
    hitscan_nearest nearest;
    hitscan_box box;
    size_t count;
    EXPECT(hitscan_open(&scene, baked[0], (size_t)(baked[1] - baked[0])), OK);
    EXPECT(hitscan_bounds(&scene, &box), OK);
    CHECK(box.max.x == 1.4f && box.min.y == -0.4f);
    EXPECT(hitscan_bounds(&scene, NULL), NULL);
    EXPECT(hitscan_closest_hit(&closed, &ray, &hit), CLOSED);
    EXPECT(hitscan_closest_hit(NULL, &ray, &hit), NULL);
    EXPECT(hitscan_closest_hit(&scene, NULL, &hit), NULL);
    EXPECT(hitscan_closest_hit(&scene, &ray, NULL), NULL);
    EXPECT(hitscan_any_hit(&scene, NULL), NULL);
    EXPECT(hitscan_all_hits(&scene, &ray, NULL, 1, &count), NULL);
    EXPECT(hitscan_all_hits(&scene, &ray, NULL, 0, &count), MISS);
    EXPECT(hitscan_all_hits(&scene, &ray, &hit, 1, NULL), NULL);
    EXPECT(hitscan_all_hits(&scene, &ray, &hit, SIZE_MAX, &count), LENGTH);
    EXPECT(hitscan_surface_at(&scene, &ray, &hit, NULL), NULL);
    hit.triangle = UINT32_MAX;
    EXPECT(hitscan_surface_at(&scene, &ray, &hit, &surface), OK);
    EXPECT(hitscan_nearest_point(&scene, ray.origin, -1.0f, &nearest), MISS);
    EXPECT(hitscan_nearest_point(&scene, ray.origin, 1.0f, NULL), NULL);
    ray.direction = (hitscan_vec3){0, 0, 0};
    EXPECT(hitscan_closest_hit(&scene, &ray, &hit), MISS);
    for (int status = -20; status < 5; status++) CHECK(hitscan_status_text(status)[0] != 0);
}

int run(void) {
    const hitscan_mesh mesh = soup();
    test_build(mesh);
    test_mesh(mesh);
    test_assets();
    test_queries();
    put_hex(hash);
    put(failures ? " failed\n" : " passed\n");
    return failures != 0;
}
