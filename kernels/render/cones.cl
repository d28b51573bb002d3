/* Light from surface to surface that a pixel gathers itself, by cones through voxels (method.md section 8).
 *   HAS_CONES  defined where it does */
#include "traverse/traversal.cl"
#include "lib/sampling.cl"
#ifdef HAS_CONES
#include "lib/cone.cl"

/* Use of random numbers at a vertex: the path tracer's DIMENSION_BOUNCE, which is in no program with cones. */
#define DIMENSION_CONES 4u
#endif

/* Irradiance [W/m2, scaled] of the surface's front from other surfaces: what is stored with its points, and what its cones
 * find. Each sample turns them about the normal, or they would all miss the same. */
static inline float3 irradiance_from_surfaces(POOL_PARAMS, const Surface* s, SampleId id) {
#if defined(HAS_CONES)
  const float turn = 6.2831853f * stratified4(id, DIMENSION_CONES).x;
  const ConeVoxels from = {cone_voxels, cone_cells};
  return s->irradiance + cone_irradiance(from, cone_grid, cone_set, s->position, s->normal, turn);
#elif defined(HAS_RADIOSITY)
  return s->irradiance;
#else
  return (float3)(0.0f);
#endif
}
