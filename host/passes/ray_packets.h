#pragma once
/// Rays that come one behind another, as the packets that kernels trace together.
#include "octree/view.h"
#include "shared/traversal_types.h"
#include <algorithm>
#include <vector>

namespace pointgi {

/// Packet i holds the i-th PACKET_RAYS rays, which have one origin, t_min and t_max; a tail of fewer is left out.
inline std::vector<RayPacketQuery> packets_of(View<RayQuery> rays) {
  std::vector<RayPacketQuery> packets(rays.size / PACKET_RAYS);
  for (std::size_t i = 0; i < packets.size(); ++i) {
    const RayQuery& first = rays[i * PACKET_RAYS];
    std::copy_n(first.origin, 3, packets[i].origin);
    packets[i].t_min = first.t_min;
    packets[i].t_max = first.t_max;
    for (std::size_t k = 0; k < PACKET_RAYS; ++k)
      for (int a = 0; a < 3; ++a)
        packets[i].direction[a][k] = rays[i * PACKET_RAYS + k].direction[a];
  }
  return packets;
}

/// The answers of packets, ray after ray.
inline std::vector<RayAnswer> rays_of(View<RayPacketAnswer> packets) {
  std::vector<RayAnswer> answers(packets.size * PACKET_RAYS);
  for (std::size_t i = 0; i < answers.size(); ++i)
    answers[i] = {packets[i / PACKET_RAYS].t[i % PACKET_RAYS], packets[i / PACKET_RAYS].splat[i % PACKET_RAYS]};
  return answers;
}

} // namespace pointgi
