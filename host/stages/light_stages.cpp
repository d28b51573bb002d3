#include "host/stages/light_stages.h"
#include "host/photon/diffuse_photons.h"
#include "host/run.h"

namespace pointgi {

namespace {

/// Rounds end when what mirrors and glass bring to surfaces is less than this share of the light that entered first, or
/// after so many.
constexpr double least_share = 1e-3;
constexpr unsigned most_rounds = 16;

/// Light that surfaces send by mirrors and glass to surfaces (LD+S+D); with caustics.feedback they pass it on, and some
/// goes round once more.
void add_rounds(Session& session, const DevicePools& pools, const IndirectRequest& request, SceneLight& light,
                Caustics& caustics, StageLog& stages) {
  const auto reflected_power = [&](const std::vector<View<float>>& irradiances) {
    return power_of(reflected_radiosity(request, irradiances), request.points);
  };
  IndirectLight& indirect = light.indirect;
  double first = reflected_power({indirect.direct, request.caustic});
  if (direct_light_by_radiosity(request.scene))
    first += power_of(emitted_radiosity(request.lighting, request.points), request.points);
  std::vector<float> sent = reflected_radiosity(request, {indirect.direct, request.caustic, indirect.from_surfaces});
  double share = 1.0;
  for (unsigned round = 0; round < most_rounds; ++round) {
    const std::vector<float> entering =
        add_indirect_photons(session, pools, request, *light.normal_field, sent, share, round + 1, caustics, stages);
    if (!request.scene.caustics.feedback) return;
    share = first > 0.0 ? reflected_power({entering}) / first : 0.0;
    if (share < least_share) return;
    const std::vector<float> passed_on = add_exchange(session, request, entering, share, indirect, stages);
    sent = reflected_radiosity(request, {entering, passed_on});
  }
  log_warning("caustics: after {} rounds between surfaces and mirrors, {:.1f} % of the light still goes on; it is "
              "left out",
              most_rounds, 100.0 * share);
}

} // namespace

SceneLight run_light_stages(Session& session, const DevicePools& pools, const IndirectRequest& request,
                            StageLog& stages) {
  const CausticSettings& settings = request.scene.caustics;
  SceneLight light;
  Caustics caustics;
  IndirectRequest wanted = request;
  const std::optional<ShaftLight> shafts = shaft_light_of(session, pools, request, stages);
  wanted.shafts = shafts ? &*shafts : nullptr;
  const auto send_photons = [&] {
    light.normal_field = normal_field_of(session, request.lighting, request.points, request.variant.patches, stages);
    caustics = run_photon_stage(session, pools, request, light.normal_field ? &*light.normal_field : nullptr, stages);
  };
  const bool photons_first = settings.feedback && request.lighting.has_specular();
  std::vector<float> caustic;
  if (photons_first) {
    send_photons();
    caustic = irradiance_by_photons(caustics.photons, request.points);
    wanted.caustic = caustic;
  }
  light.indirect = run_indirect_stages(session, pools, wanted, stages);
  if (!settings.feedback || !settings.indirect) finish_exchange(wanted, light.indirect);
  if (!photons_first) send_photons();
  if (settings.indirect && caustics.ledger && !light.indirect.from_surfaces.empty())
    add_rounds(session, pools, wanted, light, caustics, stages);
  finish_exchange(wanted, light.indirect);
  light.direct = upload_direct(session, wanted, light.indirect);
  light.photons = upload_caustics(session, caustics, request, stages);
  light.ledger = caustics.ledger;
  return light;
}

} // namespace pointgi
