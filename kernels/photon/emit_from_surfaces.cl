/* Photons by which specular splats receive the light of diffuse surfaces, found from where they arrive: a point of such a
 * splat looks for what sends it light from a random direction. All photons are then about equally strong, however near to
 * the mirror the surface lies that sends them; aimed from there, those of the nearest would be hundreds of times stronger
 * than others.
 *   FROM_SURFACES  defined where these photons are sent; emitters are then the specular splats, in proportion to their
 *                  areas, those of glass to both sides', radiance[i] what point i of the pool sends from its front */
#include "photon/emit.cl"
#include "lib/specular.cl"

/* Photon `number` of the aim's, on its way from the surface that sends it; of no power where there is none. */
static inline Emission emit_from_surfaces(POOL_PARAMS, PhotonSource from, const __global PhotonAim* aim, uint number,
                                          SampleId id, float* rays) {
  const float2 v = stratified2(aim, number, id);
  const float4 u = random4(id, DIMENSION_ORIGIN);
  const uint i = pick(&from.lights.emitters->cumulative, sizeof(Emitter) / sizeof(float), from.lights.params->emitters, v.x);
  const float chosen = from.lights.emitters[i].cumulative - (i > 0u ? from.lights.emitters[i - 1u].cumulative : 0.0f);
  const uint point = from.lights.emitters[i].point;
  const float4 centre = pool_point_texel(POINT_TEXELS * point), normal = pool_point_texel(POINT_TEXELS * point + 1u);
  const float area = pool_point_texel(POINT_TEXELS * point + 2u).w;
  const uint material = (uint)normal.w;
  const bool two_sided = from.lights.materials[material].type == MATERIAL_GLASS, inside = two_sided && u.w < 0.5f;
  Ray ray;
  ray.origin = centre.xyz + disc_point(normal.xyz, sqrt(area * 0.31830989f), u.x, u.y);
  ray.direction = cosine_direction(inside ? -normal.xyz : normal.xyz, v.y, u.z);
  ray.t_min = BEHIND_SURFACE;
  ray.t_max = INFINITY;
#ifdef STEP_ABSOLUTE
  ray.step_delta = from.lights.params->step_delta;
#endif
  ShadowEnds ends = free_ends();
  ends.origin_normal = normal.xyz;
  ends.origin_radius = centre.w;
  ends.origin_material = material + 1u;
  ends.origin_back = inside ? 1u : 0u;
  ends.medium = inside ? material + 1u : 0u;
  Emission e;
  e.ends = free_ends();
  e.ray = ray;
  e.power = (float3)(0.0f);
  Surface s;
  const Hit hit = trace_closest_from(POOL_ARGS, ray, ends);
  if (blended_surface(POOL_ARGS, ray, ends, hit, &s, rays) && s.front && chosen > 0.0f) {
    e.ends.origin_normal = s.normal;
    e.ends.origin_radius = s.radius;
    e.ray.origin = s.position;
    e.ray.direction = -ray.direction;
    e.power = from.radiance[s.splat].xyz * (3.14159265f * area * (two_sided ? 2.0f : 1.0f) * aim->share / chosen);
  }
  return e;
}
