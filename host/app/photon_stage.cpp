#include "host/app/photon_stage.h"
#include "host/error.h"
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
  stages.start("photon");
  TracedPhotons traced =
      send_photons(session, pools, request.variant, request.lighting, photon_sources(request.lighting, request.points),
                   request.points, *normal_field, settings, request.frame.side, request.stop);
  if (traced.stopped) throw Error(ExitCode::interrupted, "interrupted in the stage photon; nothing was written");
  caustics.ledger = traced.ledger;
  if (!traced.stored.empty()) {
    const double radius = settings.max_radius ? *settings.max_radius / request.frame.side : default_radius;
    caustics.map =
        upload_photon_map(session, build_photon_map(traced.stored), static_cast<unsigned>(settings.gather_k), radius);
  }
  stages.finish(traced.ledger.aimed, "photons", traced.ledger.device_seconds);
  spdlog::info("caustics: {} photons set out from specular splats: {} stored, {} absorbed, {} escaped, {} cut off",
               traced.ledger.emitted, traced.ledger.stored, traced.ledger.absorbed, traced.ledger.escaped,
               traced.ledger.cut);
  return caustics;
}

} // namespace pointgi
