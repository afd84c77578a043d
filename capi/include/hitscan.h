/**
 * hitscan: exact ray queries on triangle meshes, from flash, without heap.
 *
 *     alignas(4) static const unsigned char ASSET[] = { ... };      made by `hitscan bake model.obj`
 *
 *     hitscan_scene scene;
 *     hitscan_status status = hitscan_open(&scene, ASSET, sizeof ASSET);
 *     if (status != HITSCAN_OK) puts(hitscan_status_text(status));
 *
 *     hitscan_ray ray = hitscan_ray_new((hitscan_vec3){0, 0, 5}, (hitscan_vec3){0, 0, -1});
 *     hitscan_hit hit;
 *     if (hitscan_closest_hit(&scene, &ray, &hit) == HITSCAN_HIT) use(hit.t, hit.triangle);
 *
 * Every function is reentrant and bounded in time, allocates nothing and never aborts. Pointers that are NULL or misaligned
 * are answered by a status; others must point to what the function says. Any bits are allowed in numbers.
 */

#ifndef HITSCAN_H
#define HITSCAN_H

/* Made from the sources by capi/header; do not edit. */

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/**
 * What a function came to: negative where something is wrong.
 */
enum hitscan_status
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /**
     * Done.
     */
    HITSCAN_OK = 0,
    /**
     * The query found something.
     */
    HITSCAN_HIT = 1,
    /**
     * The query found nothing.
     */
    HITSCAN_MISS = 2,
    /**
     * A pointer is null.
     */
    HITSCAN_NULL = -1,
    /**
     * A pointer is not aligned for what it points to; assets must lie at multiples of 4 bytes.
     */
    HITSCAN_MISALIGNED = -2,
    /**
     * A length is out of range, or not the one that the asset's header says.
     */
    HITSCAN_LENGTH = -3,
    /**
     * The scene is not open.
     */
    HITSCAN_CLOSED = -4,
    /**
     * No such structure or preset.
     */
    HITSCAN_CHOICE = -5,
    /**
     * What is needed was left out when this library was built: see its features.
     */
    HITSCAN_LEFT_OUT = -6,
    /**
     * Not an asset.
     */
    HITSCAN_MAGIC = -7,
    /**
     * The byte order is another machine's.
     */
    HITSCAN_BYTE_ORDER = -8,
    /**
     * The asset was made for another version of this library.
     */
    HITSCAN_VERSION = -9,
    /**
     * The asset is damaged: its checksum is wrong.
     */
    HITSCAN_CHECKSUM = -10,
    /**
     * The asset lacks a section that a scene needs, such as triangles.
     */
    HITSCAN_MISSING = -11,
    /**
     * The asset contradicts itself.
     */
    HITSCAN_MALFORMED = -12,
    /**
     * A triangle names a vertex that does not exist.
     */
    HITSCAN_INDEX = -13,
    /**
     * A coordinate is not finite or beyond 2^126.
     */
    HITSCAN_VERTEX = -14,
    /**
     * More triangles than the structure can name.
     */
    HITSCAN_TOO_MANY = -15,
    /**
     * The arena is too small.
     */
    HITSCAN_FULL = -16,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum hitscan_status hitscan_status;
#else
typedef int32_t hitscan_status;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * A structure over triangles. All give the same hits.
 */
enum hitscan_structure
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /**
     * None: each ray tests each triangle.
     */
    HITSCAN_LIST = 0,
    /**
     * A uniform grid: the quickest to build.
     */
    HITSCAN_GRID = 1,
    /**
     * An octree.
     */
    HITSCAN_OCTREE = 2,
    /**
     * A kD-tree: the fastest rays.
     */
    HITSCAN_KD_TREE = 3,
    /**
     * A kD-tree in two thirds of the bytes.
     */
    HITSCAN_COMPACT_KD_TREE = 4,
    /**
     * A bounding volume hierarchy.
     */
    HITSCAN_BVH = 5,
    /**
     * A dual-split tree: the fewest bytes.
     */
    HITSCAN_DUAL_SPLIT = 6,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum hitscan_structure hitscan_structure;
#else
typedef uint32_t hitscan_structure;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * What a structure is tuned for.
 */
enum hitscan_preset
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /**
     * The fewest bytes.
     */
    HITSCAN_SMALL = 0,
    /**
     * Nearly as fast in less than half the bytes of the fastest.
     */
    HITSCAN_BALANCED = 1,
    /**
     * The least time per ray.
     */
    HITSCAN_FAST = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum hitscan_preset hitscan_preset;
#else
typedef uint32_t hitscan_preset;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * A point or a direction.
 */
typedef struct {
    float x;
    float y;
    float z;
} hitscan_vec3;

/**
 * A half-line: the points origin + t * direction for t_min <= t <= t_max. Made by hitscan_ray_new or hitscan_ray_between.
 *
 * The direction need not have length 1. A ray misses everything if a component is not finite, the interval is empty, or the
 * largest component of the direction is not within 2^-100 and 2^100.
 */
typedef struct {
    /**
     * The point at t = 0.
     */
    hitscan_vec3 origin;
    /**
     * The step for one unit of t.
     */
    hitscan_vec3 direction;
    /**
     * The least t that counts, itself included.
     */
    float t_min;
    /**
     * The greatest t that counts, itself included; INFINITY for no limit.
     */
    float t_max;
    /**
     * Only triangles whose mask shares a bit with this one are seen.
     */
    uint32_t mask;
} hitscan_ray;

/**
 * A scene: what rays are cast at. The caller's to place: on the stack, in a static variable, in a structure.
 *
 * Open one with hitscan_open or hitscan_build. It borrows the asset, or the mesh and the arena, which must outlive it and
 * stay as they are. It may be copied, needs no closing, and never changes by queries: any number of threads may share it.
 * One of zeros is closed.
 */
typedef struct {
    /**
     * Not for you.
     */
    size_t state;
    /**
     * Not for you.
     */
    size_t opaque[106];
} hitscan_scene;

/**
 * Memory for structures, taken from the front.
 */
typedef struct {
    /**
     * The words that are free.
     */
    uint32_t *words;
    /**
     * How many there are.
     */
    size_t count;
} hitscan_arena;

/**
 * Triangles in the caller's memory.
 */
typedef struct {
    /**
     * The positions of the vertices.
     */
    const hitscan_vec3 *vertices;
    /**
     * How many there are.
     */
    size_t vertex_count;
    /**
     * Three vertices per triangle, in 16 bits; NULL if they are in 32.
     */
    const uint16_t *indices16;
    /**
     * Three vertices per triangle, in 32 bits; NULL if they are in 16.
     */
    const uint32_t *indices32;
    /**
     * How many triangles there are.
     */
    size_t triangle_count;
    /**
     * A mask per triangle: rays that share no bit with it do not see it. NULL if all rays see all triangles.
     */
    const uint32_t *masks;
    /**
     * Whether triangles are hit from the front only, the side from which the corners run counter-clockwise.
     */
    bool front_only;
} hitscan_mesh;

/**
 * A box.
 */
typedef struct {
    /**
     * The least coordinates.
     */
    hitscan_vec3 min;
    /**
     * The greatest coordinates.
     */
    hitscan_vec3 max;
} hitscan_box;

/**
 * Where a ray hits which triangle. Hits are ordered by t, then by number.
 */
typedef struct {
    /**
     * The ray's parameter; the distance if its direction has length 1.
     */
    float t;
    /**
     * The triangle's number.
     */
    uint32_t triangle;
} hitscan_hit;

/**
 * The surface at a hit.
 */
typedef struct {
    /**
     * The point.
     */
    hitscan_vec3 point;
    /**
     * The unit normal on the side from which the corners run counter-clockwise.
     */
    hitscan_vec3 normal;
    /**
     * Where a ray must start that leaves to the side from which this one came, so that it does not hit the triangle again.
     */
    hitscan_vec3 start;
    /**
     * The weight of the triangle's second corner.
     */
    float u;
    /**
     * The weight of the triangle's third corner.
     */
    float v;
    /**
     * Whether the ray came from the side of the normal.
     */
    bool front;
} hitscan_surface;

/**
 * The point of a scene that is nearest to another.
 */
typedef struct {
    /**
     * The point.
     */
    hitscan_vec3 point;
    /**
     * How far away it is.
     */
    float distance;
    /**
     * The triangle on which it lies.
     */
    uint32_t triangle;
} hitscan_nearest;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * What a status says, in English; never NULL.
 */
const char *hitscan_status_text(int32_t status);

/**
 * The ray from a point along a direction, for t from 0 to infinity, seeing everything.
 */
hitscan_ray hitscan_ray_new(hitscan_vec3 origin, hitscan_vec3 direction);

/**
 * The segment from a (t = 0) to b (t = 1), seeing everything.
 */
hitscan_ray hitscan_ray_between(hitscan_vec3 a, hitscan_vec3 b);

/**
 * Opens the scene in an asset, made by `hitscan bake`, where it lies.
 *
 * The asset begins at a multiple of 4 bytes. It is checked in full, once, in time proportional to its size; after that no
 * query can fail, whatever its bytes. After an error the scene is closed.
 */
hitscan_status hitscan_open(hitscan_scene *scene,
                            const void *asset,
                            size_t bytes);

/**
 * Builds a structure over a mesh, into the front of the arena, which then holds what is left.
 *
 * After an error the scene is closed, and the arena holds what it held. HITSCAN_FULL never comes if it has as many
 * words as hitscan_build_words says; mostly far fewer do.
 */
hitscan_status hitscan_build(hitscan_scene *scene,
                             hitscan_arena *arena,
                             const hitscan_mesh *mesh,
                             uint32_t structure,
                             uint32_t preset);

/**
 * How many words of arena always suffice to build a structure over so many triangles; 0 if there is no such structure.
 */
size_t hitscan_build_words(uint32_t structure, uint32_t preset, size_t triangles);

/**
 * Looks for the first triangle that hitscan_build would refuse, and writes its number.
 *
 * HITSCAN_OK if there is none; then nothing is written.
 */
hitscan_status hitscan_mesh_check(const hitscan_mesh *mesh, uint32_t *triangle);

/**
 * The box around all triangles of a scene.
 */
hitscan_status hitscan_bounds(const hitscan_scene *scene, hitscan_box *bounds);

/**
 * The first hit of a ray: HITSCAN_HIT, or HITSCAN_MISS and nothing is written.
 */
hitscan_status hitscan_closest_hit(const hitscan_scene *scene, const hitscan_ray *ray, hitscan_hit *hit);

/**
 * Whether a ray hits anything, HITSCAN_HIT or HITSCAN_MISS: for shadows, cheaper than the closest hit.
 */
hitscan_status hitscan_any_hit(const hitscan_scene *scene, const hitscan_ray *ray);

/**
 * The first hits of a ray in order, at most capacity of them, and how many were written.
 */
hitscan_status hitscan_all_hits(const hitscan_scene *scene,
                                const hitscan_ray *ray,
                                hitscan_hit *hits,
                                size_t capacity,
                                size_t *count);

/**
 * The surface at a hit of this ray.
 */
hitscan_status hitscan_surface_at(const hitscan_scene *scene,
                                  const hitscan_ray *ray,
                                  const hitscan_hit *hit,
                                  hitscan_surface *surface);

/**
 * The point of all triangles nearest to a point, at most so far away: HITSCAN_HIT or HITSCAN_MISS.
 *
 * It is measured in double precision, and takes some 2 kB of stack.
 */
hitscan_status hitscan_nearest_point(const hitscan_scene *scene,
                                     hitscan_vec3 point,
                                     float max_distance,
                                     hitscan_nearest *nearest);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* HITSCAN_H */
