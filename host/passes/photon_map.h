#pragma once
/// The photon map on the device.
#include "host/cl/session.h"
#include "host/photon/photon_map.h"

namespace pointgi {

struct DevicePhotonMap {
  Buffer<PhotonNode> nodes;
  Buffer<float> buckets;
  Buffer<GatherParams> params;
  unsigned k = 0; ///< photons an estimate
};

/// `k` photons an estimate, none farther than `radius`, root cube units (> 0; infinity: no limit).
/// Throws Error(device), Error(memory).
DevicePhotonMap upload_photon_map(Session& session, const PhotonMap& map, unsigned k, double radius);

} // namespace pointgi
