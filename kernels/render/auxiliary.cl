/* What guides a denoiser, beside the light: albedo and normal of the first surface that reflects diffusely or by a lobe,
 * followed through mirrors and glass, and the light that the eye sees directly, which needs no denoising.
 *   HAS_AUXILIARY  defined where the picture is asked for them */
#include "lights/lights.cl"
#include "materials/materials.cl"
#include "render/film.cl"

#ifdef HAS_AUXILIARY

/* Of what reflects by a lobe, its reflectance belongs to it. */
static inline float3 auxiliary_albedo(const Surface* s, const __global Material* material) {
  const float3 none = (float3)(0.0f);
  const float3 diffuse = has_flag(material, MATERIAL_REFLECTS_DIFFUSELY) ? s->albedo : none;
  const float3 lobe = has_flag(material, MATERIAL_HAS_LOBE) ? load3(material->specular) : none;
  return fmin(diffuse + lobe, (float3)(1.0f));
}

/* Adds what the ray has met, once a sample and bounce, without a branch; returns whether to look at what the next ray meets.
 * `follows`: all surfaces before were mirrors and glass, which have left `throughput` of the albedo and all of the normal. A
 * ray that meets nothing finds albedo 1 and no normal. A ray that ends on a mirror or glass adds nothing. */
static inline bool add_auxiliary(bool follows, Lights lights, bool met, const Surface* s, float3 throughput, float* sums) {
  const __global Material* material = lights.materials + (met ? s->material : 0u);
  const bool passes = met && has_flag(material, MATERIAL_SPECULAR) &&
                      !has_flag(material, MATERIAL_REFLECTS_DIFFUSELY | MATERIAL_HAS_LOBE);
  const bool found = follows && !passes;
  const float3 none = (float3)(0.0f);
  const float3 albedo = found ? throughput * (met ? auxiliary_albedo(s, material) : (float3)(1.0f)) : none;
  const float3 normal = found && met ? s->normal : none;
  sums[SUM_AUXILIARY + AUXILIARY_ALBEDO] += albedo.x;
  sums[SUM_AUXILIARY + AUXILIARY_ALBEDO + 1] += albedo.y;
  sums[SUM_AUXILIARY + AUXILIARY_ALBEDO + 2] += albedo.z;
  sums[SUM_AUXILIARY + AUXILIARY_NORMAL] += normal.x;
  sums[SUM_AUXILIARY + AUXILIARY_NORMAL + 1] += normal.y;
  sums[SUM_AUXILIARY + AUXILIARY_NORMAL + 2] += normal.z;
  return follows && passes;
}

/* The part of FILM_DIRECT that no surface has reflected. */
static inline void add_emission(float3 radiance, float* sums) {
  sums[SUM_AUXILIARY + AUXILIARY_EMISSION] += radiance.x;
  sums[SUM_AUXILIARY + AUXILIARY_EMISSION + 1] += radiance.y;
  sums[SUM_AUXILIARY + AUXILIARY_EMISSION + 2] += radiance.z;
}
#endif
