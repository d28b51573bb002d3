#pragma once
/// Splats as voxels on the device, and the pyramid of their light (kernels/radiosity/cones; docs/method/cones.md).
#include "host/cl/batches.h"
#include "host/cl/session.h"
#include "octree/splat.h"
#include "octree/view.h"
#include "shared/cone_types.h"

namespace pointgi {

struct VoxelOptions {
  unsigned side = 64;      ///< finest voxels a side: a power of two, 8 to 256
  bool anisotropic = true; ///< six texels a voxel; else one
};

/// The cube of voxels that holds the discs, with one and a half voxels to spare on all sides; cone_count is 0. Throws
/// std::invalid_argument where `side` is out of range or there are no points.
ConeGrid cone_grid(View<Splat> points, unsigned side);

/// Texels a voxel, CONE_SIDES of the kernels.
inline unsigned texels_of(bool anisotropic) {
  return anisotropic ? CONE_SIDES_ANISOTROPIC : CONE_SIDES_ISOTROPIC;
}

/// What stands where is found once; light goes in as often as asked. A voxel sums its splats in their order: the same
/// bits whatever the threads and launches.
class VoxelPyramid {
public:
  /// `points`: all that block light. Throws Error(memory) where the voxels do not fit, Error(device),
  /// std::invalid_argument as cone_grid. `session` must outlive this.
  VoxelPyramid(Session& session, View<Splat> points, const VoxelOptions& options);

  /// Every voxel of every level becomes what these radiosities make of it. `radiosity` [points x 4, W/m²]: R, G, B and
  /// a number that is not read.
  void inject(View<cl_float4> radiosity);

  const ConeGrid& grid() const { return grid_; }
  unsigned texels() const { return texels_; } ///< a voxel
  /// kernels/lib/cone.cl's `voxels`.
  const Buffer<cl_float4>& voxels() const { return voxels_; }
  /// kernels/lib/cone.cl's `cells`.
  const Buffer<cl_uchar>& cells() const { return cells_; }
  /// The splats as uploaded, in their order.
  const Buffer<OctreePoint>& points() const { return points_; }
  std::size_t occupied() const { return levels_.front().size; } ///< finest voxels that hold surface
  std::size_t shares() const { return splats_.size; }           ///< pairs of a splat and a voxel that it overlaps

private:
  using Level = Buffer<cl_uint>; ///< voxels that hold surface, by their number, ascending

  std::vector<VoxelShare> voxelise(std::vector<cl_uint>& begin);
  void sort_shares(const std::vector<VoxelShare>& shares, const std::vector<cl_uint>& begin);
  void make_levels(std::vector<cl_uint> occupied);
  void allocate_voxels();

  Session& session_;
  ConeGrid grid_{};
  unsigned texels_;
  Buffer<ConeGrid> grid_buffer_;
  Buffer<OctreePoint> points_;
  std::vector<Level> levels_;      ///< the finest first
  Buffer<cl_uint> begin_, splats_; ///< of the finest voxels that hold surface: kernels/radiosity/cones/pyramid.cl
  Buffer<cl_float> areas_;
  Buffer<cl_float4> voxels_;
  Buffer<cl_uchar> cells_;
  cl::Kernel inject_, average_;
  Pace injections_, averages_;
};

} // namespace pointgi
