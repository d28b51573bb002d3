#include "host/app/photon_stage.h"
#include "host/app/progress.h"
#include "host/error.h"
#include "host/photon/diffuse_photons.h"
#include <spdlog/spdlog.h>

namespace pointgi {

namespace {

/// Photons farther off than this share of the scene's cube do not count, where [caustics] does not say how far: what is
/// lit so little that k photons lie farther apart gets a plain mean over that disc.
constexpr double default_radius = 0.05;

/// Empty when photons are sent.
std::string reason_against(const IndirectRequest& request, bool specular) {
  if (!specular) return "no specular material";
  if (request.by_paths) return "the path tracer makes the picture";
  if (!request.lighting.has_light()) return "the scene has no light and no emission";
  if (request.scene.caustics.photons == 0) return "caustics.photons = 0";
  return {};
}

/// How many times photons fly whose memory is one.
std::size_t flights_of(const IndirectRequest& request) {
  return request.scene.caustics.indirect && reason_against_radiosity(request).empty() ? 2 : 1;
}

/// The stage itself, from these sources.
void fly(Session& session, const DevicePools& pools, const IndirectRequest& request,
         const Buffer<cl_float4>& normal_field, const PhotonSources& sources, Caustics& caustics, StageLog& stages) {
  stages.start("photon");
  TracedPhotons traced = [&] {
    Progress progress("photon", request.quiet);
    const FlightControl control{request.stop, [&](double share) { progress.update(share); },
                                most_stored_photons / flights_of(request)};
    return send_photons(session, pools, request.variant, request.lighting, sources, request.points, normal_field,
                        request.scene.caustics, request.frame.side, control);
  }();
  if (traced.stopped) throw Error(ExitCode::interrupted, "interrupted in the stage photon; nothing was written");
  const PhotonLedger& ledger = traced.ledger;
  stages.finish(ledger.aimed, "photons", ledger.device_seconds);
  spdlog::info("caustics: {} photons set out from specular splats: {} stored, {} absorbed, {} escaped, {} cut off",
               ledger.emitted, ledger.stored, ledger.absorbed, ledger.escaped, ledger.cut);
  if (traced.one_of > 1)
    spdlog::warn("caustics: memory is kept for {} stored photons: one of {} stays, {} times as bright; "
                 "caustics.photons = {} would keep all",
                 most_stored_photons / flights_of(request), traced.one_of, traced.one_of,
                 request.scene.caustics.photons / static_cast<long long>(traced.one_of));
  if (caustics.photons.empty())
    caustics.photons = std::move(traced.stored);
  else
    caustics.photons.insert(caustics.photons.end(), traced.stored.begin(), traced.stored.end());
  if (!caustics.ledger) caustics.ledger.emplace();
  add(ledger, *caustics.ledger);
}

} // namespace

Caustics run_photon_stage(Session& session, const DevicePools& pools, const IndirectRequest& request,
                          const Buffer<cl_float4>* normal_field, StageLog& stages) {
  Caustics caustics;
  const CausticSettings& settings = request.scene.caustics;
  const std::string reason = reason_against(request, normal_field != nullptr);
  if (!reason.empty()) {
    if (settings.place && settings.photons > 0)
      spdlog::warn("{}: [caustics] has no effect: {}", settings.place->text(), reason);
    stages.skip("photon", reason);
    return caustics;
  }
  if (const std::string exchange = reason_against_radiosity(request);
      settings.place && !exchange.empty() && (settings.feedback || settings.indirect))
    spdlog::warn("{}: [caustics] feedback and indirect have no effect: {}", settings.place->text(), exchange);
  fly(session, pools, request, *normal_field, photon_sources(request.lighting, request.points), caustics, stages);
  return caustics;
}

void add_indirect_caustics(Session& session, const DevicePools& pools, const IndirectRequest& request,
                           const Buffer<cl_float4>& normal_field, const IndirectLight& light, Caustics& caustics,
                           StageLog& stages) {
  fly(session, pools, request, normal_field, sources_of_radiosity(reflected_radiosity(request, light), request.points),
      caustics, stages);
}

std::optional<DevicePhotonMap> upload_caustics(Session& session, const Caustics& caustics,
                                               const IndirectRequest& request) {
  if (caustics.photons.empty()) return std::nullopt;
  const CausticSettings& settings = request.scene.caustics;
  const double radius = settings.max_radius ? *settings.max_radius / request.frame.side : default_radius;
  return upload_photon_map(session, build_photon_map(caustics.photons), static_cast<unsigned>(settings.gather_k),
                           radius);
}

} // namespace pointgi
