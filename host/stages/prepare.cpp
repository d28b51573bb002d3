#include "host/stages/prepare.h"
#include "host/cloud/input_file.h"
#include "host/cloud/mls_patches.h"
#include "host/run.h"
#include "host/scene/sheet_sides.h"
#include "host/view/default_light.h"
#include <algorithm>
#include <numeric>

namespace pointgi {

bool is_scene_file(const std::string& file) {
  return has_extension(file, ".toml");
}

Scene load_any(const std::string& file, const std::vector<std::string>& overrides) {
  return is_scene_file(file) ? load_scene(file, overrides) : load_bare_cloud(file, overrides);
}

namespace {

void log_reports(const Scene& scene, const WorldSplats& splats) {
  for (const std::string& warning : scene.warnings)
    log_warning("{}", warning);
  for (std::size_t i = 0; i < splats.reports.size(); ++i) {
    const CloudReport& r = splats.reports[i];
    log_info("{}: {} points; normals {}; radii {}", scene.clouds[i].file,
             r.points_in_file - r.points_left_out - r.points_dropped, r.normals_from, r.radii_from);
    if (!r.kind_reason.empty()) log_info("{}: taken as {}: {}", scene.clouds[i].file, name_of(r.kind), r.kind_reason);
    for (const std::string& note : r.notes)
      log_info("{}: {}", scene.clouds[i].file, note);
    for (const std::string& warning : r.warnings)
      log_warning("{}: {}", scene.clouds[i].file, warning);
  }
}

/// What the user left open is chosen so that the picture is worth looking at.
void choose_view(Scene& scene, WorldSplats& splats, bool bare) {
  const bool unlit = bare && scene.lights.empty() && scene.sky == nullptr && scene.environment.isZero();
  if (scene.camera.chosen && !bare && !scene.ground) return;
  const ChosenView view = scene.camera.chosen ? given_view(scene, splats, bare) : choose_camera(scene, splats);
  if (!view.sentence.empty()) log_info("{}", view.sentence);
  if (unlit)
    for (const std::string& sentence : choose_lights(scene, splats, view))
      log_info("{}", sentence);
  else if (scene.ground && !bare)
    add_ground(scene, splats, view, Vector3d::Constant(0.5));
}

/// Whether each point ends at a border; empty where none does.
std::vector<bool> points_with_borders(const WorldSplats& world) {
  std::vector<bool> ends(world.clipped.empty() ? 0 : world.cloud.size(), false);
  for (const ClippedPoint& clipped : world.clipped)
    ends[clipped.point] = true;
  return ends;
}

} // namespace

PlacedSplats load_and_place(Scene& scene, bool bare) {
  WorldSplats world = load_splats(scene);
  const bool one_file = scene.clouds.size() == 1 && scene.shapes.empty() && !world.reports[0].sampled;
  const auto file_points = static_cast<std::uint32_t>(world.cloud.size());
  choose_view(scene, world, bare);
  log_reports(scene, world);
  PlacedSplats placed;
  for (const CloudReport& report : world.reports)
    placed.kinds.push_back(report.kind);
  placed.frame = frame_of(world.cloud);
  placed.splats = place_in_cube(world, placed.frame);
  placed.first_ids = world.first;
  placed.id.resize(placed.splats.size());
  std::iota(placed.id.begin(), placed.id.end(), 0u);
  std::vector<CoincidentSides> sides;
  std::vector<MergedSplat> merged = merge_coincident(placed.splats, placed.id, &sides, points_with_borders(world));
  if (!merged.empty()) log_info("{} points that lie on others were merged with them", merged.size());
  if (one_file) placed.file_order = FileOrder{std::move(world.record), file_points, std::move(merged)};
  if (const std::size_t sheets = divide_sheets(scene, placed.splats, placed.id, world.cloud.structure, sides);
      sheets > 0)
    log_info("{} splats are two-sided: each side is a point of its own", sheets);
  placed.clips = clips_in_cube(world, placed.frame, placed.splats, placed.id);
  if (scene.traversal.surface == SurfaceForm::mls) {
    MlsPatches mls = fit_mls_patches(placed.splats, placed.clips, scene.traversal.mls_neighbours);
    log_info("surface mls: {} patches; {} planes, whose neighbours allow no more; {} discs as they were", mls.patches,
             mls.planes, mls.discs);
    placed.bends = std::move(mls.bends);
  }
  return placed;
}

} // namespace pointgi
