/* Photons by which specular splats receive the light of diffuse surfaces, found from where they arrive: a point of such a
 * splat looks in a random direction for what sends it light. A photon is then as strong as what it finds is bright, however
 * near that is; aimed from there, those of the surface next to a mirror would be hundreds of times stronger than others.
 *   FROM_SURFACES  defined where these photons are sent; emitters are then the specular splats, radiance[i] what point i of
 *                  the pool sends from its front */
#include "photon/emit.cl"
#include "materials/materials.cl"

/* Photon `number` of the batch's, as it looks for light; its power is for a radiance of 1. */
static inline Emission look_for_light(POOL_PARAMS, PhotonSource from, const __global EmissionBatch* batch, uint number,
                                      SampleId id) {
  const float2 v = stratified2(batch, number, id);
  const float4 u = random4(id, DIMENSION_ORIGIN);
  const uint i = pick(&from.lights.emitters->cumulative, sizeof(Emitter) / sizeof(float), from.lights.params->emitters, v.x);
  const float chosen = from.lights.emitters[i].cumulative - (i > 0u ? from.lights.emitters[i - 1u].cumulative : 0.0f);
  const uint point = from.lights.emitters[i].point;
  const float4 centre = pool_point_texel(POINT_TEXELS * point), normal = pool_point_texel(POINT_TEXELS * point + 1u);
  const float area = pool_point_texel(POINT_TEXELS * point + 2u).w;
  const uint material = (uint)normal.w;
  const bool transmits = has_flag(from.lights.materials + material, MATERIAL_TRANSMITS), inside = transmits && u.w < 0.5f;
  Emission e;
  e.ray.origin = centre.xyz + disc_point(normal.xyz, sqrt(area * 0.31830989f), u.x, u.y);
  e.ray.direction = cosine_direction(inside ? -normal.xyz : normal.xyz, v.y, u.z);
  e.ray.t_min = BEHIND_SURFACE(centre.w);
  e.ray.t_max = INFINITY;
#ifdef STEP_ABSOLUTE
  e.ray.step_delta = from.lights.params->step_delta;
#endif
  e.ends = free_ends();
  e.ends.origin_normal = normal.xyz;
  e.ends.origin_radius = centre.w;
  e.ends.origin_material = material + 1u;
  e.ends.origin_back = inside ? 1u : 0u;
  e.ends.medium = inside ? material + 1u : 0u;
  e.power = chosen > 0.0f ? (float3)(3.14159265f * area * (transmits ? 2.0f : 1.0f) * batch->share / chosen) : (float3)(0.0f);
  return e;
}

/* Back from the surface that sends the light. */
static inline void turn_round(const Surface* s, Ray* ray, OcclusionEnds* ends) {
  ray->origin = s->position;
  ray->direction = -ray->direction;
  *ends = free_ends();
  ends->origin_normal = s->normal;
  ends->origin_radius = s->radius;
}
