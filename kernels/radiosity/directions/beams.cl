/* Direction k of BEAM_RAYS points as one beam, where they run close together. */
#include "lib/sampling.cl"
#include "shared/fmm_types.h"
#include "traverse/wide_beam.cl"

/* After a direction in which the beam gave up, so many follow without one: 1, and twice as many after each that follows it,
 * up to this; 1 again after a beam that did not give up. */
#ifndef MOST_WITHOUT_BEAM
#define MOST_WITHOUT_BEAM 128u
#endif

typedef struct DirectionBeams {
  Beam beam;                      /* its directions: of the direction last asked for */
  float16 ax, ay, az, bx, by, bz; /* tangents of the points' normals */
  uint point[BEAM_RAYS];
  uint wait, next_wait; /* directions without a beam: that are left; after the next that is slower */
} DirectionBeams;

/* Of the points at places[begin] and on; lanes past the last one are its first one's again, and meet nothing. */
static inline DirectionBeams beams_of_points(POOL_PARAMS, const __global uint* places, uint begin, uint points) {
  DirectionBeams b;
  float x[BEAM_RAYS], y[BEAM_RAYS], z[BEAM_RAYS], radius[BEAM_RAYS], t_min[BEAM_RAYS], t_max[BEAM_RAYS];
  float nx[BEAM_RAYS], ny[BEAM_RAYS], nz[BEAM_RAYS];
  for (uint j = 0u; j < BEAM_RAYS; ++j) {
    b.point[j] = places[begin + (j < points ? j : 0u)];
    const float4 centre = pool_point_texel(POINT_TEXELS * b.point[j]);
    const float4 normal = pool_point_texel(POINT_TEXELS * b.point[j] + 1u);
    x[j] = centre.x, y[j] = centre.y, z[j] = centre.z, radius[j] = centre.w;
    nx[j] = normal.x, ny[j] = normal.y, nz[j] = normal.z;
    t_min[j] = -SEGMENT_MARGIN(centre.w);
    t_max[j] = j < points ? INFINITY : -INFINITY;
  }
  b.beam.ox = vload16(0, x), b.beam.oy = vload16(0, y), b.beam.oz = vload16(0, z), b.beam.radius = vload16(0, radius);
  b.beam.nx = vload16(0, nx), b.beam.ny = vload16(0, ny), b.beam.nz = vload16(0, nz);
  b.beam.t_min = vload16(0, t_min), b.beam.t_max = vload16(0, t_max);
  /* tangents in lanes */
  const float16 s = copysign((float16)(1.0f), b.beam.nz), a = -1.0f / (s + b.beam.nz), xy = b.beam.nx * b.beam.ny * a;
  b.ax = 1.0f + s * b.beam.nx * b.beam.nx * a, b.ay = s * xy, b.az = -s * b.beam.nx;
  b.bx = xy, b.by = s + b.beam.ny * b.beam.ny * a, b.bz = -b.beam.ny;
  b.wait = 0u, b.next_wait = 1u;
  return b;
}

/* direction_in_cell of each point: the same bits. */
static inline void turn_beam(DirectionBeams* b, float4 cell, uint k, uint seed) {
  Beam* beam = &b->beam;
  uint16 hx = vload16(0, b->point), hy = (uint16)(k), hz = (uint16)(0x44495253u), hw = (uint16)(seed);
  PCG4D(hx, hy, hz, hw);
  const float16 u = fma(convert_float16(hx >> 8) * 0x1p-24f, (float16)(cell.y), (float16)(cell.x));
  const float16 v = fma(convert_float16(hy >> 8) * 0x1p-24f, (float16)(cell.w), (float16)(cell.z));
  const float16 r = sqrt(u);
  float16 cosine, sine;
  COSINE_SINE(float16, v, cosine, sine);
  const float16 c = r * cosine, s = r * sine;
  const float16 h = sqrt(fmax((float16)(0.0f), 1.0f - u));
  const float16 x = c * b->ax + s * b->bx + h * beam->nx, y = c * b->ay + s * b->by + h * beam->ny;
  const float16 z = c * b->az + s * b->bz + h * beam->nz, length = sqrt(fma(x, x, fma(y, y, z * z)));
  beam->dx = x / length, beam->dy = y / length, beam->dz = z / length;
}

/* Directions k, one after another from 0 on. True: `found` holds the nearest hits (trace_closest_from). */
static inline bool next_beam(POOL_PARAMS, DirectionBeams* b, float4 cell, uint k, uint seed, float3* direction, Hit* found) {
  turn_beam(b, cell, k, seed);
  float x[BEAM_RAYS], y[BEAM_RAYS], z[BEAM_RAYS];
  vstore16(b->beam.dx, 0, x), vstore16(b->beam.dy, 0, y), vstore16(b->beam.dz, 0, z);
  for (uint j = 0u; j < BEAM_RAYS; ++j)
    direction[j] = (float3)(x[j], y[j], z[j]);
  if (b->wait > 0u) {
    b->wait -= 1u;
    return false;
  }
  BeamBounds bounds;
  if (!bound_beam(&b->beam, &bounds))
    return false;
  BeamHits best;
  if (!trace_beam(POOL_ARGS, &b->beam, &bounds, &best)) {
    b->wait = b->next_wait;
    b->next_wait = min(2u * b->next_wait, MOST_WITHOUT_BEAM);
    return false;
  }
  b->next_wait = 1u;
  float t[BEAM_RAYS];
  uint splat[BEAM_RAYS];
  vstore16(best.t, 0, t), vstore16(best.splat, 0, splat);
  for (uint j = 0u; j < BEAM_RAYS; ++j)
    found[j].t = t[j], found[j].splat = splat[j];
  return true;
}
