#include "host/view/default_light.h"
#include "host/lights/environment_map.h"
#include "host/lights/sky_model.h"
#include "host/view/ground.h"
#include "host/view/lamps.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace pointgi {

namespace {

constexpr double pi = 3.14159265358979323846, degree = pi / 180.0;
constexpr double sun_elevation_deg = 50.0;
constexpr double soft_sun_deg = 8.0; // across: its shadows are soft within an object's own size
const Vector3d warm(1.04, 1.0, 0.93), cool(0.97, 1.0, 1.05);

/// Mean reflectance, by area.
double mean_albedo(const PointCloud& cloud) {
  double sum = 0.0, area = 0.0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    sum += cloud.area[i] * Vector3d(0.2126, 0.7152, 0.0722).dot(cloud.colour[i].cast<double>());
    area += cloud.area[i];
  }
  return sum / area;
}

/// From where the light comes: over the viewer's left shoulder.
Vector3d towards_light(const Scene& scene, const Vector3d& up, double elevation_deg) {
  const Vector3d back = scene.camera.position - scene.camera.look_at, flat = back - back.dot(up) * up;
  const Vector3d ahead = flat.norm() > 1e-6 * back.norm() ? Vector3d(flat.normalized()) : Vector3d(up.unitOrthogonal());
  const Vector3d left = ahead.cross(up);
  const Vector3d side = std::cos(50.0 * degree) * ahead + std::sin(50.0 * degree) * left;
  return std::cos(elevation_deg * degree) * side + std::sin(elevation_deg * degree) * up;
}

LightSettings sun_light(const Vector3d& towards, const Vector3d& strength, double diameter_deg) {
  LightSettings sun;
  sun.type = LightType::sun;
  sun.is_far = true;
  sun.vector = towards;
  sun.strength = strength;
  sun.sine2 = std::pow(std::sin(0.5 * diameter_deg * degree), 2);
  return sun;
}

/// A level surface receives pi in all: `sky` of it from an even sky, the rest from a soft sun. A ground whose albedo is
/// sky's share of that light is as bright as the sky behind it.
Vector3d light_studio(Scene& scene, const Vector3d& up, double sky_share) {
  const Vector3d sky = sky_share * cool, sun = (1.0 - sky_share) * warm;
  scene.lights = {sun_light(towards_light(scene, up, sun_elevation_deg),
                            pi / std::sin(sun_elevation_deg * degree) * sun, soft_sun_deg)};
  scene.environment = sky;
  return sky.cwiseQuotient(sky + sun);
}

/// A clear day, as bright as the studio.
void light_outdoors(Scene& scene, const Vector3d& up) {
  constexpr double clear_air = 3.0, grass = 0.2;
  constexpr int height = 256;
  const Vector3d towards = towards_light(scene, up, sun_elevation_deg);
  const Vector3d forward = (towards - towards.dot(up) * up).normalized();
  const SkyFrame frame{forward.cross(up), forward, up};
  SkyModel model = make_sky_model(frame, 0.0, sun_elevation_deg, clear_air, grass);
  const Vector3d all = model.sky_irradiance + model.sun_irradiance * model.sun_cosine;
  const double scale = pi / all.y();
  model.ground_radiance = 0.5 / scale * cool; // what is behind the land when one looks down at it
  scene.lights = {sun_light(model.towards_sun, scale * model.sun_irradiance, 2.0)};
  scene.sky = std::make_shared<const EnvironmentMap>(
      make_environment_map(sky_image(model, frame, 2 * height, height), frame, scale, "sky"));
}

bool stands_free(const ChosenView& view) {
  return view.kind == CloudKind::model || view.kind == CloudKind::foliage;
}

} // namespace

void add_ground(Scene& scene, WorldSplats& splats, const ChosenView& view, const Vector3d& albedo) {
  MaterialSettings material;
  material.name = "ground";
  material.flags = MATERIAL_REFLECTS_DIFFUSELY;
  material.albedo = albedo;
  const ViewPoints points = view_points(splats.cloud, 0.002);
  PointCloud ground = ground_under(points, view.up);
  CloudSettings entry; // in memory, so that messages can name it
  entry.file = "the ground";
  entry.material = material.name;
  scene.materials.push_back(material);
  append_cloud(splats, std::move(ground), scene.materials.back(),
               static_cast<std::uint32_t>(scene.materials.size() - 1));
  scene.clouds.push_back(std::move(entry));
}

std::vector<std::string> choose_lights(Scene& scene, WorldSplats& splats, const ChosenView& view) {
  if (view.is_closed_room) {
    const std::size_t lamps = light_room(scene, splats, view);
    return {fmt::format("light chosen: {} lamp{} inside the room", lamps, lamps == 1 ? "" : "s")};
  }
  if (view.kind == CloudKind::terrain || view.kind == CloudKind::map || view.kind == CloudKind::station) {
    light_outdoors(scene, view.up);
    return {"light chosen: sun and clear sky"};
  }
  const double albedo = mean_albedo(splats.cloud);
  const Vector3d as_bright = light_studio(scene, view.up, std::clamp(0.3 + 0.38 * albedo, 0.35, 0.6));
  const bool grounded = scene.ground && stands_free(view) && !view.is_open && scene.shapes.empty() &&
                        !has_ground(view_points(splats.cloud, 0.005), view.up);
  if (grounded) add_ground(scene, splats, view, as_bright);
  return {std::string("light chosen: a soft sun over the left shoulder and an even sky") +
          (grounded ? ", with a ground plane (--ground none leaves it out)" : "")};
}

} // namespace pointgi
