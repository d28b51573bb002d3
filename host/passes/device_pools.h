#pragma once
#include "host/cl/session.h"
#include "host/passes/variant.h"
#include "octree/pack/pools.h"

namespace pointgi {

/// The three pools on the device, in the form and storage that the variant wants. The first three arguments of every
/// tracing kernel.
struct DevicePools {
  cl::Memory nodes;
  cl::Memory leaves; ///< step: Begin-End pool; wide: blocks
  cl::Memory points;
};

/// Whether the device's images can hold the pools; true for buffers and for the wide form, which takes no images.
bool images_fit(const DeviceInfo& device, const OctreePools& pools, PoolStorage storage);

/// A point pool alone; with bends, one a point, those of patches.
cl::Memory upload_points(Session& session, View<OctreePoint> points, View<PatchBend> bends,
                         PoolStorage storage = PoolStorage::buffer);

/// Throws Error(device) when images are wanted and the device has none, or too small ones; Error(memory).
DevicePools upload_pools(Session& session, const StepPools& pools, PoolStorage storage);
DevicePools upload_pools(Session& session, const WidePools& pools);
DevicePools upload_pools(Session& session, const OctreePools& pools, PoolStorage storage);
/// Frees each pool when it is on the device. Only the points stay, and are returned.
DevicePools move_pools(Session& session, OctreePools&& pools, PoolStorage storage, Pool<OctreePoint>& points);

} // namespace pointgi
