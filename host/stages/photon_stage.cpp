#include "host/stages/photon_stage.h"
#include "host/error.h"
#include "host/photon/diffuse_photons.h"
#include "host/run.h"
#include "host/stages/kept_light.h"
#include <algorithm>
#include <cmath>

namespace pointgi {

namespace {

/// Photons farther off than this share of the scene's cube do not count, where [caustics] does not say how far: what is
/// lit so little that k photons lie farther apart gets a mean over that disc.
constexpr double default_radius = 0.05;

/// Empty when photons are sent.
std::string reason_against(const IndirectRequest& request) {
  if (request.by_paths && request.lighting.has_specular()) return "the path tracer makes the picture";
  return reason_against_photons(request.lighting, request.scene.caustics);
}

/// Photons that a flight may add to those that are there: where others may follow, half of what memory is left for.
std::size_t room_for(const IndirectRequest& request, const Caustics& caustics) {
  const bool others = request.scene.caustics.indirect && reason_against_radiosity(request).empty();
  return (most_stored_photons - caustics.photons.size()) / (others ? 2 : 1);
}

/// The stage itself: `send` sends photons and is watched by what it is given.
template <typename Send>
void fly(const IndirectRequest& request, Caustics& caustics, StageLog& stages, const Send& send) {
  stages.start("photon");
  const std::size_t room = room_for(request, caustics);
  TracedPhotons traced = kept_or_made<TracedPhotons>("photon", [&] {
    TracedPhotons made = send(FlightControl{stop_asked, [](double share) { report_progress(share); }, room});
    if (made.stopped) throw interruption();
    return made;
  });
  const PhotonLedger& ledger = traced.ledger;
  stages.finish(ledger.aimed, "photons", ledger.device_seconds);
  log_info("caustics: {} photons set out from specular splats: {} stored, {} absorbed, {} escaped, {} cut off",
           ledger.emitted, ledger.stored, ledger.absorbed, ledger.escaped, ledger.cut);
  if (traced.one_of > 1)
    log_warning("caustics: memory is kept for {} stored photons: one of {} stays, {} times as bright; "
                "caustics.photons = {} would keep all",
                room, traced.one_of, traced.one_of,
                request.scene.caustics.photons / static_cast<long long>(traced.one_of));
  if (caustics.photons.empty())
    caustics.photons = std::move(traced.stored);
  else
    caustics.photons.insert(caustics.photons.end(), traced.stored.begin(), traced.stored.end());
  if (!caustics.ledger) caustics.ledger.emplace();
  add(ledger, *caustics.ledger);
}

/// Photons of a pilot flight from surfaces, and the least that follow, over those that the scene asks for.
constexpr double pilot_share = 1.0 / 64.0, least_from_surfaces = 1.0 / 16.0;
constexpr double least_pilot = 1000.0; ///< photons

double sum_of(const std::array<double, 3>& power) {
  return power[0] + power[1] + power[2];
}

/// How many from surfaces make stored photons about as strong as those that are there: the noise of the sum is least
/// for its photons then. A pilot flight tells what surfaces send; without one, as many as the scene asks for.
double photons_from_surfaces(const Caustics& caustics, double all,
                             const std::function<PhotonLedger(std::uint32_t)>& fly_pilot) {
  const double pilot = std::floor(pilot_share * all);
  if (pilot < least_pilot || !caustics.ledger || caustics.ledger->stored == 0) return all;
  const PhotonLedger found = fly_pilot(static_cast<std::uint32_t>(pilot));
  if (found.stored == 0) return all;
  const double strong = sum_of(caustics.ledger->stored_power) / static_cast<double>(caustics.ledger->stored);
  const double to_store = sum_of(found.stored_power) / strong;
  return std::clamp(to_store * pilot / static_cast<double>(found.stored), least_from_surfaces * all, all);
}

} // namespace

Caustics run_photon_stage(Session& session, const DevicePools& pools, const IndirectRequest& request,
                          const Buffer<cl_float4>* normal_field, StageLog& stages) {
  Caustics caustics;
  const CausticSettings& settings = request.scene.caustics;
  const std::string reason = reason_against(request);
  if (!reason.empty()) {
    if (settings.place && settings.photons > 0)
      log_warning("{}: [caustics] has no effect: {}", settings.place->text(), reason);
    stages.skip("photon", reason);
    return caustics;
  }
  if (const std::string exchange = reason_against_radiosity(request);
      settings.place && !exchange.empty() && (settings.feedback || settings.indirect))
    log_warning("{}: [caustics] feedback and indirect have no effect: {}", settings.place->text(), exchange);
  fly(request, caustics, stages, [&](const FlightControl& control) {
    return send_photons(session, pools, request.variant, request.lighting,
                        photon_sources(request.lighting, request.points), request.points, *normal_field, settings,
                        request.frame.side, control);
  });
  return caustics;
}

std::vector<float> add_indirect_photons(Session& session, const DevicePools& pools, const IndirectRequest& request,
                                        const Buffer<cl_float4>& normal_field, View<float> radiosity, double share,
                                        std::uint32_t flight, Caustics& caustics, StageLog& stages) {
  const std::size_t before = caustics.photons.size();
  const auto send = [&](std::uint32_t photons, const FlightControl& control) {
    return send_photons_from_surfaces(session, pools, request.variant, request.lighting, radiosity, request.points,
                                      normal_field, photons, flight, request.frame.side, control);
  };
  if (caustics.from_surfaces == 0.0)
    caustics.from_surfaces = photons_from_surfaces(caustics, static_cast<double>(request.scene.caustics.photons),
                                                   [&](std::uint32_t photons) {
                                                     return send(photons, {stop_asked, {}, most_stored_photons}).ledger;
                                                   });
  const auto photons = static_cast<std::uint32_t>(std::llround(std::min(share, 1.0) * caustics.from_surfaces));
  fly(request, caustics, stages, [&](const FlightControl& control) { return send(photons, control); });
  return irradiance_by_photons({caustics.photons.data() + before, caustics.photons.size() - before}, request.points);
}

std::optional<DevicePhotonMap> upload_caustics(Session& session, const Caustics& caustics,
                                               const IndirectRequest& request, StageLog& stages) {
  if (caustics.photons.empty()) return std::nullopt;
  stages.start("photon");
  const CausticSettings& settings = request.scene.caustics;
  const double radius = settings.max_radius ? *settings.max_radius / request.frame.side : default_radius;
  DevicePhotonMap map =
      upload_photon_map(session, build_photon_map(caustics.photons), static_cast<unsigned>(settings.gather_k), radius);
  const bool whole = store_caustics(session, request.points, exchanging_materials(request.scene), map,
                                    {stop_asked, [](double share) { report_progress(share); }});
  if (!whole) throw interruption();
  stages.finish(request.points.size, "points");
  return map;
}

} // namespace pointgi
