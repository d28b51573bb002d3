#include "host/scene/lighting.h"
#include "host/lights/environment_map.h"
#include "host/lights/smooth_sky.h"
#include "host/scene/shares.h"
#include <Eigen/Geometry>
#include <cmath>

namespace pointgi {

namespace {

void copy3(const Vector3d& from, float to[3]) {
  for (int k = 0; k < 3; ++k)
    to[k] = static_cast<float>(from[k]);
}

/// As the device has it, not yet scaled: of a light in the scene W/sr per side², so that irradiance is this over the
/// distance in cubes squared.
Vector3d cube_strength(const LightSettings& light, const Frame& frame) {
  return light.is_far ? light.strength : light.strength / frame.side / frame.side;
}

RadianceScale choose_scale(const Scene& scene, const Frame& frame) {
  double largest = scene.environment.maxCoeff();
  if (scene.sky != nullptr) largest = std::max(largest, largest_radiance(*scene.sky));
  for (const MaterialSettings& material : scene.materials)
    largest = std::max(largest, material.emission.maxCoeff());
  for (const LightSettings& light : scene.lights)
    largest = std::max(largest, cube_strength(light, frame).maxCoeff());
  return {largest > 0.0 ? std::exp2(std::round(std::log2(largest))) : 1.0};
}

LightSource device_light(const LightSettings& settings, const Frame& frame, double scale) {
  LightSource light{};
  light.type = static_cast<pg_uint>(settings.type);
  copy3(settings.is_far ? settings.vector : (settings.vector - frame.origin) / frame.side, light.vector);
  copy3(cube_strength(settings, frame) / scale, light.strength);
  light.sine2 = static_cast<float>(settings.sine2);
  return light;
}

struct Axes {
  Vector3d right, up, forward;
};

Material device_material(const MaterialSettings& settings, const Frame& frame, double scale) {
  Material material{};
  copy3(settings.emission / scale, material.emission);
  material.type = static_cast<pg_uint>(settings.type);
  copy3(settings.specular, material.specular);
  material.exponent = static_cast<float>(settings.exponent);
  copy3(settings.absorption * frame.side, material.absorption);
  material.ior = static_cast<float>(settings.ior);
  copy3(settings.eta, material.eta);
  material.alpha = static_cast<float>(settings.alpha);
  copy3(settings.extinction, material.extinction);
  material.flags = settings.flags;
  return material;
}

Axes camera_axes(const Scene& scene) {
  const Vector3d forward = (scene.camera.look_at - scene.camera.position).normalized();
  const Vector3d right = forward.cross(up_of(scene)).normalized();
  return {right, right.cross(forward), forward};
}

std::array<float, 16> flat(const Eigen::Matrix4d& column_form) {
  std::array<float, 16> m{};
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c)
      m[static_cast<std::size_t>(4 * c + r)] = static_cast<float>(column_form(r, c)); // transposed: row vectors
  return m;
}

Eigen::Matrix4d camera_matrix(const Scene& scene) {
  const Axes axes = camera_axes(scene);
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.block<1, 3>(0, 0) = axes.right.transpose();
  m.block<1, 3>(1, 0) = axes.up.transpose();
  m.block<1, 3>(2, 0) = -axes.forward.transpose();
  m.block<3, 1>(0, 3) = -m.block<3, 3>(0, 0) * scene.camera.position;
  return m;
}

/// Half the image plane's width and height at distance 1.
struct HalfPlane {
  double x, y;
};

HalfPlane half_plane(const Scene& scene) {
  const double y = std::tan(scene.camera.fov_deg * 3.14159265358979323846 / 360.0);
  return {y * scene.render.width / scene.render.height, y};
}

} // namespace

Vector3d up_of(const Scene& scene) {
  return scene.camera.up.value_or(direction_of(scene.up));
}

Camera device_camera(const Scene& scene, const Frame& frame) {
  const Axes axes = camera_axes(scene);
  const HalfPlane half = half_plane(scene);
  Camera camera{};
  copy3((scene.camera.position - frame.origin) / frame.side, camera.origin);
  copy3(axes.forward - half.x * axes.right + half.y * axes.up, camera.corner);
  copy3(axes.right * (2.0 * half.x / scene.render.width), camera.step_x);
  copy3(-axes.up * (2.0 * half.y / scene.render.height), camera.step_y);
  return camera;
}

std::array<float, 16> world_to_camera(const Scene& scene) {
  return flat(camera_matrix(scene));
}

std::array<float, 16> world_to_ndc(const Scene& scene) {
  const HalfPlane half = half_plane(scene);
  Eigen::Matrix4d projection = Eigen::Matrix4d::Zero();
  projection(0, 0) = 0.5 / half.x;
  projection(0, 2) = -0.5;
  projection(1, 1) = 0.5 / half.y;
  projection(1, 2) = -0.5;
  projection(2, 2) = -1.0;
  projection(3, 2) = -1.0;
  return flat(projection * camera_matrix(scene));
}

namespace {

/// Where rays by the cosine look for emitting splats besides the samples on them (kernels/lights/emitter.cl): nearer
/// than this the density of samples is below 1 / pi per solid angle, were it even over their area. One box for all of
/// them.
void set_reach(View<Splat> points, DeviceLighting& lighting) {
  RenderParams& params = lighting.params;
  if (lighting.emitters.empty()) return;
  Eigen::AlignedBox3f box;
  double area = 0.0;
  for (const Emitter& e : lighting.emitters) {
    const Splat& s = points[e.point];
    const Eigen::Vector3f centre(s.position[0], s.position[1], s.position[2]);
    box.extend(Eigen::Vector3f(centre.array() - s.radius));
    box.extend(Eigen::Vector3f(centre.array() + s.radius));
    area += s.area;
  }
  params.emitter_reach = static_cast<float>(std::sqrt(area / 3.14159265358979323846));
  std::copy_n(box.min().data(), 3, params.emitter_low);
  std::copy_n(box.max().data(), 3, params.emitter_high);
}

} // namespace

DeviceLighting device_lighting(const Scene& scene, const Frame& frame, View<Splat> points, const SplatClips& clips) {
  DeviceLighting result;
  result.radiance = choose_scale(scene, frame);
  const double scale = result.radiance.scale;
  std::vector<double> power(scene.materials.size()); // luminance of each material's emission
  const Vector3d luminance(0.2126, 0.7152, 0.0722);
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    result.materials.push_back(device_material(scene.materials[m], frame, scale));
    power[m] = luminance.dot(scene.materials[m].emission) / scale;
  }
  const auto emitted = [&](std::size_t p) {
    return power[static_cast<std::size_t>(points[p].material)] * points[p].area;
  };
  for (std::size_t p = 0; p < points.size; ++p) {
    const Material& material = result.materials[static_cast<std::size_t>(points[p].material)];
    result.material_types |= 1u << material.type;
    result.flags |= material.flags;
  }
  for (std::size_t p = 0; p < points.size; ++p)
    if (emitted(p) > 0.0) result.emitters.push_back({static_cast<std::uint32_t>(p), 0.0f, {}});
  accumulate_shares(result.emitters, [&](const Emitter& e) { return emitted(e.point); });
  const std::vector<std::uint32_t> clip_of = clip_of_each(clips, points.size);
  for (Emitter& e : result.emitters)
    if (!clip_of.empty() && clip_of[e.point] != no_clip) e.clip = clips[clip_of[e.point]].clip;
  double all_emitted = 0.0;
  for (const Emitter& e : result.emitters)
    all_emitted += emitted(e.point);
  for (std::size_t m = 0; m < scene.materials.size() && all_emitted > 0.0; ++m)
    result.materials[m].emitter_density = static_cast<float>(power[m] / all_emitted);
  set_reach(points, result);
  for (const LightSettings& entry : scene.lights) {
    const LightSource light = device_light(entry, frame, scale);
    if (!(light.strength[0] + light.strength[1] + light.strength[2] > 0.0f)) continue;
    result.light_sources.push_back(light);
    result.light_types |= 1u << light.type;
  }
  accumulate_shares(result.light_sources, [&](const LightSource& l) {
    return luminance.dot(Vector3d(l.strength[0], l.strength[1], l.strength[2])) + 1e-30;
  });
  RenderParams& params = result.params;
  params.camera = device_camera(scene, frame);
  result.sky = scene.sky;
  if (scene.sky != nullptr && is_smooth(*scene.sky)) result.smooth_sky = smooth_sky(*scene.sky, scale);
  copy3((scene.sky != nullptr ? mean_radiance(*scene.sky) : scene.environment) / scale, params.environment);
  params.samples = static_cast<pg_uint>(scene.render.spp);
  params.seed = scene.render.seed;
  params.jitter = scene.render.jitter ? 1u : 0u;
  params.adaptive = scene.render.adaptive ? 1u : 0u;
  params.most_bounces = scene.render.max_depth ? static_cast<pg_uint>(*scene.render.max_depth) : NO_BOUNCE_LIMIT;
  params.light_sources = static_cast<pg_uint>(result.light_sources.size());
  params.emitters = static_cast<pg_uint>(result.emitters.size());
  result.has_environment = scene.sky != nullptr || scene.environment.maxCoeff() > 0.0;
  return result;
}

} // namespace pointgi
