#include "host/photon/device_photon_map.h"
#include "host/passes/variant.h"
#include <algorithm>
#include <cmath>

namespace pointgi {

namespace {

constexpr std::size_t group = 64;
/// As many samples of the area a photon of the map are enough: of k photons the area is then known better than the
/// power.
constexpr std::size_t area_samples_a_photon = 4;
/// Farther than this, in radii of its disc where each splat is a sample of the area, no point adds up areas.
constexpr double farthest = 64.0;

/// Every `step`th of the splats, in the pool's order, as the photon that caustics_of_points.cl takes it for: its power
/// is the area of all since the one before.
std::vector<Photon> area_photons(const std::vector<Splat>& receivers, std::size_t step) {
  std::vector<Photon> photons;
  float area = 0.0f;
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    const Splat& s = receivers[i];
    area += s.area;
    if (i % step != step / 2 && i + 1 != receivers.size()) continue;
    Photon photon{};
    std::copy_n(s.position, 3, photon.position);
    const float inward[3] = {-s.normal[0], -s.normal[1], -s.normal[2]};
    photon.inward = packed_direction(inward);
    photon.power[0] = area;
    photons.push_back(photon);
    area = 0.0f;
  }
  return photons;
}

} // namespace

DevicePhotonMap upload_photon_map(Session& session, const PhotonMap& map, unsigned k, double radius) {
  GatherParams params{};
  params.levels = map.levels;
  params.k = k;
  params.radius2 = static_cast<float>(std::min(radius * radius, double{PHOTON_FARTHEST2}));
  return {session.upload(map.nodes), session.upload(map.buckets), session.upload(&params, 1), k, {}};
}

bool store_caustics(Session& session, View<Splat> points, View<std::uint8_t> receives, DevicePhotonMap& map,
                    const LaunchControl& control) {
  std::vector<Splat> receivers;
  std::vector<cl_float4> places;
  for (const Splat& s : points) {
    const bool lit = receives[static_cast<std::size_t>(s.material)] != 0;
    if (lit) receivers.push_back(s);
    places.push_back({{s.position[0], s.position[1], s.position[2], lit ? s.radius : 0.0f}});
    places.push_back({{s.normal[0], s.normal[1], s.normal[2], 0.0f}});
  }
  const std::size_t photons = map.buckets.size / PHOTON_BUCKET_WORDS * PHOTON_LANES;
  const std::size_t step = std::max<std::size_t>(1, receivers.size() / (area_samples_a_photon * photons + 1));
  const DevicePhotonMap area_map =
      upload_photon_map(session, build_photon_map(area_photons(receivers, step)), map.k, INFINITY);
  const auto most_radii = static_cast<float>(farthest * std::sqrt(static_cast<double>(step)));
  const Program program = caustics_of_points_program(map.k);
  cl::Kernel kernel = session.kernel(program.file, program.options, "caustics_of_points");
  const auto device_places = session.upload(places);
  map.at_points = session.allocate<cl_float4>(points.size);
  Pace pace(1e5, busy_work_items(session.info())); // points
  const auto launch = [&](std::size_t first, std::size_t count) {
    return session.launch(kernel, LaunchShape::line(count, group), map.nodes, map.buckets, map.params, area_map.nodes,
                          area_map.buckets, area_map.params, device_places, map.at_points, most_radii,
                          static_cast<cl_uint>(first), static_cast<cl_uint>(first + count));
  };
  return for_each_batch(EqualItems{points.size}, pace, control, launch) == points.size;
}

} // namespace pointgi
