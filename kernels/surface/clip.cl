/* Discs that end at a border (DiscClip of shared/octree_types.h), and that clip their own samples.
 *   HAS_CLIPS  defined where some splat of the scene is clipped */
#include "lib/vector.cl"
#include "shared/octree_types.h"

/* A strip as stored, from its first word on. */
#define STRIP_AXIS(words) load3(words)
#define STRIP_LOW(words) ((words)[3])
#define STRIP_HIGH(words) ((words)[4])

/* Whether a place of the disc, `off` from its centre, lies past its border. */
static inline bool is_clipped_off(const __global float* clip, float3 off) {
  bool outside = false;
  for (int k = 0; k < CLIP_STRIPS; ++k, clip += STRIP_WORDS) {
    const float s = dot3(STRIP_AXIS(clip), off);
    outside = outside || s < STRIP_LOW(clip) || s > STRIP_HIGH(clip);
  }
  return outside;
}

/* A place of the disc of a splat's area, folded back at the borders that it lies past: samples of a light stay on the
 * light. */
static inline float3 fold_into_clip(const __global DiscClip* clip, float3 off) {
  for (int k = 0; k < CLIP_STRIPS; ++k) {
    const float3 axis = load3(clip->strip[k].axis);
    const float low = clip->strip[k].low, high = clip->strip[k].high, s = dot3(axis, off);
    const float folded = s > high ? 2.0f * high - s : s < low ? 2.0f * low - s : s;
    off += (clamp(folded, low, high) - s) * axis;
  }
  return off;
}
