/* Mirrors reflect from their front; their back is black. */
#include "materials/fresnel.cl"
#include "materials/scatter.cl"
#if defined(HAS_SPECULAR) && WITH_MIRROR
static inline bool mirror_sample(const Surface* s, const __global Material* materials, float3 direction, float2 u,
                                 Media* media, Scatter* out) {
  out->direction = reflect3(direction, facing_normal(s, direction));
  out->weight = load3(materials[s->material].specular);
  out->pdf = 0.0f;
  out->back = out->through = false;
  return s->front;
}
NO_LOBE(mirror)
#endif
