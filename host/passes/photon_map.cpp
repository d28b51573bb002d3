#include "host/passes/photon_map.h"
#include "host/passes/variant.h"
#include <algorithm>

namespace pointgi {

namespace {

constexpr std::size_t group = 64;
/// Points of a launch: some tenths of a second at most.
constexpr std::size_t points_at_once = 1u << 15;

/// A splat as the photon that caustics_of_points.cl takes it for: its area is its power.
Photon area_photon(const Splat& splat) {
  Photon photon{};
  std::copy_n(splat.position, 3, photon.position);
  const float inward[3] = {-splat.normal[0], -splat.normal[1], -splat.normal[2]};
  photon.inward = packed_direction(inward);
  photon.power[0] = splat.area;
  return photon;
}

} // namespace

DevicePhotonMap upload_photon_map(Session& session, const PhotonMap& map, unsigned k, double radius) {
  GatherParams params{};
  params.levels = map.levels;
  params.k = k;
  params.radius2 = static_cast<float>(std::min(radius * radius, double{PHOTON_FARTHEST2}));
  return {session.upload(map.nodes), session.upload(map.buckets), session.upload(&params, 1), k, {}};
}

void store_caustics(Session& session, View<Splat> points, View<std::uint8_t> receives, DevicePhotonMap& map) {
  std::vector<Photon> areas;
  std::vector<cl_float4> places;
  for (const Splat& s : points) {
    const bool lit = receives[static_cast<std::size_t>(s.material)] != 0;
    if (lit) areas.push_back(area_photon(s));
    places.push_back({{s.position[0], s.position[1], s.position[2], lit ? s.radius : 0.0f}});
    places.push_back({{s.normal[0], s.normal[1], s.normal[2], 0.0f}});
  }
  const DevicePhotonMap area_map = upload_photon_map(session, build_photon_map(areas), map.k, INFINITY);
  const Program program = caustics_of_points_program(map.k);
  cl::Kernel kernel = session.kernel(program.file, program.options, "caustics_of_points");
  const auto device_places = session.upload(places);
  map.at_points = session.allocate<cl_float4>(points.size);
  for (std::size_t first = 0; first < points.size; first += points_at_once)
    session.launch(kernel, LaunchShape::line(std::min(points_at_once, points.size - first), group), map.nodes,
                   map.buckets, map.params, area_map.nodes, area_map.buckets, area_map.params, device_places,
                   map.at_points, static_cast<cl_uint>(first), static_cast<cl_uint>(points.size));
}

} // namespace pointgi
