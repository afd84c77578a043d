/** What opens an asset and asks for the closest hit and for any: measured in bytes. */
#include "board.h"
#include "hitscan.h"

extern const unsigned char asset[];
const unsigned char asset[4] = {0};

#ifdef PANIC
uint32_t hitscan_panic(size_t index);
#endif

int run(void) {
    hitscan_scene scene;
    hitscan_hit hit;
    const hitscan_ray ray = hitscan_ray_new((hitscan_vec3){0, 0, 5}, (hitscan_vec3){0, 0, -1});
    if (hitscan_open(&scene, asset, sizeof asset) != HITSCAN_OK) return 1;
#ifdef PANIC
    if (hitscan_panic(sizeof asset)) return 2;
#endif
    return hitscan_closest_hit(&scene, &ray, &hit) + hitscan_any_hit(&scene, &ray);
}
