#pragma once
#include "host/cl/session.h"
#include "host/passes/variant.h"
#include "octree/pack/step_pools.h"

namespace pointgi {

/// The three pools on the device, stored as the variant wants them. The first three arguments of every tracing kernel.
struct DevicePools {
  cl::Memory nodes;
  cl::Memory begin_end;
  cl::Memory points;
};

/// Throws Error(device) when images are wanted and the device has none, or too small ones; Error(memory).
DevicePools upload_pools(Session& session, const StepPools& pools, PoolStorage storage);

} // namespace pointgi
