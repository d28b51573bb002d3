#include "host/scene/splats.h"
#include "host/cloud/mls_patches.h"
#include "host/cloud/readers/readers.h"
#include "host/error.h"
#include "host/image/srgb.h"
#include "host/scene/field_albedo.h"
#include "host/scene/sample_shape.h"
#include "octree/parallel.h"
#include "shared/traversal_types.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>

namespace pointgi {

namespace {

/// What a cloud without colours and a material without albedo look like: a light grey, as plaster is.
constexpr double default_albedo = 0.75;
constexpr std::size_t grain = 1 << 14;

std::uint32_t index_of(const Scene& scene, const std::string& name) {
  const auto at = std::find_if(scene.materials.begin(), scene.materials.end(),
                               [&](const MaterialSettings& m) { return m.name == name; });
  return static_cast<std::uint32_t>(at - scene.materials.begin());
}

/// Diffuse reflectance of each point: the material's albedo, else the points' colours, else grey; no more than
/// a specular part leaves; none of what does not reflect diffusely.
void set_albedo(PointCloud& cloud, const MaterialSettings& material) {
  if (!exchanges_light(material)) {
    cloud.colour.assign(cloud.size(), Eigen::Vector3f::Zero());
    return;
  }
  const Eigen::Vector3f most = (Vector3d::Ones() - material.specular).cast<float>();
  if (!material.albedo && !cloud.colour.empty()) {
    parallel_ranges(cloud.colour.size(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        for (int k = 0; k < 3; ++k) {
          float& c = cloud.colour[i][k];
          const float value = std::clamp(c, 0.0f, 1.0f);
          c = std::min(material.colour_space == ColourSpace::srgb ? srgb_to_linear(value) : value, most[k]);
        }
    });
    return;
  }
  const Vector3d albedo = material.albedo.value_or(Vector3d::Constant(default_albedo));
  cloud.colour.assign(cloud.size(), albedo.cast<float>().cwiseMin(most));
}

/// From a cloud's own coordinates to the scene's.
struct CloudPose {
  Eigen::Matrix3d rotation;
  double scale;
  Vector3d translate;

  explicit CloudPose(const CloudSettings& settings)
      : rotation(rotation_of(settings)), scale(settings.scale), translate(settings.translate) {}
  Vector3d to_scene(const Vector3d& p) const { return rotation * (p * scale) + translate; }
  Vector3d to_cloud(const Vector3d& p) const { return rotation.transpose() * (p - translate) / scale; }
};

void place(PointCloud& cloud, const CloudSettings& settings, const CloudPose& pose) {
  const bool turned = !settings.rotate_deg.isZero();
  const Eigen::Matrix3f rotation_f = pose.rotation.cast<float>();
  const auto scale = static_cast<float>(settings.scale);
  parallel_ranges(cloud.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Vector3d p = cloud.position[i] * settings.scale;
      if (turned) {
        p = pose.rotation * p;
        cloud.normal[i] = (rotation_f * cloud.normal[i]).normalized();
      }
      cloud.position[i] = p + settings.translate;
      cloud.radius[i] = settings.radius ? static_cast<float>(*settings.radius) : cloud.radius[i] * scale;
      cloud.area[i] *= scale * scale;
    }
  });
  if (settings.radius) cloud.clipped.clear(); // the user's discs are whole
  for (ClippedPoint& clipped : cloud.clipped)
    for (ClipStrips::Strip& strip : clipped.clip.strip) {
      strip.axis = pose.rotation * strip.axis;
      strip.low *= settings.scale;
      strip.high *= settings.scale;
    }
}

/// What is known beyond the file, in the cloud's own coordinates: what the scene's camera and lamps see faces them.
CompleteOptions completion_of(const CloudSettings& settings, const Scene& scene) {
  const CloudPose pose(settings);
  CompleteOptions options{settings.normals, settings.radii, settings.viewpoint, settings.strays, {}, {}};
  if (scene.traversal.surface == SurfaceForm::mls) options.followed_cosine = mls_surface_cosine;
  if (scene.camera.chosen) options.eyes.push_back(pose.to_cloud(scene.camera.position));
  for (const LightSettings& light : scene.lights)
    if (!light.is_far && light.type == LightType::point) options.eyes.push_back(pose.to_cloud(light.vector));
  if (scene.up_chosen) options.up = Vector3d(pose.rotation.transpose() * direction_of(scene.up));
  return options;
}

/// What the report says of places and directions, too.
void place(CloudReport& report, const CloudPose& pose) {
  for (Vector3d& station : report.stations) {
    if (report.placement) station = (*report.placement)(station);
    station = pose.to_scene(station);
  }
  for (auto* up : {&report.up, &report.usual_up})
    if (*up) *up = Vector3d(pose.rotation * **up);
}

/// Where the material or the lack of colours asks for it.
void take_colours_from_fields(PointCloud& cloud, const CloudSettings& settings, const MaterialSettings& material,
                              CloudReport& report) {
  if (material.albedo_field) colours_from_fields(material, settings.file, cloud, report);
  // Meshes keep the intensity of their scans, which is no picture of the surface.
  else if (!material.albedo && cloud.colour.empty() && report.triangles == 0 && exchanges_light(material))
    colours_from_intensity(cloud, report);
  cloud.fields = {};
}

void refuse_fields(const ShapeSettings& shape, const MaterialSettings& material) {
  if (!material.albedo_field) return;
  throw Error(ErrorKind::input, shape.place.text() + ": the shape's material \"" + material.name +
                                    "\" takes its albedo from a field of the points, and shapes have none; give it "
                                    "another material");
}

void append(WorldSplats& all, PointCloud&& part, std::uint32_t material) {
  all.first.push_back(static_cast<std::uint32_t>(all.cloud.size()));
  const auto join = [](auto& to, auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  all.material.insert(all.material.end(), part.size(), material);
  for (const ClippedPoint& c : part.clipped)
    all.clipped.push_back({all.first.back() + c.point, c.clip});
  part.clipped = {};
  if (all.cloud.size() == 0) { // the common scene, one cloud, is not copied
    all.cloud = std::move(part);
    all.cloud.triangle = {};
    all.cloud.fields = {};
    all.record = std::move(all.cloud.record);
    all.cloud.record = {};
    return;
  }
  if (!all.cloud.structure.empty() || !part.structure.empty()) { // what is not looked at is as good as a surface
    all.cloud.structure.resize(all.cloud.size(), Structure::surface);
    part.structure.resize(part.size(), Structure::surface);
    join(all.cloud.structure, part.structure);
  }
  join(all.cloud.position, part.position);
  join(all.cloud.normal, part.normal);
  join(all.cloud.colour, part.colour);
  join(all.cloud.radius, part.radius);
  join(all.cloud.area, part.area);
}

} // namespace

void append_cloud(WorldSplats& splats, PointCloud&& cloud, const MaterialSettings& material, std::uint32_t number) {
  set_albedo(cloud, material);
  const std::size_t size = splats.cloud.size() + cloud.size(); // exactly: doubled arrays of a large scan would not fit
  splats.cloud.position.reserve(size);
  splats.cloud.normal.reserve(size);
  splats.cloud.colour.reserve(size);
  splats.cloud.radius.reserve(size);
  splats.cloud.area.reserve(size);
  splats.material.reserve(size);
  append(splats, std::move(cloud), number);
}

Eigen::Matrix3d rotation_of(const CloudSettings& settings) {
  const Vector3d angle = settings.rotate_deg * (3.14159265358979323846 / 180.0);
  return (Eigen::AngleAxisd(angle.z(), Vector3d::UnitZ()) * Eigen::AngleAxisd(angle.y(), Vector3d::UnitY()) *
          Eigen::AngleAxisd(angle.x(), Vector3d::UnitX()))
      .toRotationMatrix();
}

PointCloud load_cloud(const CloudSettings& settings, const Scene& scene, CloudReport& report,
                      const std::vector<std::string>& fields) {
  std::vector<std::string> wanted = fields_of(settings.selection);
  wanted.insert(wanted.end(), fields.begin(), fields.end());
  PointCloud cloud = settings.points
                         ? *settings.points
                         : read_cloud(settings.file, {settings.spacing / settings.scale, wanted, false}, report);
  if (settings.points) report.format = "arrays in memory";
  report.sampled = !cloud.area.empty();
  try {
    if (report.points_in_file == 0) report.points_in_file = cloud.size();
    select_points(cloud, settings.selection, report); // in the file's own coordinates
    CompleteOptions options = completion_of(settings, scene);
    if (report.placement) {
      std::transform(cloud.position.begin(), cloud.position.end(), cloud.position.begin(), *report.placement);
      if (options.viewpoint) options.viewpoint = (*report.placement)(*options.viewpoint);
    }
    complete_cloud(cloud, options, report);
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::interrupted) throw; // it is no fault of the cloud
    throw Error(error.kind(), settings.file + ": " + error.what());
  }
  cloud.triangle = {}; // they have given their normals; nothing later reads them
  return cloud;
}

WorldSplats load_splats(const Scene& scene) {
  if (scene.materials.size() > MOST_MATERIALS)
    throw Error(ErrorKind::input, "the scene has " + std::to_string(scene.materials.size()) +
                                      " materials, and at most " + std::to_string(MOST_MATERIALS) +
                                      " go together; share materials between objects");
  static const std::vector<std::string> no_fields;
  WorldSplats all;
  for (const CloudSettings& settings : scene.clouds) {
    CloudReport& report = all.reports.emplace_back();
    const std::uint32_t number = index_of(scene, settings.material);
    const MaterialSettings& material = scene.materials[number];
    PointCloud cloud =
        load_cloud(settings, scene, report, material.albedo_field ? material.albedo_field->fields : no_fields);
    take_colours_from_fields(cloud, settings, material, report);
    set_albedo(cloud, material);
    const CloudPose pose(settings);
    place(cloud, settings, pose);
    place(report, pose);
    append(all, std::move(cloud), number);
  }
  for (const ShapeSettings& settings : scene.shapes) {
    PointCloud cloud = sample_shape(settings);
    cloud.structure.assign(cloud.size(), has_flat_faces(settings) ? Structure::flat : Structure::surface);
    const std::uint32_t material = index_of(scene, settings.material);
    refuse_fields(settings, scene.materials[material]);
    set_albedo(cloud, scene.materials[material]);
    append(all, std::move(cloud), material);
  }
  return all;
}

SplatClips clips_in_cube(const WorldSplats& splats, const Frame& frame, View<Splat> placed, View<std::uint32_t> id) {
  SplatClips result;
  if (splats.clipped.empty()) return result;
  constexpr double far = 4.0; // longer than anything in the cube; infinities would make NaN of an axis of 0
  std::vector<std::uint32_t> clip_of(splats.cloud.size(), no_clip);
  for (std::size_t k = 0; k < splats.clipped.size(); ++k)
    clip_of[splats.clipped[k].point] = static_cast<std::uint32_t>(k);
  for (std::uint32_t i = 0; i < placed.size; ++i) {
    if (clip_of[id[i]] == no_clip) continue;
    const ClipStrips& world = splats.clipped[clip_of[id[i]]].clip;
    const double margin = CLIP_MARGIN(placed[i].radius);
    ClippedSplat clipped{i, {}};
    for (std::size_t k = 0; k < CLIP_STRIPS; ++k) {
      ClipStrip& strip = clipped.clip.strip[k];
      const Eigen::Vector3f axis = world.strip[k].axis.cast<float>();
      std::copy_n(axis.data(), 3, strip.axis);
      strip.low = static_cast<float>(std::max(-far, world.strip[k].low / frame.side - margin));
      strip.high = static_cast<float>(std::min(far, world.strip[k].high / frame.side + margin));
    }
    result.push_back(clipped);
  }
  return result;
}

std::vector<Splat> place_in_cube(const WorldSplats& splats, const Frame& frame) {
  const PointCloud& cloud = splats.cloud;
  std::vector<Splat> result(cloud.size());
  parallel_ranges(cloud.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Splat& s = result[i];
      const Eigen::Vector3f p = frame.to_cube(cloud.position[i]);
      std::copy_n(p.data(), 3, s.position);
      std::copy_n(cloud.normal[i].data(), 3, s.normal);
      std::copy_n(cloud.colour[i].data(), 3, s.colour);
      // Divided in double: the side may be 1e18 or 1e-18, whose inverse squared leaves float.
      s.radius = static_cast<float>(cloud.radius[i] / frame.side);
      s.area = static_cast<float>(cloud.area[i] / frame.side / frame.side);
      s.material = static_cast<float>(splats.material[i]);
      if (!cloud.structure.empty() && cloud.structure[i] == Structure::flat) s.material += FLAT;
    }
  });
  return result;
}

} // namespace pointgi
