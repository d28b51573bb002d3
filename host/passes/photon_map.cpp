#include "host/passes/photon_map.h"
#include <algorithm>

namespace pointgi {

DevicePhotonMap upload_photon_map(Session& session, const PhotonMap& map, unsigned k, double radius) {
  GatherParams params{};
  params.levels = map.levels;
  params.k = k;
  params.radius2 = static_cast<float>(std::min(radius * radius, double{PHOTON_FARTHEST2}));
  return {session.upload(map.nodes), session.upload(map.buckets), session.upload(&params, 1), k};
}

} // namespace pointgi
