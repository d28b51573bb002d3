#pragma once
/// The photon stage: photons from the lights by way of specular surfaces to diffuse ones (method.md §5).
#include "host/photon/device_flight.h"
#include "host/photon/device_photon_map.h"
#include "host/scene/lighting.h"
#include <functional>

namespace pointgi {

/// What became of the photons that set out from a specular leaf. Powers [W over the cube's side squared, scaled], in
/// double; emitted = stored + absorbed + escaped + cut but for rounding. On Phong surfaces chance decides between their
/// two parts, and what it gives to one photon for the others' sake is taken off `absorbed`.
struct PhotonLedger {
  std::uint64_t aimed = 0; ///< photons traced, those that flew past their leaf among them
  std::uint64_t emitted = 0, stored = 0, absorbed = 0, escaped = 0, cut = 0;
  std::uint64_t kept = 0; ///< of those that are stored
  std::array<double, 3> emitted_power{}, stored_power{}, absorbed_power{}, escaped_power{}, cut_power{};
  double device_seconds = 0.0;
};

/// Enters those of one ledger in another.
void add(const PhotonLedger& ledger, PhotonLedger& to);

struct TracedPhotons {
  std::vector<Photon> stored; ///< in the order of their numbers
  std::uint64_t one_of = 1;   ///< of so many stored photons one is kept, with so many times its power
  PhotonLedger ledger;        ///< of all of them
  bool stopped = false;
};

/// As many photons as are kept, 1 GiB.
constexpr std::size_t most_stored_photons = std::size_t{1} << 25;

/// Photons of a launch, at most: 16 MiB of flights.
constexpr std::size_t most_photon_flights = std::size_t{1} << 18;

/// How a flight is watched, and bounded.
struct FlightControl {
  std::function<bool()> stop;                    ///< asked between launches
  std::function<void(double)> progress;          ///< share of the photons, after every launch; may be empty
  std::size_t most_stored = most_stored_photons; ///< at least 1; where more are stored, one of 2, 4, ... is kept
};

/// The same photons, and of too many the same ones kept, however they are cut into launches. Throws Error(device).
TracedPhotons trace_photons(Session& session, const DevicePools& pools, const PhotonRequest& request,
                            const FlightControl& control);

/// The lights of the scene as sources. `points`: of the pool.
PhotonSources photon_sources(const DeviceLighting& lighting, View<Splat> points);

/// Why no light of a scene flies by way of specular splats; empty where it does.
std::string reason_against_photons(const DeviceLighting& lighting, const CausticSettings& settings);

/// What photons are aimed at, and how many at each.
struct AimedPhotons {
  SpecularLeaves leaves;
  EmissionPlan plan;
  PhotonStart start = PhotonStart::aimed;
};

/// As send_photons has them.
AimedPhotons aim_photons(Session& session, const DevicePools& pools, const TraversalVariant& variant,
                         const DeviceLighting& lighting, const PhotonSources& sources, View<Splat> points,
                         const CausticSettings& settings, double side);

/// Slopes of the normals of the specular splats among `points`, as kernels of specular surfaces take them.
std::vector<cl_float4> normal_field_texels(const DeviceLighting& lighting, View<Splat> points);

/// Leaves, plan and flight: the photons of `sources` by way of the specular splats among `points`, the pool's.
/// `photons`, `power`: of `settings`. Throws as trace_photons.
TracedPhotons send_photons(Session& session, const DevicePools& pools, const TraversalVariant& variant,
                           const DeviceLighting& lighting, const PhotonSources& sources, View<Splat> points,
                           const Buffer<cl_float4>& normal_field, const CausticSettings& settings, double side,
                           const FlightControl& control);

/// `photons` of those by which the specular splats among `points` receive the light of diffuse ones, of radiosity
/// [points x 3, W/m², scaled]: LD+S+D. `flight`: as of PhotonRequest. Throws as trace_photons.
TracedPhotons send_photons_from_surfaces(Session& session, const DevicePools& pools, const TraversalVariant& variant,
                                         const DeviceLighting& lighting, View<float> radiosity, View<Splat> points,
                                         const Buffer<cl_float4>& normal_field, std::uint32_t photons,
                                         std::uint32_t flight, double side, const FlightControl& control);

/// Irradiance [n float4, W/m², scaled] by the map of places on surfaces, [2 n]: position, unit normal of the lit side.
std::vector<cl_float4> caustic_irradiance(Session& session, const DevicePhotonMap& map,
                                          const std::vector<cl_float4>& places);

} // namespace pointgi
