/* Mid and near rows of the links at the points: both clamps, times the visible share (method.md section 4). */
#include "radiosity/fmm/exchange.cl"

/* The points of a cluster that face one side as one flux vector a colour, at their centroid. */
static inline void receive_mid(Receivers* r, const __global FmmFlux* source, fmm_lanes share) {
  const fmm_lanes dx = source->centre[0] - r->x, dy = source->centre[1] - r->y, dz = source->centre[2] - r->z;
  const fmm_lanes inverse = 1.0f / (dx * dx + dy * dy + dz * dz);
  const fmm_lanes facing = max(r->nx * dx + r->ny * dy + r->nz * dz, 0.0f);
  const fmm_lanes scale = -INVERSE_PI * share * facing * inverse * inverse;
  const __global float* q = source->flux;
  const __global float* j = source->linearisation;
  r->red += scale * select((fmm_lanes)(0.0f), q[0] * dx + q[1] * dy + q[2] * dz, j[0] * dx + j[1] * dy + j[2] * dz < 0.0f);
  r->green += scale * select((fmm_lanes)(0.0f), q[3] * dx + q[4] * dy + q[5] * dz, j[3] * dx + j[4] * dy + j[5] * dz < 0.0f);
  r->blue += scale * select((fmm_lanes)(0.0f), q[6] * dx + q[7] * dy + q[8] * dz, j[6] * dx + j[7] * dy + j[8] * dz < 0.0f);
}

/* The points of a cluster, as receivers_at and receive_flux read them. */
static inline void receive_near(Receivers* r, const __global FmmCluster* source, fmm_lanes share,
                                const __global float* points, uint stride, const __global float* flux) {
  const fmm_lanes scale = share * INVERSE_PI;
  for (uint j = source->first_point; j < source->first_point + source->count; ++j)
    receive_flux(r, exchange_with_point(r, points + j, stride) * scale, flux, stride, j);
}

/* What the receivers see of a source: all the same, or each its own share. `block`: of the receivers, counted from the
 * first point of the receiving cluster. */
static inline fmm_lanes visible_share(float share, uint own_share, const __global uchar* point_shares, uint block) {
  if (own_share == NO_POINT_SHARES)
    return share;
  return fmm_float(load_fmm(point_shares + own_share + block)) * (1.0f / 255.0f);
}

/* irradiance[colour * stride + i] += mid and near rows of the leaf and of all clusters above it, for a block of its points.
 * NDRange: 1-D, FMM_LANES / FMM_ITEM_LANES work-items a block, padded. jobs[first_job + i] = (leaf, first point, points, -).
 * Rows as in m2l; own_share: of each entry, NO_POINT_SHARES or where its receivers' shares begin in point_shares.
 * Cluster s has the fluxes flux_begin[s] ... flux_begin[s + 1] - 1. Written by nobody else; l2p must be done. */
__kernel void receive_points(const __global uint4* jobs, uint first_job, uint count,
                             const __global FmmCluster* clusters, const __global float* points, uint stride,
                             const __global float* flux, const __global FmmFlux* fluxes,
                             const __global uint* flux_begin,
                             const __global uint* mid_begin, const __global uint* mid_source,
                             const __global float* mid_share, const __global uint* mid_own_share,
                             const __global uint* near_begin, const __global uint* near_source,
                             const __global float* near_share, const __global uint* near_own_share,
                             const __global uchar* point_shares, __global float* irradiance) {
  const uint id = FMM_BLOCK;
  if (id >= count)
    return;
  const uint4 job = jobs[first_job + id];
  Receivers r = receivers_at(points, stride, job.y);
  for (uint k = job.x;; k = clusters[k].parent) {
    const uint block = job.y - clusters[k].first_point;
    for (uint entry = mid_begin[k]; entry < mid_begin[k + 1u]; ++entry) {
      const fmm_lanes visible = visible_share(mid_share[entry], mid_own_share[entry], point_shares, block);
      const uint source = mid_source[entry];
      for (uint f = flux_begin[source]; f < flux_begin[source + 1u]; ++f)
        receive_mid(&r, fluxes + f, visible);
    }
    for (uint entry = near_begin[k]; entry < near_begin[k + 1u]; ++entry)
      receive_near(&r, clusters + near_source[entry],
                   visible_share(near_share[entry], near_own_share[entry], point_shares, block), points, stride, flux);
    if (k == 0u)
      break;
  }
  __global float* to = irradiance + job.y;
  add_block(r.red, to, job.z);
  add_block(r.green, to + stride, job.z);
  add_block(r.blue, to + FMM_PLANE(2, stride), job.z);
}
