#include "host/stages/lit_cloud.h"
#include "host/image/exposure.h"
#include "host/image/srgb.h"
#include "host/run.h"
#include <algorithm>
#include <cmath>

namespace pointgi {

namespace {

constexpr double pi = 3.14159265358979323846;

void add_geometry(const Splat& s, const Frame& frame, PointCloud& cloud) {
  cloud.position.push_back(frame.to_world({s.position[0], s.position[1], s.position[2]}));
  cloud.normal.emplace_back(s.normal[0], s.normal[1], s.normal[2]);
  cloud.radius.push_back(static_cast<float>(frame.side * s.radius));
}

} // namespace

LitCloud bare_points(const IndirectRequest& scene) {
  LitCloud points;
  points.cloud.position.reserve(scene.points.size); // exactly: doubled arrays of a large scan would not fit
  points.cloud.normal.reserve(scene.points.size);
  points.cloud.radius.reserve(scene.points.size);
  for (const Splat& s : scene.points)
    add_geometry(s, scene.frame, points.cloud);
  return points;
}

LitCloud lit_cloud(const IndirectRequest& scene, const IndirectLight& light, std::optional<double> exposure) {
  LitCloud lit = bare_points(scene);
  lit.columns = {{"scalar_radiosity_r", {}}, {"scalar_radiosity_g", {}}, {"scalar_radiosity_b", {}}};
  for (PlyColumn& column : lit.columns)
    column.values.reserve(scene.points.size);
  lit.cloud.colour.reserve(scene.points.size);
  const std::vector<float> emitted = emitted_radiosity(scene.lighting, scene.points);
  ExposureMeter meter;
  for (std::size_t p = 0; p < scene.points.size; ++p) {
    const Splat& s = scene.points[p];
    const bool diffuse = exchanges_light(scene.scene.materials[static_cast<std::size_t>(s.material)]);
    std::array<float, 3> radiance{};
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t at = 3 * p + c;
      const double irradiance =
          double{light.direct[at]} + (light.from_surfaces.empty() ? 0.0 : double{light.from_surfaces[at]});
      const double radiosity =
          scene.lighting.radiance.scale * (emitted[at] + (diffuse ? s.colour[c] * irradiance : 0.0));
      lit.columns[c].values.push_back(static_cast<float>(radiosity));
      radiance[c] = static_cast<float>(radiosity / pi);
    }
    if (!exposure) meter.add(radiance, 1.0f, {s.colour[0], s.colour[1], s.colour[2]});
  }
  if (!exposure) {
    exposure = meter.stops();
    log_info("exposure chosen: {:.2f} stops (--exposure={:.2f} gives the same)", *exposure, *exposure);
  }
  const double brightness = std::exp2(*exposure) / pi;
  for (std::size_t p = 0; p < scene.points.size; ++p) {
    Eigen::Vector3f& colour = lit.cloud.colour.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) {
      const double shown = std::clamp(brightness * static_cast<double>(lit.columns[c].values[p]), 0.0, 1.0);
      colour[static_cast<Eigen::Index>(c)] = linear_to_srgb(static_cast<float>(shown));
    }
  }
  return lit;
}

} // namespace pointgi
