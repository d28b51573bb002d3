/* The glass that a ray is in: the materials around it, innermost first, up to four, as NO_MEDIUM-padded indices. Which
 * side of a splat a ray meets says whether it is inside that material, whatever was thought before: an error at a rim or
 * a hole lasts until the next surface. Surfaces of one material must therefore not lie inside each other. */
#include "materials/fresnel.cl"
#include "shared/render_types.h"

#define NO_MEDIUM 0xffffffffu
typedef uint4 Media;

static inline Media in_air(void) { return (uint4)(NO_MEDIUM); }

static inline Media without_medium(Media media, uint material) {
  const uint4 behind = (uint4)(media.yzw, NO_MEDIUM);
  const int x = media.x == material, y = x || media.y == material, z = y || media.z == material,
            w = z || media.w == material;
  return (uint4)(x ? behind.x : media.x, y ? behind.y : media.y, z ? behind.z : media.z, w ? behind.w : media.w);
}

/* A material that is there already comes to stand innermost; of five the outermost is forgotten. */
static inline Media within_medium(Media media, uint material) {
  return (uint4)(material, without_medium(media, material).xyz);
}

/* Index of refraction of the innermost one. */
static inline float ior_of(Media media, const __global Material* materials) {
  return media.x == NO_MEDIUM ? 1.0f : materials[media.x].ior;
}

/* What is left of light after `length` in there. */
static inline float3 beer_of(Media media, const __global Material* materials, float length) {
  return media.x == NO_MEDIUM ? (float3)(1.0f) : beer(load3(materials[media.x].absorption), length);
}
