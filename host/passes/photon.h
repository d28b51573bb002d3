#pragma once
/// The photon stage: photons from the lights by way of specular surfaces to diffuse ones (method.md §5).
#include "host/passes/device_pools.h"
#include "host/passes/photon_map.h"
#include "host/photon/emission_plan.h"
#include "host/scene/lighting.h"
#include <functional>

namespace pointgi {

/// What became of the photons that set out from a specular leaf. Powers [W over the cube's side squared, scaled], in
/// double; emitted = stored + absorbed + escaped + cut but for rounding. On Phong surfaces chance decides between their
/// two parts, and what it gives to one photon for the others' sake is taken off `absorbed`.
struct PhotonLedger {
  std::uint64_t aimed = 0; ///< photons traced, those that flew past their leaf among them
  std::uint64_t emitted = 0, stored = 0, absorbed = 0, escaped = 0, cut = 0;
  std::array<double, 3> emitted_power{}, stored_power{}, absorbed_power{}, escaped_power{}, cut_power{};
  double device_seconds = 0.0;
};

/// Enters those of one ledger in another.
void add(const PhotonLedger& ledger, PhotonLedger& to);

struct TracedPhotons {
  std::vector<Photon> stored; ///< in the order of their numbers
  PhotonLedger ledger;
  bool stopped = false;
};

/// As many photons as may be stored, 1 GiB: what is more is refused, for dropping some would darken the picture.
constexpr std::size_t most_stored_photons = std::size_t{1} << 25;

struct PhotonRequest {
  const DeviceLighting& lighting; ///< materials, seed, most bounces
  const PhotonSources& sources;
  const SpecularLeaves& leaves;
  const EmissionPlan& plan;
  const Buffer<cl_float4>& normal_field;
  TraversalVariant variant;
  double side = 1.0; ///< of the root cube, world units
  bool equal_power = false;
  std::size_t batch = 0;                         ///< photons a launch; 0: found by the launches' times
  std::size_t most_stored = most_stored_photons; ///< photons
};

/// Throws Error(device), or Error(memory) when too many photons are stored. `stop` is asked between launches.
TracedPhotons trace_photons(Session& session, const DevicePools& pools, const PhotonRequest& request,
                            const std::function<bool()>& stop);

/// The lights of the scene as sources. `points`: of the pool.
PhotonSources photon_sources(const DeviceLighting& lighting, View<Splat> points);

/// Leaves, plan and flight: the photons of `sources` by way of the specular splats among `points`, the pool's.
/// `photons`, `power`: of `settings`. Throws as trace_photons.
TracedPhotons send_photons(Session& session, const DevicePools& pools, const TraversalVariant& variant,
                           const DeviceLighting& lighting, const PhotonSources& sources, View<Splat> points,
                           const Buffer<cl_float4>& normal_field, const CausticSettings& settings, double side,
                           const std::function<bool()>& stop);

/// Irradiance [n float4, W/m², scaled] by the map of places on surfaces, [2 n]: position, unit normal of the lit side.
std::vector<cl_float4> caustic_irradiance(Session& session, const DevicePhotonMap& map,
                                          const std::vector<cl_float4>& places);

} // namespace pointgi
