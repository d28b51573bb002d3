#include "host/app/commands.h"
#include "host/app/indirect_stages.h"
#include "host/app/interrupt.h"
#include "host/app/lit_cloud.h"
#include "host/app/output_files.h"
#include "host/app/prepared_scene.h"
#include "host/app/progress.h"
#include "host/app/stats.h"
#include "host/app/view_warnings.h"
#include "host/cloud/input_file.h"
#include <cstdio>
#include <spdlog/spdlog.h>

namespace pointgi {

namespace {

/// Everything that can be refused is refused here, before the work.
Scene checked_scene(const BakeOptions& options) {
  if (!has_extension(options.output, ".ply"))
    throw Error(ErrorKind::output, options.output + ": a lit cloud is written as .ply; choose such a name");
  Scene scene = load_any(options.input, overrides_of(options));
  apply_bake_quality(options.quality, scene);
  require_possible_radiosity(scene);
  require_outputs(options.input, scene, {{"-o", options.output}, {"--stats", options.stats_file}});
  return scene;
}

} // namespace

ExitCode run_bake(const BakeOptions& options) {
  StageLog stages;
  stages.start("scene");
  Scene scene = checked_scene(options);
  stages.finish(scene.clouds.size() + scene.shapes.size(), "objects");
  Session session(choose_device(options.device));
  spdlog::info("device: {} ({}, driver {})", session.info().name, session.info().platform, session.info().driver);
  const PreparedScene ready = prepare_scene(session, scene, !is_scene_file(options.input), stages);
  catch_interrupts();
  const IndirectRequest request{ready.choice.variant,   scene, ready.frame,   ready.lighting,
                                points_of(ready.pools), false, options.quiet, interrupted};
  if (scene.caustics.place && ready.lighting.has_specular())
    spdlog::warn("{}: [caustics] has no effect: a lit cloud holds no caustics", scene.caustics.place->text());
  IndirectLight light = run_indirect_stages(session, ready.on_device, request, stages);
  stages.skip("photon", ready.lighting.has_specular() ? "a lit cloud holds no caustics" : "no specular material");
  stages.skip("render", "a lit cloud is no picture: it has no camera");
  stages.start("bake");
  if (light.direct.empty()) {
    spdlog::warn("no light between surfaces: {}", reason_against_radiosity(request));
    light.direct = direct_light_of_points(session, ready.on_device, request);
  }
  warn_of_unlit(scene, ready, light.direct, light.from_surfaces);
  const LitCloud lit = lit_cloud(request, light, scene.render.exposure);
  write_ply(options.output, lit.cloud, lit.columns);
  stages.finish(lit.cloud.size(), "points");
  if (!options.stats_file.empty()) {
    Stats stats;
    stats.command = "bake";
    stats.variant = ready.choice;
    stats.scene = &scene;
    stats.session = &session;
    stats.octree = summary_of(ready.pools);
    stats.indirect = &light;
    stats.seconds = stages.seconds();
    write_stats(options.stats_file, stats, stages);
  }
  std::printf("%s\n", options.output.c_str());
  spdlog::info("{} lit points, {}", lit.cloud.size(), duration_text(stages.seconds()));
  return ExitCode::done;
}

} // namespace pointgi
