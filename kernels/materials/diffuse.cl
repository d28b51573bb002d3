/* Diffuse surfaces end a specular path: their light is gathered where the path meets them. */
#include "materials/scatter.cl"
#if defined(HAS_SPECULAR) && WITH_DIFFUSE
static inline bool diffuse_sample(const Surface* s, const __global Material* materials, float3 direction, float2 u,
                                  Media* media, Scatter* out) {
  return false;
}
NO_LOBE(diffuse)
#endif
