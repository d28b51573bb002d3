#include "host/passes/device_lights.h"
#include "host/lights/environment_map.h"

namespace pointgi {

std::vector<cl::Memory> DeviceLights::arguments() const {
  std::vector<cl::Memory> all{params.handle, materials.handle, light_sources.handle, emitters.handle};
  if (sky) all.insert(all.end(), {sky->map.handle, sky->rows.handle, sky->columns.handle, sky->texels.handle});
  return all;
}

DeviceLights upload_lights(Session& session, const DeviceLighting& lighting, const RenderParams& params,
                           bool with_map) {
  DeviceLights lights{session.upload(&params, 1),
                      session.upload(lighting.materials),
                      session.upload(lighting.light_sources),
                      session.upload(lighting.emitters),
                      {}};
  if (with_map && lighting.sky != nullptr) {
    const EnvironmentMap& map = *lighting.sky;
    const SkyMap frame = device_sky_map(map);
    lights.sky = DeviceSky{session.upload(&frame, 1), session.upload(map.rows), session.upload(map.columns),
                           session.upload(device_texels(map, lighting.radiance.scale))};
  }
  return lights;
}

} // namespace pointgi
