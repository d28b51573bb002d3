/* What a block of receiving points gets of single points: fmm/operators/point_pair.h in lanes. */
#include "radiosity/fmm/lanes.cl"

/* A block of receiving points, and what they have got of each colour. */
typedef struct Receivers {
  fmm_lanes x, y, z, nx, ny, nz;
  fmm_lanes red, green, blue;
} Receivers;

/* A block's places and normals. points: x, y, z, nx, ny, nz, area, each `stride` apart. */
static inline Receivers receivers_at(const __global float* points, uint stride, uint first) {
  const __global float* p = points + first;
  Receivers r;
  r.x = load_fmm(p), r.y = load_fmm(p + stride), r.z = load_fmm(p + FMM_PLANE(2, stride));
  r.nx = load_fmm(p + FMM_PLANE(3, stride)), r.ny = load_fmm(p + FMM_PLANE(4, stride));
  r.nz = load_fmm(p + FMM_PLANE(5, stride));
  r.red = 0.0f, r.green = 0.0f, r.blue = 0.0f;
  return r;
}

/* One quarter of a near source's disc at r from the receivers: a b / (s2 (s2 + softening)), fmm/operators/point_pair.h. */
static inline fmm_lanes quarter_exchange(Receivers* r, fmm_lanes dx, fmm_lanes dy, fmm_lanes dz, fmm_lanes b,
                                         float disc2) {
  const fmm_lanes s2 = max(dx * dx + dy * dy + dz * dz, 1e-30f);
  const fmm_lanes a = max(r->nx * dx + r->ny * dy + r->nz * dz, 0.0f);
  const fmm_lanes fade = max(1.0f - s2 / (4.0f * disc2), 0.0f);
  return (a / s2) * (b / (s2 + disc2 * fade * fade));
}

/* pi / A-th of the exchange of receivers closer than FMM_CLOSE to a source with normal n: four quarters. */
static inline fmm_lanes close_exchange(Receivers* r, fmm_lanes dx, fmm_lanes dy, fmm_lanes dz, fmm_lanes b, float3 n,
                                       float area) {
  const float disc2 = 0.25f * INVERSE_PI * area;
  const float offset = sqrt(2.0f * disc2);
  const float side = n.z < 0.0f ? -1.0f : 1.0f, p = -1.0f / (side + n.z), q = n.x * n.y * p;
  const float3 u = offset * (float3)(1.0f + side * n.x * n.x * p, side * q, -side * n.x);
  const float3 v = offset * (float3)(q, side + n.y * n.y * p, -n.y);
  return 0.25f * (quarter_exchange(r, dx + u.x, dy + u.y, dz + u.z, b, disc2) +
                  quarter_exchange(r, dx - u.x, dy - u.y, dz - u.z, b, disc2) +
                  quarter_exchange(r, dx + v.x, dy + v.y, dz + v.z, b, disc2) +
                  quarter_exchange(r, dx - v.x, dy - v.y, dz - v.z, b, disc2));
}

/* pi / A-th of point_exchange() with the point at p of the planes: both clamps, nothing between. */
static inline fmm_lanes exchange_with_point(Receivers* r, const __global float* p, uint stride) {
  const fmm_lanes dx = p[0] - r->x, dy = p[stride] - r->y, dz = p[FMM_PLANE(2, stride)] - r->z;
  const float3 n = (float3)(p[FMM_PLANE(3, stride)], p[FMM_PLANE(4, stride)], p[FMM_PLANE(5, stride)]);
  const float area = p[FMM_PLANE(6, stride)];
  const fmm_lanes b = max(-(n.x * dx + n.y * dy + n.z * dz), 0.0f);
  const fmm_lanes a = max(r->nx * dx + r->ny * dy + r->nz * dz, 0.0f);
  const fmm_lanes r2 = max(dx * dx + dy * dy + dz * dz, 1e-30f);
  const fmm_lanes inverse = 1.0f / r2;
  fmm_lanes factor = (a * inverse) * (b * inverse);
  const fmm_mask close = r2 < FMM_CLOSE * area;
  if (fmm_any(close))
    factor = select(factor, close_exchange(r, dx, dy, dz, b, n, area), close);
  return factor;
}

/* What a point j of flux B A [W] a colour, planes `stride` apart, gives by a factor a lane. */
static inline void receive_flux(Receivers* r, fmm_lanes factor, const __global float* flux, uint stride, uint j) {
  r->red += factor * flux[j];
  r->green += factor * flux[FMM_PLANE(1, stride) + j];
  r->blue += factor * flux[FMM_PLANE(2, stride) + j];
}

/* What the point j of the planes `senders` gives to the receivers whose bits of `lanes` are set. */
static inline void receive_from_sender(Receivers* r, int lanes, const __global float* senders, const __global float* flux,
                                       uint stride, uint j) {
  if (((uint)lanes & FMM_OWN_BITS) == 0u)
    return;
  const fmm_lanes factor = exchange_with_point(r, senders + j, stride) * INVERSE_PI;
  receive_flux(r, select((fmm_lanes)(0.0f), factor, (((fmm_mask)(lanes) >> FMM_LANE_NUMBERS) & 1) != 0), flux, stride, j);
}

/* Irradiance of a block of receivers, of each colour. */
typedef struct Irradiance {
  fmm_lanes red, green, blue;
} Irradiance;

/* Planes `stride` apart. */
static inline Irradiance irradiance_at(const __global float* planes, uint stride, uint first) {
  const __global float* p = planes + first;
  const Irradiance sum = {load_fmm(p), load_fmm(p + stride), load_fmm(p + FMM_PLANE(2, stride))};
  return sum;
}

static inline void store_irradiance(const Irradiance* sum, __global float* planes, uint stride, uint first) {
  __global float* p = planes + first;
  store_fmm(sum->red, p);
  store_fmm(sum->green, p + stride);
  store_fmm(sum->blue, p + FMM_PLANE(2, stride));
}

/* Moves what the receivers have got to the sum. */
static inline void add_received(Irradiance* sum, Receivers* r) {
  sum->red += r->red, sum->green += r->green, sum->blue += r->blue;
  r->red = 0.0f, r->green = 0.0f, r->blue = 0.0f;
}
