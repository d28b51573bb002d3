#include "host/app/light_stages.h"
#include "host/photon/diffuse_photons.h"

namespace pointgi {

SceneLight run_light_stages(Session& session, const DevicePools& pools, const IndirectRequest& request,
                            StageLog& stages) {
  const CausticSettings& settings = request.scene.caustics;
  SceneLight light;
  Caustics caustics;
  IndirectRequest wanted = request;
  const auto send_photons = [&] {
    light.normal_field = normal_field_of(session, request.lighting, request.points, stages);
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
  if (!photons_first) send_photons();
  if (settings.indirect && caustics.ledger && !light.indirect.from_surfaces.empty())
    add_indirect_caustics(session, pools, wanted, *light.normal_field, light.indirect, caustics, stages);
  light.photons = upload_caustics(session, caustics, request);
  light.ledger = caustics.ledger;
  return light;
}

} // namespace pointgi
