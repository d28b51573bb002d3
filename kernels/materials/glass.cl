/* Smooth glass, from either side. The ray is reflected with the probability of the Fresnel reflectance (u.x decides), else
 * let through; all of the light goes the way that is chosen. Radiance is carried divided by the index of refraction squared,
 * as glass leaves it: what lies inside glass looks as if behind a thin gap of air. */
#include "materials/fresnel.cl"
#include "materials/scatter.cl"
#if defined(HAS_SPECULAR) && WITH_GLASS
/* `media`: before the surface; becomes those behind it. */
static inline bool glass_sample(const Surface* s, const __global Material* materials, float3 direction, float2 u,
                                Media* media, Scatter* out) {
  const float3 n = facing_normal(s, direction);
  const Media beyond = s->front ? within_medium(*media, s->material) : without_medium(*media, s->material);
  const float cosine = fmin(-dot3(direction, n), 1.0f), eta = ior_of(beyond, materials) / ior_of(*media, materials);
  float cosine_t;
  const bool reflected = u.x < fresnel_dielectric(cosine, eta, &cosine_t);
  out->direction = reflected ? reflect3(direction, n) : refract3(direction, n, cosine, cosine_t, eta);
  out->weight = (float3)(1.0f);
  out->pdf = 0.0f;
  out->back = reflected != s->front;
  out->through = !reflected;
  if (!reflected)
    *media = beyond;
  return true;
}
NO_LOBE(glass)
#endif
