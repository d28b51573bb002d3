#include "host/api/estimate.h"
#include "host/api/scene_hash.h"
#include "host/app/choose_setting.h"
#include "host/app/command_run.h"
#include "host/app/commands.h"
#include "host/app/light_command.h"
#include "host/app/make_picture.h"
#include "host/app/numbers.h"
#include "host/app/output_files.h"
#include "host/app/progress.h"
#include "host/app/resume.h"
#include "host/app/stats.h"
#include "host/atomic_file.h"
#include "host/scene/presets.h"
#include "host/stages/scene_kind.h"
#include "host/stages/view_warnings.h"
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <omp.h>
#include <set>
#include <spdlog/spdlog.h>
#include <unistd.h>

namespace pointgi {

std::vector<std::string> picture_overrides_of(const RenderOptions& options) {
  std::vector<std::string> overrides = overrides_of(options);
  if (!options.size.empty()) {
    const auto [width, height] = size_of(options.size, 1);
    overrides.push_back("render.size=[" + std::to_string(width) + ", " + std::to_string(height) + "]");
  }
  if (options.spp) overrides.push_back("render.spp=" + std::to_string(*options.spp));
  return overrides;
}

namespace {

/// The part of the picture that --pixelbounds asks for; absent: all.
std::optional<std::array<int, 4>> window_of(const RenderOptions& options, const RenderSettings& render) {
  if (options.pixel_bounds.empty()) return std::nullopt;
  const std::string form = "--pixelbounds: expected x0,x1,y0,y1 with 0 <= x0 < x1 <= " + std::to_string(render.width) +
                           " and 0 <= y0 < y1 <= " + std::to_string(render.height);
  const auto b = whole_numbers(options.pixel_bounds, ',', 4, form);
  if (b[0] >= b[1] || b[1] > render.width || b[2] >= b[3] || b[3] > render.height)
    throw Error(ErrorKind::usage, form + ", found \"" + options.pixel_bounds + "\"");
  return std::array<int, 4>{b[0], b[1], b[2], b[3]};
}

std::string output_of(const RenderOptions& options) {
  return options.output.empty() ? std::filesystem::path(options.input).stem().string() + ".exr" : options.output;
}

bool has_open_goal(const RenderOptions& options) {
  return options.seconds || options.error;
}

/// Everything that can be refused is refused here, before the work and not after it. `chosen`: overrides of the scene
/// file, over which flags win.
api::Scene checked_scene(const RenderOptions& options, const std::vector<std::string>& chosen = {}) {
  if (options.integrator != "path" && !options.paths.empty())
    throw Error(ErrorKind::usage, "--paths: only --integrator path can choose the light paths that count");
  light_paths(options.paths, {}); // before a large scene is read
  if (options.spp && (options.seconds || options.error))
    throw Error(ErrorKind::usage, std::string("--spp: the samples follow from ") +
                                      (options.seconds ? "--time" : "--error") + "; leave one of the two out");
  if (options.quality != "normal" && has_open_goal(options))
    throw Error(ErrorKind::usage, std::string("--quality: the settings follow from ") +
                                      (options.seconds ? "--time" : "--error") + "; leave one of the two out");
  if (options.resume && has_open_goal(options))
    throw Error(ErrorKind::usage, std::string("--resume: what is to be done follows from ") +
                                      (options.seconds ? "--time" : "--error") +
                                      ", which a run that was ended has changed; leave one of the two out");
  std::vector<std::string> overrides = chosen;
  for (const std::string& own : picture_overrides_of(options))
    overrides.push_back(own);
  api::Scene checked = api::Scene::from_file(options.input, overrides);
  checked.set_quality(options.quality, !options.spp);
  const Scene scene = checked.parts()->description();
  if (options.integrator != "path") require_possible_radiosity(scene);
  const bool unnamed = options.output.empty();
  require_outputs(options.input, scene,
                  {{"-o", output_of(options), unnamed},
                   {"-o", png_path_of(output_of(options)), unnamed},
                   {"--stats", options.stats_file},
                   {"--trace", options.trace_file}});
  return checked;
}

/// Seconds of the device in all stages.
double kernel_seconds(const Session& session) {
  double seconds = 0.0;
  for (const auto& [name, time] : session.kernel_times())
    seconds += time.seconds;
  return seconds;
}

void write_reports(const RenderOptions& options, const api::Light::Parts& light, const RenderTotals& totals,
                   const std::optional<DenoisedPictures>& denoised) {
  const api::Prepared::Parts& prepared = *light.prepared;
  const api::Context::Parts& context = *prepared.context;
  if (!options.stats_file.empty()) {
    Stats stats = stats_of(light);
    stats.command = "render";
    stats.integrator = options.integrator;
    stats.render = totals;
    stats.denoised = denoised;
    stats.photons = light.light.ledger;
    const Frame& frame = prepared.ready.frame;
    stats.photon_watts = prepared.ready.lighting.radiance.scale * frame.side * frame.side;
    write_stats(options.stats_file, stats, context.stages);
  }
  if (!options.trace_file.empty())
    write_text(options.trace_file, context.stages.chrome_trace(context.session.launches()));
}

double pixels_of(const api::FilmOptions& film, const RenderSettings& render) {
  if (!film.window) return double{1.0} * render.width * render.height;
  const auto& [x0, x1, y0, y1] = *film.window;
  return double{1.0} * (x1 - x0) * (y1 - y0);
}

/// The settings of the light as --set would give them.
std::vector<std::string> light_overrides_of(const RenderOptions& options) {
  std::vector<std::string> all = options.overrides;
  const Scene scene = api::Scene::from_file(options.input, options.overrides).parts()->description();
  for (const std::string& text : preset_overrides(preset_named(options.quality, "--quality"), scene))
    all.push_back(text);
  all.erase(std::remove_if(all.begin(), all.end(), [](const auto& text) { return text.rfind("render.", 0) == 0; }),
            all.end());
  return all;
}

/// What --time and --error make of it, or what is known beforehand of the picture as it was asked for.
std::optional<ChosenSetting> setting_for(const RenderOptions& options, const Scene& scene, const std::string& device,
                                         double pixels, double begun) {
  if (options.integrator == "path") return std::nullopt;
  const std::optional<Trade> trade = trade_for(options, device);
  if (!trade) return std::nullopt;
  std::optional<ChosenSetting> setting =
      has_open_goal(options) ? choose_by_trade(*trade, options, pixels, begun)
                             : forecast_of(*trade, light_overrides_of(options), scene.render.spp, pixels);
  if (setting) spdlog::info("{}: {}", options.input, setting->told);
  return setting;
}

/// What presets reached on scenes of its kind, and `seconds` that the picture takes, if that is known.
void tell_of_kind(const RenderOptions& options, const api::Prepared& prepared, const std::string& seconds) {
  const std::string kind = kind_of_scene(prepared.parts()->scene, prepared.parts()->ready);
  std::vector<std::string> told;
  if (!seconds.empty()) told.push_back(seconds);
  if (const auto errors = errors_of_kind(options.quality, kind))
    told.push_back(fmt::format("relMSE {:.1g} to {:.1g}, as other scenes of its kind ({}) had", errors->first,
                               errors->second, kind));
  if (!told.empty()) spdlog::info("expected: {}", fmt::join(told, "; "));
}

bool is_of_preparation(const std::string& stage) {
  return stage == "scene" || stage == "cloud" || stage == "octree";
}

/// Of the picture's stages but those that have run already and these.
double seconds_of_stages(const api::Prepared& prepared, const api::FilmOptions& film,
                         const std::set<std::string>& besides, const RunControl& run) {
  double seconds = 0.0;
  for (const api::StageEstimate& stage : api::estimate_picture(prepared, film, run).stages)
    if (stage.runs && !is_of_preparation(stage.stage) && besides.count(stage.stage) == 0) seconds += stage.seconds;
  return seconds;
}

/// After the preview, to who waits for the picture.
void tell_expected(const RenderOptions& options, const api::Prepared& prepared, const api::FilmOptions& film,
                   const PreviewCost& preview, const RunControl& run) {
  constexpr double least_for_estimate = 5.0; // which does a part of the work, a tenth of it or less
  constexpr int usual_light_samples = 64;
  const Scene& scene = prepared.parts()->scene;
  const double seconds =
      preview.seconds_a_sample * scene.render.spp + preview.seconds_a_direction * scene.radiosity.directions;
  // The preview has no photons, and few light samples of points.
  const bool has_photons = prepared.parts()->ready.lighting.has_specular() && scene.caustics.photons > 0;
  const bool has_more = has_photons || scene.radiosity.light_samples.value_or(0) > usual_light_samples;
  std::string text = fmt::format("less than about {} from here", duration_text(least_for_estimate));
  if (seconds > least_for_estimate || has_more) try {
      text = fmt::format("about {} from here", duration_text(seconds_of_stages(prepared, film, {}, run)));
    } catch (const Error& error) { // the picture may do without what the estimate could not
      if (error.kind() == ErrorKind::interrupted) throw;
      text.clear();
    }
  tell_of_kind(options, prepared, text);
}

/// Without a measurement of the scene, by what presets reached on others of its kind: sets the light's settings of the
/// preset that --time and --error choose.
void choose_of_kind(const RenderOptions& options, const api::Prepared& prepared, const api::FilmOptions& film,
                    PictureGoal& goal, const RunControl& run) {
  // A part of the light is solved for an estimate: a few seconds.
  constexpr double least_for_estimate = 15.0;
  api::Prepared::Parts& parts = *prepared.parts();
  const std::string kind = kind_of_scene(parts.scene, parts.ready);
  double light_seconds = 0.0;
  if (options.seconds && *options.seconds - parts.context->stages.seconds() < least_for_estimate)
    light_seconds = *options.seconds; // the least preset is safe
  else if (options.seconds)
    light_seconds = seconds_of_stages(prepared, film, {"render"}, run);
  const PresetChoice choice = choose_by_presets(kind, options, light_seconds, parts.context->stages.seconds());
  apply_preset(preset_named(choice.preset, "--quality"), parts.scene, true);
  parts.quality = choice.preset;
  spdlog::info("{}: {}", options.input, choice.setting.told);
  const double seconds_a_sample = goal.seconds_a_sample;
  goal = choice.setting.goal;
  goal.seconds_a_sample = seconds_a_sample;
}

/// A picture of more pixels does not grow unless that is asked for: its film is kept.
constexpr double most_growing_pixels = 1 << 23;

bool grows(const RenderOptions& options, const api::Prepared& prepared, double pixels) {
  if (options.progressive || has_open_goal(options)) return true;
  return !options.quiet && isatty(STDERR_FILENO) != 0 && pixels <= most_growing_pixels &&
         film_fits(prepared, pixels, false, options.denoise);
}

PictureGoal goal_of(const RenderOptions& options, const std::optional<ChosenSetting>& setting, int samples) {
  PictureGoal goal;
  if (setting) goal = setting->goal;
  goal.samples = has_open_goal(options) ? goal.samples : samples;
  goal.until = options.seconds;
  goal.error = options.error;
  return goal;
}

/// Null where none is asked for. Throws Error(usage) where there is none.
std::unique_ptr<Denoiser> denoiser_for(const RenderOptions& options) {
  if (!options.denoise) return nullptr;
  try_denoiser();
  return std::make_unique<Denoiser>(omp_get_max_threads());
}

} // namespace

ExitCode run_render(const RenderOptions& options) {
  CommandRun run(options.quiet);
  std::unique_ptr<Denoiser> denoiser = denoiser_for(options); // before anything has taken time, or made threads
  StageLog stages;
  stages.start("scene");
  api::Scene scene = checked_scene(options);
  Scene description = scene.parts()->description();
  api::FilmOptions film;
  film.window = window_of(options, description.render);
  film.paths = options.paths;
  film.auxiliary = options.denoise;
  const double pixels = pixels_of(film, description.render);
  stages.finish(description.clouds.size() + description.shapes.size(), "objects");

  const api::Context context = open_context(options, std::move(stages), run.control());
  api::Context::Parts& device = *context.parts();
  device.session.dump_kernels_to(options.dump_folder);
  if (!options.trace_file.empty()) device.session.record_launches();
  const std::optional<ChosenSetting> setting =
      setting_for(options, description, context.device(), pixels, device.stages.seconds());
  if (has_open_goal(options) && setting) {
    scene = checked_scene(options, setting->overrides);
    description = scene.parts()->description();
  }
  const api::Prepared prepared(context, scene, run.control());
  const bool of_kind = !setting && options.integrator != "path";
  bool growing = grows(options, prepared, pixels);
  PictureOutput output(output_of(options),
                       description.render.auto_exposure ? std::nullopt
                                                        : std::optional<double>(description.render.exposure),
                       std::move(denoiser));
  std::unique_ptr<Checkpoint> checkpoint;
  if (options.resume) remove_unfinished(output.png_path());
  if (!has_open_goal(options))
    checkpoint = open_checkpoint(options, output.exr_path(),
                                 [&] { return checkpoint_key(scene, prepared, options.integrator, &film); });
  // As the run that is gone on from: one keeps passes, the other rows.
  const std::string kept = checkpoint_folder(output.exr_path());
  const bool goes_on = options.resume && checkpoint && checkpoint->take_folder();
  if (goes_on && Checkpoint::is_in(kept, "rows-")) growing = false;
  if (goes_on && Checkpoint::is_in(kept, "film-")) growing = true;
  BeforeLight before_light;
  if (of_kind && has_open_goal(options))
    before_light = [&](PictureGoal& goal, const PreviewCost&) {
      choose_of_kind(options, prepared, film, goal, run.control());
    };
  else if (of_kind && growing && !options.quiet)
    before_light = [&](PictureGoal&, const PreviewCost& preview) {
      tell_expected(options, prepared, film, preview, run.control());
    };
  else if (of_kind)
    tell_of_kind(options, prepared, "`pointgi info` tells the seconds");
  const PictureRun picture{context,       prepared,        film, options.integrator == "path", pixels,
                           run.control(), checkpoint.get()};
  const MadePictureFiles made = resumable(checkpoint.get(), output.exr_path(), [&] {
    MadePictureFiles files =
        growing ? make_growing_picture(picture, goal_of(options, setting, description.render.spp), before_light, output)
                : make_picture_at_once(picture, output);
    if (description.render.auto_exposure)
      spdlog::info("exposure chosen: {:.2f} stops (--exposure={:.2f} gives the same)", output.png_light().exposure,
                   output.png_light().exposure);
    if (files.light && !files.interrupted)
      warn_of_exposure(output.png_light(), prepared.parts()->scene, prepared.parts()->ready);
    if (files.light)
      write_reports(options, *files.light->parts(), files.totals, output.denoised());
    else if (!options.stats_file.empty() || !options.trace_file.empty())
      spdlog::warn("--stats and --trace are not written, as the light was not solved");
    run.end_progress();
    std::printf("%s\n%s\n", output.exr_path().c_str(), output.png_path().c_str());
    if (output.denoised() && output.denoised()->failure) {
      spdlog::warn("{} is written as it was rendered", output.exr_path());
      throw Error(*output.denoised()->failure);
    }
    return files;
  });
  close_checkpoint(checkpoint.get(), output.exr_path(), made.interrupted);
  if (made.interrupted) {
    spdlog::warn("interrupted: {}", made.told);
    return ExitCode::interrupted;
  }
  if (!made.light)
    spdlog::warn("{}", made.told);
  else if (!made.told.empty())
    spdlog::info("{}", made.told);
  spdlog::info("{} splats, {:.1f} million rays, {} ({} of kernels on the device)", prepared.size(),
               1e-6 * static_cast<double>(made.totals.rays), duration_text(device.stages.seconds()),
               duration_text(kernel_seconds(device.session)));
  return ExitCode::done;
}

} // namespace pointgi
