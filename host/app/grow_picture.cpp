#include "host/app/grow_picture.h"
#include "host/run.h"
#include "host/scene/limits.h"
#include <algorithm>
#include <cmath>
#include <limits>

namespace pointgi {

namespace {

constexpr int pass = GRID_RAYS;
const int most_samples = static_cast<int>(limits::spp.high);

/// A picture between is written where that takes at most this share of the time since the last.
constexpr double share_of_writing = 0.1;

/// As far as passes go on bit for bit: whole ones, but for the first when it is less than one.
int whole_passes(double samples) {
  if (samples < pass) return static_cast<int>(samples);
  return static_cast<int>(std::min<double>(samples, most_samples)) / pass * pass;
}

double needed_samples(const PictureGoal& goal, int now, double noise) {
  // Where the light alone has more error than that, noise need not be small beside what was asked for.
  constexpr double share_of_noise = 0.25;
  const double allowed = std::max(*goal.error - goal.light_error, share_of_noise * *goal.error);
  const double of_one = now == 0 ? goal.noise_a_sample : noise * now;
  if (!std::isfinite(of_one)) return 2.0 * now;
  return std::ceil(goal.noise.samples(of_one, allowed));
}

} // namespace

int next_samples(const PictureGoal& goal, int now, double left, double noise) {
  if (!goal.is_open()) return std::min(goal.samples, now == 0 ? pass : 2 * now);
  if (goal.until && now == 0 && !(goal.seconds_a_sample > 0.0)) return 1; // shows the pace
  const bool anew = now % pass != 0;                                      // what is less than a pass does not go on
  double wanted = most_samples;
  if (goal.error) {
    const double needed = needed_samples(goal, now, noise);
    if (needed <= now && now > 0) return now;
    // A forecast of the noise may be off; what was measured is not.
    wanted = needed < pass ? std::max(1.0, needed) : pass * std::ceil(needed / pass);
  }
  wanted = std::min<double>(wanted, std::max(2 * now, pass));
  if (!goal.until) return std::max(now, whole_passes(wanted));
  const double affordable = (anew ? 0 : now) + std::max(0.0, left) / goal.seconds_a_sample;
  if (anew && affordable < 2.0 * now) return now; // little better, for all of the time that is left
  if (affordable >= wanted) return std::max(now, whole_passes(wanted));
  if (now == 0) return std::max(1, affordable < 2 * pass ? static_cast<int>(affordable) : whole_passes(affordable));
  return static_cast<int>(affordable); // the last pass
}

double relative_noise(const GrowingFilm& film, const std::vector<ChannelName>& channels) {
  const auto place_of = [&](const std::string& name) {
    const auto at = std::find_if(channels.begin(), channels.end(), [&](const auto& c) { return c.name == name; });
    return static_cast<std::size_t>(at - channels.begin());
  };
  const std::pair<std::size_t, std::size_t> values_and_variances[] = {{place_of("R"), place_of("Variance.R")},
                                                                      {place_of("G"), place_of("Variance.G")},
                                                                      {place_of("B"), place_of("Variance.B")}};
  constexpr double part_of_mean = 0.01; // as relMSE has it (host/image/difference.h)
  double sum = 0.0, values = 0.0;
  film.resolve([&](const Band& band) {
    for (const auto& [colour, variance] : values_and_variances)
      for (const float value : band.values[colour])
        sum += value, values += 1.0;
  });
  const double mean = sum / std::max(1.0, values), eps = mean > 0.0 ? part_of_mean * mean * mean : part_of_mean;
  double noise = 0.0;
  film.resolve([&](const Band& band) {
    for (const auto& [colour, variance] : values_and_variances)
      for (std::size_t i = 0; i < band.values[colour].size(); ++i)
        noise += band.values[variance][i] / (double{band.values[colour][i]} * band.values[colour][i] + eps);
  });
  return noise / std::max(1.0, values);
}

namespace {

/// The film, its samples and what they cost.
class Growth {
public:
  Growth(api::Context::Parts& context, api::FilmJob& job, PictureGoal goal, PictureOutput& output,
         const RunControl& control)
      : context_(context), job_(job), goal_(goal), output_(output), control_(control),
        film_(std::make_unique<GrowingFilm>(job.growing())) {}

  GrownPicture run() {
    context_.stages.start("render");
    film_->load_kernels();
    if (!goal_.is_open()) film_->go_on_from_checkpoint();
    double noise = std::numeric_limits<double>::infinity();
    for (int now = static_cast<int>(film_->samples()); !stop_asked();) {
      const int next = next_samples(goal_, now, left(), noise);
      if (next <= now || !grow(now, next)) break; // enough, interrupted, or the time is over
      now = next;
      if (goal_.error) noise = relative_noise(*film_, job_.channels());
      if (worth_writing(next)) write();
    }
    const RenderTotals totals = film_->resolve([](const Band&) {});
    context_.stages.finish(totals.rays, "rays", totals.device_seconds);
    return last(totals);
  }

private:
  double now_seconds() const { return context_.stages.seconds(); }
  double left() const {
    return goal_.until ? *goal_.until - now_seconds() - output_.seconds_to_write() : std::numeric_limits<double>::max();
  }

  /// False where it was stopped. Of less than a pass nothing is kept: its samples lie otherwise in the pixel than those
  /// of a whole one.
  bool grow(int from, int to) {
    const bool anew = from % pass != 0;
    std::unique_ptr<GrowingFilm> film = anew ? std::make_unique<GrowingFilm>(job_.growing()) : std::move(film_);
    // The first picture is finished whatever it takes: without it there would be none with all of the light.
    const auto stop = [&] { return stop_asked() || (from > 0 && left() < 0.0); };
    const int before = anew ? 0 : from;
    const double begun = now_seconds();
    film->grow(
        static_cast<pg_uint>(to), [&](double share) { report_progress(overall(before + share * (to - before))); },
        stop);
    const bool whole = static_cast<int>(film->samples()) == to;
    if (whole) goal_.seconds_a_sample = (now_seconds() - begun) / (to - before);
    if (whole || !anew) film_ = std::move(film);
    return whole;
  }

  /// Share of the whole, as far as it is known.
  double overall(double samples) const {
    if (goal_.until) return std::min(1.0, now_seconds() / *goal_.until);
    return std::min(1.0, samples / std::max(1, goal_.samples));
  }

  bool worth_writing(int samples) const {
    const bool last = !goal_.is_open() && samples >= goal_.samples;
    return !last &&
           (!output_.written() || output_.seconds_to_write() < share_of_writing * (now_seconds() - written_at_));
  }

  void write() {
    job_.set_samples(static_cast<int>(film_->samples()));
    output_.write(job_, *film_, now_seconds());
    written_at_ = now_seconds();
    written_samples_ = film_->samples();
  }

  GrownPicture last(const RenderTotals& totals) {
    GrownPicture grown;
    grown.totals = totals;
    grown.totals.interrupted = stop_asked();
    grown.samples = static_cast<int>(film_->samples());
    grown.noise = relative_noise(*film_, job_.channels());
    if (grown.samples == 0) return grown;
    const RunControl to_the_end{{}, control_.progress, control_.log}; // what is there is kept
    const RunScope scope(to_the_end);
    const bool to_write = written_samples_ != film_->samples() || grown.totals.interrupted;
    if (to_write) {
      job_.set_samples(grown.samples);
      output_.begin(job_);
      film_->resolve([&](const Band& band) { output_.take(band); });
      denoise_in_stage(context_.stages, job_.window(), output_);
    } else if (output_.denoised()) {
      context_.stages.skip("denoise", "the stage render wrote the last picture, denoised");
    }
    context_.stages.start("image");
    if (to_write) output_.finish(now_seconds());
    const PixelWindow& w = job_.window();
    context_.stages.finish(static_cast<std::uint64_t>(w.x1 - w.x0) * (w.y1 - w.y0), "pixels");
    return grown;
  }

  api::Context::Parts& context_;
  api::FilmJob& job_;
  PictureGoal goal_;
  PictureOutput& output_;
  const RunControl& control_;
  std::unique_ptr<GrowingFilm> film_;
  double written_at_ = 0.0;
  pg_uint written_samples_ = 0; ///< of the picture that was written last; a preview has none
};

} // namespace

void denoise_in_stage(StageLog& stages, const PixelWindow& window, PictureOutput& output) {
  if (!output.denoises()) return;
  stages.start("denoise");
  output.denoise([](double share) { report_progress(share); });
  stages.finish(static_cast<std::uint64_t>(window.x1 - window.x0) * (window.y1 - window.y0), "pixels");
}

GrownPicture grow_picture(api::Context::Parts& context, api::FilmJob& job, const PictureGoal& goal,
                          PictureOutput& output, const RunControl& control) {
  return Growth(context, job, goal, output, control).run();
}

} // namespace pointgi
