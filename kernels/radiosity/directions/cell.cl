/* The directions of a point.
 *   HEMICUBE  the directions are those of a hemicube's cells; else cells of the disc below the hemisphere, in each of
 *             which a place is drawn */
#include "lib/sampling.cl"

/* Direction k of a point, unit, in its own frame: its numbers depend on point, k and seed alone.
 * `cell`: first u, width in u, first v, width in v of the disc (cosine_direction); with HEMICUBE x, y, z, which are turned
 * about the normal by an angle of the point's own, or the cells' borders would be those of all points. */
static inline float3 direction_in_cell(float3 normal, float4 cell, uint point, uint k, uint seed) {
#ifdef HEMICUBE
  const uint4 h = pcg4d((uint4)(point, 0u, 0x48454D49u, seed));
  float c, s;
  COSINE_SINE(float, unit_float(h.x), c, s);
  float3 a, b;
  tangents(normal, &a, &b);
  return normalize3((c * cell.x - s * cell.y) * a + (s * cell.x + c * cell.y) * b + cell.z * normal);
#else
  const uint4 h = pcg4d((uint4)(point, k, 0x44495253u, seed));
  const float u = fma(unit_float(h.x), cell.y, cell.x), v = fma(unit_float(h.y), cell.w, cell.z), r = sqrt(u);
  float3 a, b;
  tangents(normal, &a, &b);
  float c, s; /* cosine_direction is the same by the built-in functions */
  COSINE_SINE(float, v, c, s);
  return normalize3(r * c * a + r * s * b + sqrt(fmax(0.0f, 1.0f - u)) * normal);
#endif
}
