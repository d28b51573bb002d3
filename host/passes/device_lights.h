#pragma once
/// The lights on the device, as every kernel that asks them takes them.
#include "host/cl/session.h"
#include "host/scene/lighting.h"
#include "shared/sky_types.h"

namespace pointgi {

/// A map of light from all around.
struct DeviceSky {
  Buffer<SkyMap> map;
  Buffer<SkyRow> rows;
  Buffer<float> columns;
  Buffer<SkyTexel> texels;
};

struct DeviceLights {
  Buffer<RenderParams> params;
  Buffer<Material> materials;
  Buffer<LightSource> light_sources;
  Buffer<Emitter> emitters;
  std::optional<DeviceSky> sky; ///< for programs that are built with HAS_SKY_MAP

  /// LIGHT_PARAMS of kernels/lights/light_sample.cl, in its order.
  std::vector<cl::Memory> arguments() const;
};

/// `params` instead of lighting.params. Without `with_map` the lighting's map stays behind.
DeviceLights upload_lights(Session& session, const DeviceLighting& lighting, const RenderParams& params, bool with_map);

} // namespace pointgi
