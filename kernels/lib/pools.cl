/* Access to the octree's pools, the one place that knows how they are stored.
 *   TRAVERSAL_FORM FORM_STEP: node pool, Begin-End pool, point pool, stored as POOL_STORAGE says;
 *                  FORM_WIDE: WideNodes, blocks, point pool, always plain buffers
 *   POOL_BUFFER  plain buffers
 *   POOL_IMAGE1D image1d_buffer_t, RGBA 32-bit texels
 *   POOL_IMAGE2D image2d_t of 2^POOL_WIDTH_LOG2 texels a row, RGBA 32-bit texels
 * Kernels take POOL_PARAMS and hand on POOL_ARGS. In images the Begin-End pool lies four entries to a texel, because
 * OpenCL 1.2 promises no one-channel format.
 *   INLINE_FUNCTIONS  defined for drivers that mix up two images of a function's parameters (host/cl/quirks.h): every function
 *                 that may have such parameters is inlined before the driver sees that they are two */
#ifndef POOL_STORAGE
#define POOL_STORAGE POOL_BUFFER
#endif
#define POOL_BUFFER 0
#define POOL_IMAGE1D 1
#define POOL_IMAGE2D 2
#ifndef POOL_WIDTH_LOG2
#define POOL_WIDTH_LOG2 12 /* texels a row of the image2d form, log2 */
#endif
#include "shared/cone_types.h"
#include "shared/octree_types.h"
#include "shared/photon_types.h"

#ifndef TRAVERSAL_FORM
#define TRAVERSAL_FORM FORM_STEP
#endif
#define FORM_STEP 0
#define FORM_WIDE 1

#if TRAVERSAL_FORM == FORM_WIDE
#define OCTREE_ARGS node_pool, block_pool, point_pool
#define OCTREE_PARAMS \
  const __global WideNode *restrict node_pool, const __global float *restrict block_pool, const __global float4 *restrict point_pool
#define pool_point_texel(i) (point_pool[i])
#else
#define OCTREE_ARGS node_pool, begin_end_pool, point_pool
#if POOL_STORAGE == POOL_BUFFER
#define OCTREE_PARAMS \
  const __global uint4 *restrict node_pool, const __global uint *restrict begin_end_pool, const __global float4 *restrict point_pool
#define pool_node(i) (node_pool[i])
#define pool_begin_end(i) (begin_end_pool[i])
#define pool_point_texel(i) (point_pool[i])
#else
#ifdef INLINE_FUNCTIONS
#define inline inline __attribute__((always_inline))
#endif
__constant sampler_t pool_sampler = CLK_NORMALIZED_COORDS_FALSE | CLK_ADDRESS_NONE | CLK_FILTER_NEAREST;
static inline uint pool_component(uint4 texel, uint i) {
  const uint low = (i & 1u) ? texel.y : texel.x, high = (i & 1u) ? texel.w : texel.z;
  return (i & 2u) ? high : low;
}
#define pool_begin_end(i) pool_component(pool_texel_ui(begin_end_pool, (i) >> 2), (i) & 3u)
#define pool_node(i) pool_texel_ui(node_pool, i)
#define pool_point_texel(i) pool_texel_f(point_pool, i)
#if POOL_STORAGE == POOL_IMAGE1D
#define OCTREE_PARAMS __read_only image1d_buffer_t node_pool, __read_only image1d_buffer_t begin_end_pool, __read_only image1d_buffer_t point_pool
#define pool_texel_ui(pool, i) read_imageui(pool, (int)(i))
#define pool_texel_f(pool, i) read_imagef(pool, (int)(i))
#elif POOL_STORAGE == POOL_IMAGE2D
#define OCTREE_PARAMS __read_only image2d_t node_pool, __read_only image2d_t begin_end_pool, __read_only image2d_t point_pool
#define pool_at(i) ((int2)((int)((i) & ((1u << POOL_WIDTH_LOG2) - 1u)), (int)((i) >> POOL_WIDTH_LOG2)))
#define pool_texel_ui(pool, i) read_imageui(pool, pool_sampler, pool_at(i))
#define pool_texel_f(pool, i) read_imagef(pool, pool_sampler, pool_at(i))
#else
#error "POOL_STORAGE must be POOL_BUFFER, POOL_IMAGE1D or POOL_IMAGE2D"
#endif
#endif
#endif

#ifdef HAS_MLS
/* A point's PatchBend. */
#define pool_bend(i) pool_point_texel(POINT_TEXELS * (i) + 3u)
#else
#define pool_bend(i) (float4)(0.0f)
#endif

#ifdef HAS_RADIOSITY
/* Beside the points, what other surfaces send them: irradiance_pool[i].xyz [W/m2, scaled as RenderParams]. */
#define LIT_ARGS OCTREE_ARGS, irradiance_pool
#define LIT_PARAMS OCTREE_PARAMS, const __global float4 *restrict irradiance_pool
#else
#define LIT_ARGS OCTREE_ARGS
#define LIT_PARAMS OCTREE_PARAMS
#endif

#ifdef HAS_STORED_DIRECT
/* And direct light that is known at the points: direct_pool[2 i].xyz is irradiance [W/m2, scaled as RenderParams], .w the share of
 * the light of [[light]]s and emitting splats that it holds; all of the sky's where RenderParams::sky_at_points. At x it is
 * 1 + direct_pool[2 i + 1].xyz . (x - x_i) times that. */
#define STORED_ARGS LIT_ARGS, direct_pool
#define STORED_PARAMS LIT_PARAMS, const __global float4 *restrict direct_pool
#else
#define STORED_ARGS LIT_ARGS
#define STORED_PARAMS LIT_PARAMS
#endif

#ifdef HAS_CONES
/* And the light of surfaces in voxels, with the cones of a pixel (kernels/lib/cone.cl). */
#define VOXEL_ARGS STORED_ARGS, cone_grid, cone_set, cone_voxels, cone_cells
#define VOXEL_PARAMS \
  STORED_PARAMS, __constant ConeGrid *cone_grid, __constant Cone *cone_set, const __global float4 *restrict cone_voxels, \
      const __global uchar *restrict cone_cells
#else
#define VOXEL_ARGS STORED_ARGS
#define VOXEL_PARAMS STORED_PARAMS
#endif

#ifdef HAS_SPECULAR
/* And how their normals change over their discs: n(u, v) = n + u (f.x a + f.y b) + v (f.z a + f.w b), f = field_pool[i],
 * a and b the tangents of n (host/cloud/normal_field.h). */
#define NORMAL_ARGS VOXEL_ARGS, field_pool
#define NORMAL_PARAMS VOXEL_PARAMS, const __global float4 *restrict field_pool
#else
#define NORMAL_ARGS VOXEL_ARGS
#define NORMAL_PARAMS VOXEL_PARAMS
#endif

#ifdef HAS_CAUSTICS
/* And the photon map (kernels/photon/gather.cl), and what is known of it at the points already
 * (kernels/photon/caustics_of_points.cl). */
#define POOL_ARGS NORMAL_ARGS, photon_nodes, photon_buckets, gather_params, caustic_pool
#define POOL_PARAMS \
  NORMAL_PARAMS, const __global PhotonNode *restrict photon_nodes, const __global float *restrict photon_buckets, __constant GatherParams *gather_params, \
      const __global float4 *restrict caustic_pool
#else
#define POOL_ARGS NORMAL_ARGS
#define POOL_PARAMS NORMAL_PARAMS
#endif
