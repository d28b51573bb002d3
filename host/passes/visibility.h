#pragma once
/// The V-map's questions answered by the device, over the pools that rendering traces too.
#include "host/cl/batches.h"
#include "host/cl/session.h"
#include "host/passes/device_pools.h"
#include "octree/vmap/make_links.h"

namespace pointgi {

class DeviceVisibility : public VisibilityOracle {
public:
  /// `points`: what segments run between, ClusterTree::points. `pools` are those of `variant` and hold all splats:
  /// those that exchange no light block it too. `step_delta`: root cube units, of the absolute-delta variant only.
  /// Session and pools must outlive this. Throws Error(device), Error(memory).
  DeviceVisibility(Session& session, const DevicePools& pools, const TraversalVariant& variant, View<Splat> points,
                   float step_delta = 0.0f);

  /// In launches of about a tenth of a second. Throws Error(device), Error(memory).
  std::vector<std::uint8_t> blocked(View<Segment> segments) override;

private:
  Session& session_;
  DevicePools pools_;
  std::size_t group_;
  float step_delta_;
  cl::Kernel kernel_;
  Buffer<Splat> points_;
  Pace pace_; ///< segments
};

} // namespace pointgi
