#pragma once
/// The photon map on the device.
#include "host/cl/batches.h"
#include "host/cl/session.h"
#include "host/photon/photon_map.h"
#include "octree/splat.h"

namespace pointgi {

struct DevicePhotonMap {
  Buffer<PhotonNode> nodes;
  Buffer<float> buckets;
  Buffer<GatherParams> params;
  unsigned k = 0;              ///< photons an estimate
  Buffer<cl_float4> at_points; ///< what is known of the points of a pool already (store_caustics); empty: nothing is
};

/// `k` photons an estimate, none farther than `radius`, root cube units (> 0; infinity: no limit).
/// Throws Error(device), Error(memory).
DevicePhotonMap upload_photon_map(Session& session, const PhotonMap& map, unsigned k, double radius);

/// Finds what the photons of `map` bring to those of the pool's points that receive light (of each material: whether
/// its splats do), and keeps it there as kernels/photon/caustics_of_points.cl says. False when `stop` ended it. Throws
/// Error(device), Error(memory).
bool store_caustics(Session& session, View<Splat> points, View<std::uint8_t> receives, DevicePhotonMap& map,
                    const LaunchControl& control);

} // namespace pointgi
