#include "host/api/parts.h"
#include "host/api/scene_hash.h"
#include "host/app/command_run.h"
#include "host/app/commands.h"
#include "host/app/light_command.h"
#include "host/app/output_files.h"
#include "host/app/resume.h"
#include "host/app/stats.h"
#include "host/cloud/input_file.h"
#include "host/stages/lit_file.h"
#include <cstdio>
#include <spdlog/spdlog.h>

namespace pointgi {

namespace {

bool is_las(const BakeOptions& options) {
  return has_extension(options.output, ".las");
}

void require_passes(const BakeOptions& options, const Scene& scene) {
  const RadiosityMethod* method = radiosity_method(scene.radiosity.method);
  if (method == nullptr || !method->has_passes)
    throw Error(ErrorKind::usage, "--passes: radiosity.method = \"" + scene.radiosity.method +
                                      "\" has no passes to write; add --set radiosity.method=gather");
  if (is_las(options))
    throw Error(ErrorKind::usage,
                "--passes: the clouds of the passes are PLY files; choose an output that ends in .ply");
}

/// Everything that can be refused is refused here, before the work.
api::Scene checked_scene(const BakeOptions& options) {
  if (!has_extension(options.output, ".ply") && !is_las(options))
    throw Error(ErrorKind::output,
                options.output +
                    ": a lit cloud is written as .ply, that of a LAS or LAZ file also as .las; choose such a name");
  api::Scene checked = api::Scene::from_file(options.input, overrides_of(options));
  checked.set_bake_quality(options.quality);
  const Scene scene = checked.parts()->description();
  require_possible_radiosity(scene);
  if (options.passes) require_passes(options, scene);
  if (is_las(options) && !can_write_las(scene))
    throw Error(ErrorKind::output, options.output +
                                       ": only what was one LAS or LAZ file, and nothing else, is written as .las; "
                                       "choose a name that ends in .ply");
  require_outputs(options.input, scene, {{"-o", options.output}, {"--stats", options.stats_file}});
  return checked;
}

} // namespace

ExitCode run_bake(const BakeOptions& options) {
  CommandRun run(options.quiet);
  StageLog begun;
  begun.start("scene");
  const api::Scene scene = checked_scene(options);
  const Scene description = scene.parts()->description();
  begun.finish(description.clouds.size() + description.shapes.size(), "objects");
  const api::Context context = open_context(options, std::move(begun), run.control());
  StageLog& stages = context.parts()->stages;
  const api::Prepared prepared(context, scene, run.control());
  const bool specular = prepared.parts()->ready.lighting.has_specular();
  if (description.caustics.place && specular)
    spdlog::warn("{}: [caustics] has no effect: a lit cloud holds no caustics", description.caustics.place->text());
  if (description.radiosity.method == "cones" && description.radiosity.at == "pixels")
    spdlog::warn(
        "{}: radiosity.at = \"pixels\" has no effect: a lit cloud has no pixels, its light is that of the points",
        description.radiosity.place->text());
  api::LitFileOptions content{description.render.exposure, options.sky};
  if (description.render.auto_exposure) content.exposure.reset();
  api::LightOptions solving{false, false};
  if (options.passes) solving.pass_file = options.output;
  solving.pass_content = content;
  const std::unique_ptr<Checkpoint> checkpoint = open_checkpoint(options, options.output, [&] {
    return checkpoint_key(scene, prepared, options.passes ? "bake --passes" : "bake", nullptr);
  });
  const CheckpointScope kept(checkpoint.get());
  resumable(checkpoint.get(), options.output, [&] {
    const api::Light light(prepared, solving, run.control());
    stages.skip("photon", specular ? "a lit cloud holds no caustics" : "no specular material");
    stages.skip("render", "a lit cloud is no picture: it has no camera");
    if (options.sky) light.sky(run.control());
    stages.start("bake");
    if (is_las(options))
      light.write_las(options.output, content, run.control());
    else
      light.write_ply(options.output, content, run.control());
    stages.finish(prepared.size(), "points");
    if (options.stats_file.empty()) return;
    Stats stats = stats_of(*light.parts());
    stats.command = "bake";
    write_stats(options.stats_file, stats, stages);
  });
  close_checkpoint(checkpoint.get(), options.output, false);
  run.end_progress();
  std::printf("%s\n", options.output.c_str());
  spdlog::info("{} lit points, {}", prepared.size(), duration_text(stages.seconds()));
  return ExitCode::done;
}

} // namespace pointgi
