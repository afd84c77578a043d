/** A torus in flash: a picture of it, a shadow, a distance, and a pyramid built beside it. No heap, no C library. */
#include "board.h"
#include "hitscan.h"

extern const unsigned char torus[], torus_end[];

/** Prints why and ends the program. */
#define TRY(call)                                     \
    do {                                              \
        const hitscan_status status = (call);         \
        if (status < 0) {                             \
            put(#call ": ");                          \
            put(hitscan_status_text(status));         \
            put("\n");                                \
            return 1;                                 \
        }                                             \
    } while (0)

/** One row after another, each character lit by a lamp at the upper left, if nothing is in its way. */
static int draw(const hitscan_scene *scene) {
    const hitscan_vec3 eye = {0.0f, 2.0f, 2.6f}, lamp = {-3.0f, 5.0f, 2.0f};
    for (int y = 0; y < 20; y++) {
        char line[50] = {0};
        for (int x = 0; x < 48; x++) {
            const float u = (float)(x - 24) / 24.0f, v = (float)(10 - y) / 10.0f;
            const hitscan_ray ray = hitscan_ray_new(eye, (hitscan_vec3){u, 0.6f * v - 1.5f, -1.7f - 0.6f * v});
            hitscan_hit hit;
            hitscan_surface at;
            line[x] = ' ';
            if (hitscan_closest_hit(scene, &ray, &hit) == HITSCAN_HIT) {
                TRY(hitscan_surface_at(scene, &ray, &hit, &at));
                const hitscan_ray to_lamp = hitscan_ray_between(at.start, lamp);
                const hitscan_vec3 d = to_lamp.direction, n = at.normal;
                const float cosine = (d.x * n.x + d.y * n.y + d.z * n.z) / 5.5f;
                const bool dark = cosine <= 0.0f || hitscan_any_hit(scene, &to_lamp) == HITSCAN_HIT;
                line[x] = dark ? '.' : ":-=+*#%@"[cosine < 1.0f ? (int)(cosine * 8.0f) : 7];
            }
        }
        line[48] = '\n';
        put(line);
    }
    return 0;
}

int run(void) {
    hitscan_scene scene;
    TRY(hitscan_open(&scene, torus, (size_t)(torus_end - torus)));
    if (draw(&scene) != 0) return 1;

    hitscan_nearest nearest;
    TRY(hitscan_nearest_point(&scene, (hitscan_vec3){0.0f, 0.0f, 0.0f}, 10.0f, &nearest));
    put(nearest.distance > 0.59f && nearest.distance < 0.61f ? "the hole has the radius 0.6\n" : "the hole is wrong\n");

    static const hitscan_vec3 corners[] = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}, {0, 1, 0}};
    static const uint16_t faces[][3] = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {0, 2, 1}, {0, 3, 2}};
    static uint32_t memory[4096];
    const hitscan_mesh pyramid = {
        .vertices = corners, .vertex_count = 5, .indices16 = faces[0], .triangle_count = 6};
    hitscan_arena arena = {memory, sizeof memory / sizeof *memory};
    TRY(hitscan_build(&scene, &arena, &pyramid, HITSCAN_KD_TREE, HITSCAN_BALANCED));

    const hitscan_ray down = hitscan_ray_new((hitscan_vec3){0.25f, 3.0f, 0.5f}, (hitscan_vec3){0, -1, 0});
    hitscan_hit hits[4];
    size_t count;
    TRY(hitscan_all_hits(&scene, &down, hits, 4, &count));
    if (count != 2 || hits[0].t != 2.5f || hits[1].t != 3.0f) return 1;
    put("through the pyramid from 2.5 to 3\n");
    return 0;
}
