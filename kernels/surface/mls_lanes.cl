/* patch_ray of kernels/surface/mls.cl in vectors: one ray against a block of patches, or sixteen rays of one origin against a
 * patch. */
#include "surface/disc_lanes.cl"
#include "surface/mls.cl"

static inline lanes_f dot_lanes(lanes_f ax, lanes_f ay, lanes_f az, lanes_f bx, lanes_f by, lanes_f bz) {
  return fma(ax, bx, fma(ay, by, az * bz));
}

/* Of the patches of a block the nearer root each, or where `farther` the other one, bit-identical with FOR_MEETINGS. h->more: some
 * patch has both. */
static inline BlockHits meet_patch_lanes(const __global float* block, float3 origin, float3 direction, bool farther) {
  BlockHits h = block_of_discs(block);
  const lanes_f cx = load_lanes(block + WIDE_CENTRE(WIDE_LANES, 0)) - origin.x;
  const lanes_f cy = load_lanes(block + WIDE_CENTRE(WIDE_LANES, 1)) - origin.y;
  const lanes_f cz = load_lanes(block + WIDE_CENTRE(WIDE_LANES, 2)) - origin.z;
  const lanes_f gx = (lanes_f)(direction.x), gy = (lanes_f)(direction.y), gz = (lanes_f)(direction.z);
  const lanes_f t = dot_lanes(cx, cy, cz, gx, gy, gz);
  const lanes_f px = fma(t, gx, -cx), py = fma(t, gy, -cy), pz = fma(t, gz, -cz);
  const lanes_f r2 = h.radius * h.radius;
  const lanes_i near = (dot_lanes(px, py, pz, px, py, pz) <= PATCH_REACH2 * r2) & (h.radius > 0.0f);
  h.t = (lanes_f)(-INFINITY);
  h.q = (lanes_f)(0.0f);
  h.inside = (lanes_i)(0);
  h.more = false;
  if (!any_lane(near))
    return h;
  /* tangents, in lanes */
  const lanes_f s = copysign((lanes_f)(1.0f), h.nz), a = -1.0f / (s + h.nz), b = h.nx * h.ny * a;
  const lanes_f ux = 1.0f + s * h.nx * h.nx * a, uy = s * b, uz = -s * h.nx;
  const lanes_f vx = b, vy = s + h.ny * h.ny * a, vz = -h.ny;
  const lanes_f x = dot_lanes(ux, uy, uz, px, py, pz), y = dot_lanes(vx, vy, vz, px, py, pz);
  const lanes_f z = dot_lanes(h.nx, h.ny, h.nz, px, py, pz);
  const lanes_f dx = dot_lanes(ux, uy, uz, gx, gy, gz), dy = dot_lanes(vx, vy, vz, gx, gy, gz);
  const lanes_f dz = dot_lanes(h.nx, h.ny, h.nz, gx, gy, gz);
  const lanes_f xx = load_lanes(block + WIDE_BEND(WIDE_LANES, 0)), xy = load_lanes(block + WIDE_BEND(WIDE_LANES, 1));
  const lanes_f yy = load_lanes(block + WIDE_BEND(WIDE_LANES, 2));
  lanes_f near_s, far_s;
  PATCH_ROOTS(lanes_f, lanes_i, x, y, z, dx, dy, dz, xx, xy, yy, r2, PATCH_HEIGHT * h.radius, near, near_s, far_s)
  h.more = any_lane(far_s < INFINITY);
  const lanes_f root = farther ? far_s : near_s;
  h.inside = root < INFINITY;
  const lanes_f at_x = fma(root, dx, x), at_y = fma(root, dy, y);
  h.t = t + root;
  h.q = fma(at_x, at_x, at_y * at_y) / r2;
  /* patch_normal, in lanes */
  const lanes_f along_u = fma(2.0f * xx, at_x, xy * at_y), along_v = fma(2.0f * yy, at_y, xy * at_x);
  const lanes_f length = sqrt(fma(along_u, along_u, fma(along_v, along_v, (lanes_f)(1.0f))));
  h.nx = (h.nx - along_u * ux - along_v * vx) / length;
  h.ny = (h.ny - along_u * uy - along_v * vy) / length;
  h.nz = (h.nz - along_u * uz - along_v * vz) / length;
  return h;
}

#define FOR_HITS_OF_BLOCK(block, ray, h, body)                                                               \
  for (uint root_ = 0u, more_ = 1u; root_ < 2u && more_; ++root_) {                                          \
    const BlockHits h = meet_patch_lanes(block, (ray).origin, (ray).direction, root_ == 1u);                 \
    more_ = h.more ? 1u : 0u;                                                                                \
    body                                                                                                     \
  }

/* The hits' normals, which are not those of the points. */
typedef struct LaneNormals {
  float x[WIDE_LANES], y[WIDE_LANES], z[WIDE_LANES];
} LaneNormals;
#define KEEP_NORMALS(h, kept) \
  LaneNormals kept;           \
  store_lanes((h)->nx, kept.x); \
  store_lanes((h)->ny, kept.y); \
  store_lanes((h)->nz, kept.z)
#define KEPT_NORMAL(kept, lane, i) \
  (float4)(kept.x[lane], kept.y[lane], kept.z[lane], pool_point_texel(POINT_TEXELS * (i) + 1u).w)

/* A patch with sixteen rays of one origin. */
typedef struct PatchRays {
  float3 u, v;
  float16 t, x, y, dx, dy, near_s, far_s;
} PatchRays;

/* patch_ray of each ray with the unit direction (gx, gy, gz), bit-identical. centre: from the rays' origin. */
static inline PatchRays patch_rays(float16 gx, float16 gy, float16 gz, float3 centre, float radius, float3 n, float3 bend) {
  PatchRays p;
  tangents(n, &p.u, &p.v);
  const float3 u = p.u, v = p.v;
  p.t = fma((float16)(centre.x), gx, fma((float16)(centre.y), gy, centre.z * gz));
  const float16 px = fma(p.t, gx, (float16)(-centre.x)), py = fma(p.t, gy, (float16)(-centre.y)),
                pz = fma(p.t, gz, (float16)(-centre.z));
  const float16 r2 = (float16)(radius * radius);
  const int16 near = fma(px, px, fma(py, py, pz * pz)) <= PATCH_REACH2 * r2;
  p.x = fma((float16)(u.x), px, fma((float16)(u.y), py, u.z * pz));
  p.y = fma((float16)(v.x), px, fma((float16)(v.y), py, v.z * pz));
  const float16 z = fma((float16)(n.x), px, fma((float16)(n.y), py, n.z * pz));
  p.dx = fma((float16)(u.x), gx, fma((float16)(u.y), gy, u.z * gz));
  p.dy = fma((float16)(v.x), gx, fma((float16)(v.y), gy, v.z * gz));
  const float16 dz = fma((float16)(n.x), gx, fma((float16)(n.y), gy, n.z * gz));
  const float16 xx = (float16)(bend.x), xy = (float16)(bend.y), yy = (float16)(bend.z);
  const float16 height = (float16)(PATCH_HEIGHT * radius);
  PATCH_ROOTS(float16, int16, p.x, p.y, z, p.dx, p.dy, dz, xx, xy, yy, r2, height, near, p.near_s, p.far_s)
  return p;
}

/* Cosines of the patch's normals at s with the rays, but for a positive factor. */
static inline float16 cosines_of_rays(const PatchRays* p, float16 s, float16 gx, float16 gy, float16 gz, float3 n, float3 bend) {
  const float16 x = fma(s, p->dx, p->x), y = fma(s, p->dy, p->y);
  const float16 along_u = fma((float16)(2.0f * bend.x), x, bend.y * y), along_v = fma((float16)(2.0f * bend.z), y, bend.y * x);
  const float16 length = sqrt(fma(along_u, along_u, fma(along_v, along_v, (float16)(1.0f))));
  const float16 nx = (n.x - along_u * p->u.x - along_v * p->v.x) / length;
  const float16 ny = (n.y - along_u * p->u.y - along_v * p->v.y) / length;
  const float16 nz = (n.z - along_u * p->u.z - along_v * p->v.z) / length;
  return fma(nx, gx, fma(ny, gy, nz * gz));
}
