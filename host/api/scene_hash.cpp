#include "host/api/scene_hash.h"
#include "host/api/parts.h"
#include "host/cache/binary_cache.h"
#include "host/cl/kernel_source.h"
#include "host/lights/environment_map.h"
#include "host/passes/variant.h"
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <sstream>

namespace pointgi::api {

namespace {

/// What else the light depends on, as text: the integrator and its paths, the exchange between surfaces, photons.
std::string settings_text(const pointgi::Scene& scene, const std::string& integrator, const std::string& paths) {
  const RadiositySettings& r = scene.radiosity;
  const CausticSettings& c = scene.caustics;
  const std::string radiosity =
      fmt::format("{} {} {} {} {} {:a} {:a} {} {} {} {:a} {} {} {} {} {} {} {} {} {} {} {} {} {}", r.method, r.order,
                  r.vmap_samples, r.point_samples, r.vmap_rays.value_or(-1), r.epsilon, r.tolerance, r.vmap,
                  r.direct_light, r.light_samples.value_or(0), r.least_share, r.directions, r.direction_set, r.share,
                  r.sampling, r.window, r.reciprocity.value_or(true), r.visibility_cache.value_or(true), r.visibility,
                  r.voxels, r.passes, r.cones, r.anisotropic, r.at);
  return fmt::format("{} {} {}; {}; {} {} {} {:a} {} {}", integrator, paths,
                     name_of(scene.camera.backfaces.value_or(Backfaces::shade)), radiosity, c.photons, c.gather_k,
                     c.power, c.max_radius.value_or(0.0), c.feedback, c.indirect);
}

template <typename T>
std::string_view bytes_of(const T& list) {
  return std::string_view(reinterpret_cast<const char*>(list.data()), list.size() * sizeof(list[0]));
}

} // namespace

std::string scene_hash(const Pool<OctreePoint>& points, const DeviceLighting& lighting, const pointgi::Scene& scene,
                       const std::string& integrator, const std::string& paths) {
  std::uint64_t hash = fnv1a(bytes_of(points), fnv1a(settings_text(scene, integrator, paths)));
  hash = fnv1a(bytes_of(lighting.light_sources), hash);
  hash = fnv1a(bytes_of(lighting.materials), hash);
  if (lighting.sky != nullptr) {
    const SkyMap frame = device_sky_map(*lighting.sky);
    hash = fnv1a(std::string_view(reinterpret_cast<const char*>(&frame), sizeof frame), hash);
    hash = fnv1a(bytes_of(lighting.sky->texels), hash);
  }
  hash = fnv1a(std::string_view(reinterpret_cast<const char*>(&lighting.params), sizeof lighting.params), hash);
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

std::string checkpoint_key(const Scene& from, const Prepared& prepared, const std::string& integrator,
                           const FilmOptions* film) {
  const Prepared::Parts& parts = *prepared.parts();
  const pointgi::Scene& scene = parts.scene;
  // All settings, overrides among them: what they mean for surfaces, borders and clouds is not taken apart.
  std::ostringstream document;
  document << from.parts()->document.table;
  const PreparedScene& ready = parts.ready;
  const DeviceInfo& device = parts.context->session.info();
  const char* options = std::getenv("POINTGI_CL_OPTIONS");
  std::string key =
      fmt::format("pointgi " POINTGI_VERSION
                  ", kernels {:x} {}; {} {:x} quality {}; points {:x} {:x}; root cube {:a} {:a} {:a} {:a}; "
                  "light {:a}; {} {} {}; {} {:a} {}",
                  kernels_hash(), options != nullptr ? options : "",
                  scene_hash(ready.points, ready.lighting, scene, integrator, film != nullptr ? film->paths : ""),
                  fnv1a(document.str()), parts.quality, fnv1a(bytes_of(ready.ids)), fnv1a(bytes_of(ready.first_ids)),
                  ready.frame.side, ready.frame.origin.x(), ready.frame.origin.y(), ready.frame.origin.z(),
                  ready.lighting.radiance.scale, device.platform, device.name, device.driver,
                  name_of(ready.choice.variant), ready.choice.variant.step_delta, build_options(ready.choice.variant));
  if (film == nullptr) return key;
  const RenderSettings& render = scene.render;
  key += fmt::format("; {} x {}, {} samples of seed {}, depth {}, auxiliary {}; ", render.width, render.height,
                     render.spp, render.seed, render.max_depth.value_or(0), film->auxiliary);
  for (const int edge : film->window.value_or(std::array<int, 4>{0, render.width, 0, render.height}))
    key += fmt::format("{} ", edge);
  for (const float entry : world_to_ndc(scene))
    key += fmt::format("{:a} ", entry);
  return key;
}

} // namespace pointgi::api
