#pragma once
/// The light of surfaces in voxels, for kernels that gather it by cones (kernels/lib/cone.cl).
#include "host/cl/session.h"
#include "shared/cone_types.h"

namespace pointgi {

struct DeviceCones {
  Buffer<ConeGrid> grid; ///< and the number of cones
  Buffer<Cone> cones;
  Buffer<cl_float4> voxels;
  Buffer<cl_uchar> cells;
  unsigned texels = 0; ///< a voxel: the kernels' CONE_SIDES
};

} // namespace pointgi
