#include "host/api/parts.h"
#include "host/app/command_run.h"
#include "host/app/commands.h"
#include "host/app/light_command.h"
#include "host/app/output_files.h"
#include "host/app/stats.h"
#include "host/stages/view_warnings.h"
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <spdlog/spdlog.h>

namespace pointgi {

namespace {

/// Exactly `count` whole numbers separated by `separator`, or an Error(usage) that shows how it is written.
std::vector<int> whole_numbers(const std::string& text, char separator, std::size_t count, const std::string& form) {
  std::vector<int> numbers;
  std::size_t at = 0;
  while (at <= text.size()) {
    const std::size_t end = std::min(text.find(separator, at), text.size());
    const std::string part = text.substr(at, end - at);
    if (part.empty() || part.size() > 9 || part.find_first_not_of("0123456789") != std::string::npos) break;
    numbers.push_back(std::stoi(part));
    at = end + 1;
  }
  if (numbers.size() != count || at <= text.size()) throw Error(ErrorKind::usage, form + ", found \"" + text + "\"");
  return numbers;
}

} // namespace

std::vector<std::string> picture_overrides_of(const RenderOptions& options) {
  std::vector<std::string> overrides = overrides_of(options);
  if (!options.size.empty()) {
    const auto size = whole_numbers(options.size, 'x', 2, "--size: expected WIDTHxHEIGHT, for example 640x480");
    if (size[0] < 1 || size[1] < 1)
      throw Error(ErrorKind::usage,
                  "--size: expected a width and height of at least 1, found \"" + options.size + "\"");
    overrides.push_back("render.size=[" + std::to_string(size[0]) + ", " + std::to_string(size[1]) + "]");
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

/// Everything that can be refused is refused here, before the work and not after it.
api::Scene checked_scene(const RenderOptions& options) {
  if (options.integrator != "path" && !options.paths.empty())
    throw Error(ErrorKind::usage, "--paths: only --integrator path can choose the light paths that count");
  light_paths(options.paths, {}); // before a large scene is read
  api::Scene checked = api::Scene::from_file(options.input, picture_overrides_of(options));
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

/// Renders and writes the picture; false when it was interrupted before a row was finished, which leaves an older
/// picture alone.
bool render_picture(api::Context::Parts& context, api::FilmJob& job, PictureWriter& writer, const RunControl& control,
                    RenderTotals& totals) {
  totals = job.render([&](const Band& band) { writer.write(band); });
  for (const auto& [name, time] : context.session.kernel_times())
    spdlog::debug("kernel {}: {} launches, {:.3f} s", name, time.launches, time.seconds);
  if (totals.interrupted && totals.rows_done == 0) return false;
  const double render_seconds = context.stages.records().back().seconds;
  const RunControl to_the_end{{}, control.progress, control.log}; // what is there is kept
  const RunScope scope(to_the_end);
  context.stages.start("image");
  writer.finish(render_seconds);
  const PixelWindow& w = job.window();
  context.stages.finish(static_cast<std::uint64_t>(w.x1 - w.x0) * (w.y1 - w.y0), "pixels");
  return true;
}

void write_reports(const RenderOptions& options, const api::Light::Parts& light, const RenderTotals& totals) {
  const api::Prepared::Parts& prepared = *light.prepared;
  const api::Context::Parts& context = *prepared.context;
  if (!options.stats_file.empty()) {
    Stats stats = stats_of(light);
    stats.command = "render";
    stats.integrator = options.integrator;
    stats.render = totals;
    stats.photons = light.light.ledger;
    const Frame& frame = prepared.ready.frame;
    stats.photon_watts = prepared.ready.lighting.radiance.scale * frame.side * frame.side;
    write_stats(options.stats_file, stats, context.stages);
  }
  if (!options.trace_file.empty())
    write_text(options.trace_file, context.stages.chrome_trace(context.session.launches()));
}

} // namespace

ExitCode run_render(const RenderOptions& options) {
  CommandRun run(options.quiet);
  StageLog stages;
  stages.start("scene");
  const api::Scene scene = checked_scene(options);
  const Scene description = scene.parts()->description();
  api::FilmOptions film;
  film.window = window_of(options, description.render);
  film.paths = options.paths;
  stages.finish(description.clouds.size() + description.shapes.size(), "objects");

  const api::Context context = open_context(options, std::move(stages), run.control());
  api::Context::Parts& device = *context.parts();
  device.session.dump_kernels_to(options.dump_folder);
  if (!options.trace_file.empty()) device.session.record_launches();
  const api::Prepared prepared(context, scene, run.control());
  const api::Light light(prepared, {true, options.integrator == "path"}, run.control());
  api::FilmJob job(*light.parts(), film);
  PictureWriter writer(output_of(options), description.render.width, description.render.height, job.window(),
                       job.channels(), job.attributes(),
                       description.render.auto_exposure ? std::nullopt
                                                        : std::optional<double>(description.render.exposure));
  RenderTotals totals;
  if (!render_picture(device, job, writer, run.control(), totals))
    throw Error(ErrorKind::interrupted, "interrupted before the first rows were finished; nothing was written");
  const PngLight& shown = writer.png_light();
  if (description.render.auto_exposure)
    spdlog::info("exposure chosen: {:.2f} stops (--exposure={:.2f} gives the same)", shown.exposure, shown.exposure);
  job.warn(totals);
  if (!totals.interrupted) warn_of_exposure(shown, prepared.parts()->scene, prepared.parts()->ready);
  write_reports(options, *light.parts(), totals);
  run.end_progress();
  std::printf("%s\n%s\n", writer.exr_path().c_str(), writer.png_path().c_str());
  if (totals.interrupted) {
    spdlog::warn("interrupted: the picture holds its first {} of {} rows", totals.rows_done,
                 job.window().y1 - job.window().y0);
    return ExitCode::interrupted;
  }
  spdlog::info("{} splats, {:.1f} million rays, {} ({} of kernels on the device)", prepared.size(),
               1e-6 * static_cast<double>(totals.rays), duration_text(device.stages.seconds()),
               duration_text(kernel_seconds(device.session)));
  return ExitCode::done;
}

} // namespace pointgi
