/* Adaptive sampling: of a pixel in which nothing changes, few samples of a pass speak for all (method.md section 6). Which
 * pixels those are is told by what all eye rays of the pass meet, never by the light that a sample finds: samples of a
 * pixel are alike or they are not before any of them is shaded, so that the choice does not bias the mean.
 *   HAS_STORED_DIRECT  or no light is sampled at pixels at all; else no pixel is chosen */
#include "lights/lights.cl"
#include "render/eye_sample.cl"

/* Largest difference of albedo, of its strongest colour, within such a pixel. */
#define ALIKE_ALBEDO 0.05f
/* Cosine of the largest angle between normals there. */
#define ALIKE_COSINE 0.99f
/* One sample of each cell of this many columns and rows is shaded. */
#define CELL_COLUMNS 2u
#define CELL_ROWS 2u

/* Whether all light of the disc is known without rays of the pixel's own. */
static inline bool needs_no_rays(POOL_PARAMS, Lights lights, uint splat) {
#if defined(HAS_CONES)
  return false;
#elif defined(HAS_LIGHT)
#ifdef HAS_STORED_DIRECT
  const float3 sky = load3_constant(lights.params->environment);
  const bool has_sky = lights.params->sky_at_points == 0u && (sky.x > 0.0f || sky.y > 0.0f || sky.z > 0.0f);
  const bool has_sources = lights.params->light_sources + lights.params->emitters > 0u;
  return !has_sky && (!has_sources || direct_pool[2u * splat].w > ALL_STORED);
#else
  return false;
#endif
#else
  return true;
#endif
}

/* How far apart the planes of two splats of one surface may lie: of flat ones, rounding; else what is blended
 * (kernels/surface/blend.cl). */
static inline float height_within_surface(float4 normal, float radii) {
#ifdef HAS_CLIPS
  if (IS_FLAT(normal.w))
    return FLAT_HEIGHT;
#endif
  return 0.5f * radii;
}

/* Whether a sample finds about what another one does, `splat` and `first` being what their eye rays meet first. */
static inline bool is_alike(POOL_PARAMS, Lights lights, uint splat, uint first) {
  if (splat == NO_SPLAT || first == NO_SPLAT) {
#ifdef HAS_SKY_MAP
    return false;
#else
    return splat == first;
#endif
  }
  const float4 normal = pool_point_texel(POINT_TEXELS * splat + 1u), normal0 = pool_point_texel(POINT_TEXELS * first + 1u);
  const __global Material* material = lights.materials + (uint)normal.w;
#ifdef HAS_SPECULAR
  if (has_flag(material, MATERIAL_SPECULAR | MATERIAL_HAS_LOBE | MATERIAL_TRANSMITS))
    return false;
#endif
  if (!needs_no_rays(POOL_ARGS, lights, splat))
    return false;
  if (splat == first)
    return true;
  const float4 centre = pool_point_texel(POINT_TEXELS * splat), centre0 = pool_point_texel(POINT_TEXELS * first);
  const float3 apart = fabs(pool_point_texel(POINT_TEXELS * splat + 2u).xyz - pool_point_texel(POINT_TEXELS * first + 2u).xyz);
  return normal.w == normal0.w && dot3(normal.xyz, normal0.xyz) > ALIKE_COSINE &&
         fabs(dot3(normal0.xyz, centre.xyz - centre0.xyz)) <= height_within_surface(normal0, centre.w + centre0.w) &&
         fmax(fmax(apart.x, apart.y), apart.z) < ALIKE_ALBEDO;
}

/* The sample of the pass that speaks for sample `lane` in such a pixel: one of its cell, drawn anew for every pixel, pass and
 * cell. Passes that are no grid of at least CELL_COLUMNS x CELL_ROWS are shaded whole. */
static inline uint speaker_of(SampleId id, uint samples, uint lane) {
  const PixelPass pass = pixel_pass(id, samples, false);
  if (pass.taken.x != 0u || pass.strata.x < CELL_COLUMNS || pass.strata.y < CELL_ROWS)
    return lane;
  const uint2 cell = (uint2)(pass.strata.x / CELL_COLUMNS, pass.strata.y / CELL_ROWS); /* strata of a cell */
  const uint2 at = (uint2)(lane % pass.strata.x / cell.x, lane / pass.strata.x / cell.y);
  const uint4 h = pcg4d((uint4)(id.pixel.x, id.pixel.y, 0x41444150u + id.sample / GRID_RAYS,
                                id.seed * 0x9E3779B9u + CELL_COLUMNS * at.y + at.x));
  return (at.y * cell.y + h.y % cell.y) * pass.strata.x + at.x * cell.x + h.x % cell.x;
}
