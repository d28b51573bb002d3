#include "host/app/command_run.h"
#include "host/app/info_estimate.h"
#include "host/app/light_command.h"
#include "host/cloud/mls_patches.h"
#include "host/lights/environment_map.h"
#include "host/passes/build_pools.h"
#include "host/scene/objects.h"
#include "host/stages/prepare.h"
#include "host/tune/tuned.h"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

namespace pointgi {

namespace {

void print_report(const std::string& file, const CloudReport& report) {
  std::printf("%s\n", file.c_str());
  std::printf("  format      %s\n", report.format.c_str());
  std::printf("  points      %zu in the file, ", report.points_in_file);
  if (report.points_left_out > 0) std::printf("%zu left out, ", report.points_left_out);
  std::printf("%zu dropped\n", report.points_dropped);
  std::printf("  triangles   %zu\n", report.triangles);
  std::printf("  normals     %s\n", report.normals_from.c_str());
  if (!report.kind_reason.empty())
    std::printf("  kind        %s: %s\n", name_of(report.kind), report.kind_reason.c_str());
  std::printf("  radii       %s\n", report.radii_from.c_str());
  std::printf("  areas       %s\n", report.areas_from.c_str());
  std::size_t widest = 0;
  for (const PropertyUse& p : report.properties)
    widest = std::max(widest, p.property.size());
  constexpr std::size_t most = 40; // a file may have thousands
  for (std::size_t i = 0; i < std::min(most, report.properties.size()); ++i)
    std::printf("  %s %-*s  %s\n", i == 0 ? "properties " : "           ", static_cast<int>(widest),
                report.properties[i].property.c_str(), report.properties[i].use.c_str());
  if (report.properties.size() > most) std::printf("              and %zu more\n", report.properties.size() - most);
  for (const std::string& note : report.notes)
    std::printf("  note        %s\n", note.c_str());
  for (const std::string& warning : report.warnings)
    std::printf("  warning     %s\n", warning.c_str());
}

struct Bounds {
  Vector3d low, high;
};

Bounds bounds_of(const PointCloud& cloud, std::size_t first, std::size_t end) {
  Bounds bounds{cloud.position[first], cloud.position[first]};
  for (std::size_t i = first; i < end; ++i) {
    bounds.low = bounds.low.cwiseMin(cloud.position[i]);
    bounds.high = bounds.high.cwiseMax(cloud.position[i]);
  }
  return bounds;
}

void print_bounds(const Bounds& b) {
  std::printf("[%.9g, %.9g, %.9g] to [%.9g, %.9g, %.9g]\n", b.low.x(), b.low.y(), b.low.z(), b.high.x(), b.high.y(),
              b.high.z());
}

/// Where each cloud and shape of a scene is, of the first of them: a scene may have thousands.
void print_objects(const Scene& scene, const WorldSplats& splats) {
  constexpr std::size_t most = 100;
  const std::size_t objects = splats.first.size();
  for (std::size_t i = 0; i < std::min(most, objects); ++i) {
    const std::size_t end = i + 1 < objects ? splats.first[i + 1] : splats.cloud.size();
    std::printf("  %s %s: %zu splats, ", i == 0 ? "objects    " : "           ", object_of(scene, i).name.c_str(),
                end - splats.first[i]);
    print_bounds(bounds_of(splats.cloud, splats.first[i], end));
  }
  if (objects > most) std::printf("              and %zu more\n", objects - most);
}

void print_sky(const Scene& scene) {
  if (scene.sky == nullptr) return;
  const Vector3d mean = mean_radiance(*scene.sky);
  std::printf("  environment map of %d x %d pixels, mean radiance [%.4g, %.4g, %.4g] W/m^2/sr, largest %.4g\n",
              scene.sky->width, scene.sky->height, mean.x(), mean.y(), mean.z(), largest_radiance(*scene.sky));
}

/// The value that a share of the points stays below.
float percentile(std::vector<float> values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

} // namespace

ExitCode run_info(const InfoOptions& options) {
  CommandRun run(options.quiet);
  const std::string& file = options.input;
  const bool is_scene = is_scene_file(file);
  const Scene scene = load_any(file, picture_overrides_of(options));
  const WorldSplats splats = load_splats(scene);
  for (std::size_t i = 0; i < scene.clouds.size(); ++i)
    print_report(scene.clouds[i].file, splats.reports[i]);
  const PointCloud& cloud = splats.cloud;
  const double area = std::accumulate(cloud.area.begin(), cloud.area.end(), 0.0);
  if (is_scene) {
    std::printf("%s\n  scene       %zu clouds, %zu shapes, %zu materials, %zu lights\n", file.c_str(),
                scene.clouds.size(), scene.shapes.size(), scene.materials.size(), scene.lights.size());
    print_sky(scene);
    for (const std::string& warning : scene.warnings)
      std::printf("  warning     %s\n", warning.c_str());
    print_objects(scene, splats);
  }
  const Frame frame = frame_of(cloud);
  std::vector<Splat> placed = place_in_cube(splats, frame);
  // No device is opened for this: the form told of is the default of CPU devices, unless the scene says.
  const TraversalVariant variant = choose_variant(scene.traversal, scene.octree, ideal_device(true)).variant;
  std::vector<std::uint32_t> id(placed.size());
  std::iota(id.begin(), id.end(), 0u);
  const SplatClips clips = clips_in_cube(splats, frame, placed, id);
  PatchBends bends;
  if (scene.traversal.surface == SurfaceForm::mls)
    bends = fit_mls_patches(placed, clips, scene.traversal.mls_neighbours).bends;
  const OctreeSummary octree = summary_of(build_pools(placed, variant, clips, bends));
  std::printf("  splats      %zu\n", cloud.size());
  std::printf("  bounds      ");
  print_bounds(bounds_of(cloud, 0, cloud.size()));
  std::printf("  area        %.6g (sum of the splats' effective areas)\n", area);
  std::printf("  spacing     %.4g (mean, square root of the mean area)\n",
              std::sqrt(area / static_cast<double>(cloud.size())));
  std::printf("  radius      %.4g median, %.4g at 99 %%, %.4g largest\n", percentile(cloud.radius, 0.5),
              percentile(cloud.radius, 0.99), percentile(cloud.radius, 1.0));
  std::printf("  octree      %s form: %zu nodes, %zu leaves, depth %u, %.2f extra splats a splat\n", octree.form,
              octree.nodes, octree.leaves, octree.depth,
              static_cast<double>(octree.extra_splats) / static_cast<double>(cloud.size()));
  std::printf("  memory      %.1f MiB of pools, %.0f bytes a splat\n", static_cast<double>(octree.bytes) / 1048576.0,
              static_cast<double>(octree.bytes) / static_cast<double>(cloud.size()));
  std::fflush(stdout); // the estimate takes some seconds
  if (!options.no_estimate) print_estimate(options, run);
  return ExitCode::done;
}

} // namespace pointgi
