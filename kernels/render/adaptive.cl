/* Adaptive sampling: of a pixel in which the surface does not change, few samples of a pass speak for all (method.md section
 * 6): for all of their light where it is known at the points; else for the surface and all light but that of shadow rays,
 * which each sample asks for itself. Which pixels those are is told by what all eye rays of the pass
 * meet, never by the light that a sample finds: samples of a pixel are alike or they are not before any of them is shaded,
 * so that the choice does not bias the mean.
 *   HAS_CONES  no pixel is chosen */
#include "lights/lights.cl"
#include "render/eye_sample.cl"

/* Largest difference of albedo from the first sample's, of its strongest colour, within such a pixel. */
#define ALIKE_ALBEDO 0.05f
/* Cosine of the largest angle between normals there. */
#define ALIKE_COSINE 0.99f
/* One sample of each cell of this many columns and rows is shaded. */
#define CELL_COLUMNS 2u
#define CELL_ROWS 2u
#define CELLS (CELL_COLUMNS * CELL_ROWS)

/* What two samples of a pixel have in common, bits. */
#define ALIKE_SURFACE 1u /* what their eye rays meet */
#define ALIKE_LIGHT 2u   /* and all light there, which no ray is needed to find */

/* Whether all light of the disc is known without rays of the pixel's own. */
static inline bool needs_no_rays(POOL_PARAMS, Lights lights, uint splat) {
#ifdef HAS_LIGHT
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

/* What a sample has in common with another one, `splat` and `first` being what their eye rays meet first. */
static inline uint alike(POOL_PARAMS, Lights lights, uint splat, uint first) {
#ifdef HAS_CONES
  return 0u;
#else
  if (splat == NO_SPLAT || first == NO_SPLAT) {
#ifdef HAS_SKY_MAP
    return 0u;
#else
    return splat == first ? ALIKE_SURFACE | ALIKE_LIGHT : 0u;
#endif
  }
  const float4 normal = pool_point_texel(POINT_TEXELS * splat + 1u), normal0 = pool_point_texel(POINT_TEXELS * first + 1u);
#ifdef HAS_SPECULAR
  if (has_flag(lights.materials + (uint)normal.w, MATERIAL_SPECULAR | MATERIAL_HAS_LOBE | MATERIAL_TRANSMITS))
    return 0u;
#endif
  if (splat != first) {
    const float4 centre = pool_point_texel(POINT_TEXELS * splat), centre0 = pool_point_texel(POINT_TEXELS * first);
    const float3 apart = fabs(pool_point_texel(POINT_TEXELS * splat + 2u).xyz - pool_point_texel(POINT_TEXELS * first + 2u).xyz);
    if (normal.w != normal0.w || !(dot3(normal.xyz, normal0.xyz) > ALIKE_COSINE) ||
        !(fabs(dot3(normal0.xyz, centre.xyz - centre0.xyz)) <= height_within_surface(normal0, centre.w + centre0.w)) ||
        !(fmax(fmax(apart.x, apart.y), apart.z) < ALIKE_ALBEDO))
      return 0u;
  }
  return needs_no_rays(POOL_ARGS, lights, splat) ? ALIKE_SURFACE | ALIKE_LIGHT : ALIKE_SURFACE;
#endif
}

/* Whether the pass is a grid that has all cells: only then one sample of each may speak. */
static inline bool has_cells(PixelPass pass) {
  return pass.taken.x == 0u && pass.strata.x >= CELL_COLUMNS && pass.strata.y >= CELL_ROWS;
}

/* The cell of sample `lane` of a pass. */
static inline uint cell_of(PixelPass pass, uint lane) {
  const uint column = lane % pass.strata.x / (pass.strata.x / CELL_COLUMNS);
  return CELL_COLUMNS * (lane / pass.strata.x / (pass.strata.y / CELL_ROWS)) + column;
}

/* The sample that speaks for all of a cell, drawn anew for every pixel, pass and cell. */
static inline uint speaker_of(SampleId id, PixelPass pass, uint cell) {
  const uint2 size = (uint2)(pass.strata.x / CELL_COLUMNS, pass.strata.y / CELL_ROWS); /* strata of a cell */
  const uint4 h = pcg4d((uint4)(id.pixel.x, id.pixel.y, 0x41444150u + id.sample / GRID_RAYS, id.seed * 0x9E3779B9u + cell));
  return (cell / CELL_COLUMNS * size.y + h.y % size.y) * pass.strata.x + cell % CELL_COLUMNS * size.x + h.x % size.x;
}

/* The surface that one sample found, where another one's eye ray meets it. */
static inline Surface surface_at(Surface s, Ray ray, Hit hit) {
  s.t = hit.t;
  s.position = fma((float3)(hit.t), ray.direction, ray.origin);
  return s;
}
