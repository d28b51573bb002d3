#include "host/app/make_picture.h"
#include "host/available_memory.h"
#include "host/cl/resource_error.h"
#include "host/render/tile_renderer.h"
#include "host/run.h"
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <spdlog/spdlog.h>

namespace pointgi {

namespace {

std::unique_ptr<api::Light> light_of(const PictureRun& run, const RunControl& control) {
  return std::make_unique<api::Light>(run.prepared, api::LightOptions{true, run.by_paths}, control);
}

/// Of the preview: --time's share, or as much as nobody minds [s].
constexpr double share_of_preview = 0.04, usual_preview = 1.0;

std::string told_of(const GrownPicture& grown, const PictureGoal& goal) {
  if (!goal.is_open()) return {};
  std::string text = fmt::format("{} samples a pixel", grown.samples);
  if (!std::isfinite(grown.noise)) return text;
  const double noise = goal.noise.noise(grown.noise * grown.samples, grown.samples), all = goal.light_error + noise;
  text += goal.light_error_known ? fmt::format(", relMSE about {:.2g}, of which {:.2g} is noise", all, noise)
                                 : fmt::format(", relMSE of the noise about {:.2g}", noise);
  if (goal.error && all > *goal.error) text += fmt::format("; {:.3g} was not reached", *goal.error);
  return text;
}

/// Of a picture that is to be denoised, and what that takes besides.
double denoise_bytes(double pixels) {
  const std::size_t channels = film_channels(true, true, true, true).size() + noisy_channels().size();
  return pixels * static_cast<double>((channels + denoise_scalars) * sizeof(float));
}

/// Before a picture is rendered that cannot be denoised.
void require_denoise_memory(double pixels) {
  const std::uint64_t available = available_memory().value_or(std::numeric_limits<std::uint64_t>::max());
  if (denoise_bytes(pixels) <= static_cast<double>(available)) return;
  throw Error(
      ErrorKind::memory,
      fmt::format("--denoise holds the whole picture, {} in memory, of which {} are available; leave it out, or "
                  "set a smaller --size",
                  megabytes(static_cast<std::uint64_t>(denoise_bytes(pixels))), megabytes(available)));
}

std::uint64_t film_bytes(const api::Prepared& prepared, double pixels, bool has_open_goal, bool denoised) {
  const bool specular = prepared.parts()->ready.lighting.has_specular();
  const bool photons = specular && prepared.parts()->scene.caustics.photons > 0;
  const double films = has_open_goal ? 2.0 : 1.0;
  return static_cast<std::uint64_t>(films * pixels *
                                        static_cast<double>(film_scalars(specular, photons, denoised) * sizeof(float)) +
                                    (denoised ? denoise_bytes(pixels) : 0.0));
}

/// Before an older picture is replaced by a preview of one that cannot be made.
void require_film_memory(const PictureRun& run, bool has_open_goal) {
  const bool denoised = run.film.auxiliary;
  if (film_fits(run.prepared, run.pixels, has_open_goal, denoised)) return;
  throw Error(ErrorKind::memory,
              fmt::format("a picture that gets better keeps a film of {} in memory, of which {} are available; leave "
                          "out --time, --error and --progressive, or set a smaller --size",
                          megabytes(film_bytes(run.prepared, run.pixels, has_open_goal, denoised)),
                          megabytes(available_memory().value_or(0))));
}

} // namespace

bool film_fits(const api::Prepared& prepared, double pixels, bool has_open_goal, bool denoised) {
  return film_bytes(prepared, pixels, has_open_goal, denoised) <=
         available_memory().value_or(std::numeric_limits<std::uint64_t>::max());
}

MadePictureFiles make_picture_at_once(const PictureRun& run, PictureOutput& output) {
  api::Context::Parts& context = *run.context.parts();
  MadePictureFiles made;
  const CheckpointScope checkpoint(run.checkpoint);
  if (output.denoises()) require_denoise_memory(run.pixels);
  made.light = light_of(run, run.control);
  api::FilmJob job(*made.light->parts(), run.film);
  output.begin(job);
  made.totals = job.render([&](const Band& band) { output.take(band); });
  made.interrupted = made.totals.interrupted;
  if (made.interrupted && made.totals.rows_done == 0)
    throw Error(ErrorKind::interrupted, "interrupted before the first rows were finished; nothing was written");
  const double render_seconds = context.stages.records().back().seconds;
  const RunControl to_the_end{{}, run.control.progress, run.control.log}; // what is there is kept
  const RunScope scope(to_the_end);
  denoise_in_stage(context.stages, job.window(), output);
  context.stages.start("image");
  output.finish(render_seconds);
  const PixelWindow& w = job.window();
  context.stages.finish(static_cast<std::uint64_t>(w.x1 - w.x0) * (w.y1 - w.y0), "pixels");
  job.warn(made.totals);
  made.told = made.interrupted
                  ? fmt::format("the picture holds its first {} of {} rows", made.totals.rows_done, w.y1 - w.y0)
                  : "";
  return made;
}

MadePictureFiles make_growing_picture(const PictureRun& run, PictureGoal goal, const BeforeLight& before_light,
                                      PictureOutput& output) {
  MadePictureFiles made;
  const StageLog& stages = run.context.parts()->stages;
  const auto user_stops = [&] { return run.control.stop && run.control.stop(); };
  RunControl in_time = run.control;
  in_time.stop = [&] { return user_stops() || (goal.until && stages.seconds() > *goal.until); };
  try {
    require_film_memory(run, goal.is_open());
    api::require_memory(run.prepared, {true, run.by_paths}); // or an older picture would be lost to a first one
    PreviewCost cost;
    if (!run.by_paths) {
      const double seconds = goal.until ? share_of_preview * *goal.until : usual_preview;
      cost = write_preview(run.context, run.prepared, run.film, seconds, output, run.control);
      if (goal.seconds_a_sample == 0.0) goal.seconds_a_sample = cost.seconds_a_sample;
    }
    if (before_light) before_light(goal, cost);
    const CheckpointScope checkpoint(run.checkpoint);
    made.light = light_of(run, in_time);
    api::FilmJob job(*made.light->parts(), run.film);
    const GrownPicture grown = grow_picture(*run.context.parts(), job, goal, output, run.control);
    made.totals = grown.totals;
    made.interrupted = grown.totals.interrupted;
    if (grown.samples > 0) {
      job.warn(grown.totals);
      made.told =
          made.interrupted ? fmt::format("the picture has {} samples a pixel", grown.samples) : told_of(grown, goal);
      return made;
    }
    if (!output.written()) throw interruption();
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::interrupted && output.written())
      spdlog::warn("{} is a first picture, with little of the light between surfaces", output.exr_path());
    if (error.kind() != ErrorKind::interrupted || !output.written()) throw;
  }
  made.light.reset();
  made.interrupted = user_stops();
  made.told = output.exr_path() + " is a first picture, with little of the light between surfaces" +
              (made.interrupted ? "" : ": the time was over before the light was solved");
  return made;
}

} // namespace pointgi
