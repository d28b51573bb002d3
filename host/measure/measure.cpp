#include "host/measure/measure.h"
#include "host/cache/binary_cache.h"
#include "host/image/exposure.h"
#include "host/image/png_writer.h"
#include "host/measure/intervals.h"
#include "host/measure/kept_errors.h"
#include "host/measure/make_reference.h"
#include "host/measure/search.h"
#include "host/output_folder.h"
#include "host/run.h"
#include "host/scene/input_files.h"
#include "octree/clock.h"
#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <fstream>

namespace pointgi {

namespace {

namespace fs = std::filesystem;

/// Of the budget. What is begun is stopped before the end is later than that.
constexpr double reference_share = 1.0 / 3.0, warm_share = 0.05, latest_end = 1.05;

/// More than a run has repetitions: the reference's seeds come after theirs.
constexpr unsigned seeds_of_runs = 1000;

/// Photons that are enough to run their kernels.
constexpr int most_to_load = 10000;

/// What is found is kept at least this often [s].
constexpr double save_interval = 5.0;

std::string today() {
  const std::time_t now = std::time(nullptr);
  char text[16];
  std::strftime(text, sizeof text, "%Y-%m-%d", std::gmtime(&now));
  return text;
}

void write_png(const Picture& picture, const std::string& path, double stops) {
  PngWriter writer(path, picture.width, picture.height);
  const auto scale = static_cast<float>(std::exp2(stops));
  const auto columns = static_cast<std::size_t>(picture.width);
  std::vector<std::uint8_t> row(3 * columns);
  for (std::size_t y = 0; y < static_cast<std::size_t>(picture.height); ++y) {
    for (std::size_t i = 0; i < row.size(); ++i)
      row[i] = display_byte(picture.channels.at(Reference::colours[i % 3])[y * columns + i / 3], scale);
    writer.write_row(row.data());
  }
  writer.close();
  writer.commit();
}

/// One exposure for all pictures, so that they can be compared by eye.
double exposure_for(const RenderSettings& render, const Picture& picture) {
  if (!render.auto_exposure) return render.exposure;
  ExposureMeter meter;
  const auto at = [&](const char* name, std::size_t i) {
    const auto channel = picture.channels.find(name);
    return channel == picture.channels.end() ? 0.0f : channel->second[i];
  };
  for (std::size_t i = 0; i < picture.channels.at("R").size(); ++i)
    meter.add({at("R", i), at("G", i), at("B", i)}, at("A", i),
              {at("Albedo.R", i), at("Albedo.G", i), at("Albedo.B", i)});
  return meter.stops();
}

/// The mean of what is known of `count` pictures and of one more.
void add_to_mean(double& mean, double one, std::size_t count) {
  if (count == 0)
    mean = one;
  else
    mean += (one - mean) / static_cast<double>(count + 1);
}

class Measurement {
public:
  Measurement(const api::Context& context, const MeasureOptions& options, const RunControl& run,
              const std::function<void(const Trade&)>& save)
      : options_(options), run_(run), save_(save),
        maker_(context, options.scene, options.overrides), inner_{[this] { return stop_now(); },
                                                                  [this](const StageProgress&) { tell_progress(); },
                                                                  {}} {
    trade_.version = POINTGI_VERSION;
    trade_.scene = options.scene;
    trade_.device = context.device();
    trade_.overrides = options.overrides;
    trade_.state = state_of(options);
    trade_.date = today();
    trade_.budget_seconds = options.budget;
  }

  Measured measure() {
    if (run_.progress) run_.progress({"measure", std::nullopt, {}});
    take_over_earlier();
    const bool resumed = !trade_.runs.empty();
    find_reference();
    const Reference reference = made_.reference();
    reference_ = &reference;
    trade_.reference.own_noise = reference.own_noise();
    exposure_ = exposure_for(maker_.scene(inner_).render, made_.shown);
    trade_.reference.picture = std::string(pictures_name) + "/reference.png";
    write_png(reference.mean(), path_of(trade_.reference.picture), exposure_);
    bool whole = true;
    if (!resumed) whole = first_run();
    if (whole) whole = search(trade_, knobs(), world());
    if (whole) whole = measure_warm();
    if (trade_.runs.empty()) throw Error(ErrorKind::interrupted, "interrupted before a picture was measured");
    mark_front(trade_);
    save();
    return {std::move(trade_), !whole};
  }

private:
  double elapsed() const { return seconds_since(options_.begun); }
  double left() const { return options_.budget - elapsed(); }
  /// Of each run's repetition. A scene of another render.seed has none of these: 2^32 over the golden ratio, whose
  /// multiples come near each other late.
  unsigned seed_of(std::size_t repeat) const {
    return maker_.first_seed() + static_cast<unsigned>(repeat) * 2654435769u;
  }
  unsigned first_seed() const { return seed_of(0); }
  bool user_stops() const { return run_.stop && run_.stop(); }
  bool stop_now() const { return user_stops() || elapsed() > stop_at_; }

  void tell_progress() const {
    if (run_.progress) run_.progress({"measure", std::min(1.0, elapsed() / options_.budget), {}});
  }

  std::string path_of(const std::string& name) const { return file_in(options_.folder, name); }

  void save() {
    trade_.spent_seconds = elapsed();
    set_time_intervals(trade_);
    keep_errors(errors_, trade_, path_of(kept_errors_name)); // before the runs that count on it
    save_(trade_);
    saved_at_ = elapsed();
  }

  /// Runs of the folder's trade.json, where they are of the same scene, program, device and size.
  void take_over_earlier() {
    std::error_code ignored;
    const std::string path = path_of(trade_json_name);
    if (!fs::exists(path, ignored)) return;
    Trade earlier;
    try {
      earlier = read_trade(path);
    } catch (const Error& error) { // of an older program, or damaged
      log_info("{}; it is replaced", error.what());
      return;
    }
    const bool same = earlier.version == trade_.version && earlier.scene == trade_.scene &&
                      earlier.device == trade_.device && earlier.overrides == trade_.overrides &&
                      earlier.state == trade_.state && !earlier.runs.empty() && earlier.runs.front().name == own_name &&
                      (!options_.size || *options_.size == std::pair(earlier.width, earlier.height));
    if (!same) {
      log_info("what {} holds is of another scene, device, size or version, and is replaced", path);
      return;
    }
    const auto refused = [](const MeasuredRun& one) { return !one.refused.empty(); }; // may have time enough now
    earlier.runs.erase(std::remove_if(earlier.runs.begin(), earlier.runs.end(), refused), earlier.runs.end());
    errors_ = kept_errors(path_of(kept_errors_name), earlier);
    if (errors_.count(own_name) == 0) {
      log_info("{} is not there or damaged, without which {} cannot be gone on with; both are replaced",
               path_of(kept_errors_name), path);
      errors_.clear();
      return;
    }
    std::optional<MadeReference> made;
    if (options_.reference_file.empty()) {
      made = kept_reference(options_.folder, earlier.width, earlier.height);
      if (!made) {
        errors_.clear(); // of a reference that is made anew
        return;
      }
      made->source = earlier.reference.source;
      made->seconds = earlier.reference.seconds;
      made_ = std::move(*made);
    }
    trade_.width = earlier.width;
    trade_.height = earlier.height;
    for (MeasuredRun& one : earlier.runs)
      if (errors_.count(one.name) == 1) trade_.runs.push_back(std::move(one));
    trade_.knobs = std::move(earlier.knobs);
    log_info("{} runs of {} are taken over", trade_.runs.size(), path);
  }

  /// Reference and own setting are needed for any result: building kernels may take a budget that is small, and then as
  /// much again is given to them.
  void let_begin() { stop_at_ = elapsed() + options_.budget; }

  void find_reference() {
    let_begin();
    std::optional<std::pair<int, int>> size = options_.size;
    if (!options_.reference_file.empty()) {
      made_ = read_reference(options_.reference_file, size);
      size = {made_.first.width, made_.first.height};
    }
    const RenderSettings& render = maker_.scene(inner_).render;
    trade_.prepare_seconds = maker_.prepare_seconds();
    if (trade_.width > 0) size = {trade_.width, trade_.height};
    if (!size) size = chosen_size(render.width, render.height);
    maker_.set_size(size->first, size->second);
    trade_.width = size->first;
    trade_.height = size->second;
    trade_.full_width = render.width;
    trade_.full_height = render.height;
    if (made_.first.channels.empty()) {
      maker_.trace(1, first_seed(), inner_); // builds the kernels
      const double most = std::min(reference_share * options_.budget, 0.5 * left());
      let_begin();
      made_ = trace_reference(
          maker_, most, [this](unsigned traced) { return seed_of(seeds_of_runs + traced); },
          [this] { return elapsed(); }, inner_);
      if (user_stops()) throw Error(ErrorKind::interrupted, "interrupted while the reference was made");
      // Runs of another reference must not be gone on with.
      for (const char* name : {trade_json_name, kept_errors_name})
        fs::remove(path_of(name));
      keep_reference(made_, options_.folder);
    }
    trade_.reference.source = made_.source;
    trade_.reference.seconds = made_.seconds;
    trade_.reference.file = options_.reference_file;
  }

  std::pair<int, int> chosen_size(int width, int height) {
    const auto [columns, rows] = size_to_measure(width, height, 1e9, 1.0); // the smallest
    maker_.set_size(columns, rows);
    maker_.trace(1, first_seed(), inner_); // builds the kernels
    const double pace = maker_.trace(1, seed_of(1), inner_).seconds;
    return size_to_measure(width, height, pace, reference_share * options_.budget);
  }

  /// The scene's own setting, which tells what light there is, and so which knobs there are.
  bool first_run() {
    load_kernels();
    MeasuredRun own;
    own.name = own_name;
    const bool whole = measure_once(own, left());
    if (whole && !own.refused.empty())
      throw Error(ErrorKind::input, options_.scene + ": its own setting gives no picture to measure: " + own.refused +
                                        "; give more time by --budget, or a cheaper setting by --set");
    if (whole) trade_.runs.push_back(own);
    return whole;
  }

  /// A picture by little of everything, which runs most kernels for the first time: the scene's own setting may be
  /// dear, and would have to be measured twice.
  void load_kernels() {
    const Scene& scene = maker_.scene(inner_);
    std::vector<std::string> little{"radiosity.tolerance=0.1"};
    if (scene.radiosity.method == "auto") { // both by as much, or it would choose another one
      little.push_back("radiosity.method=auto");
      little.push_back(fmt::format("radiosity.directions={}", std::max(1, scene.radiosity.directions / 8)));
      little.push_back(fmt::format("radiosity.epsilon={:g}", std::min(0.5, 4.0 * scene.radiosity.epsilon)));
    }
    if (scene.caustics.photons > most_to_load) little.push_back(fmt::format("caustics.photons={}", most_to_load));
    let_begin();
    try {
      maker_.make(little, first_seed(), inner_);
    } catch (const Error&) { // the scene's own setting will say it
      if (user_stops()) throw;
    }
  }

  std::vector<Knob>& knobs() {
    const std::string& method = trade_.runs.front().setting.method;
    knobs_ = knobs_of({maker_.scene(inner_), method, maker_.points(inner_)});
    if (!options_.knobs.empty())
      knobs_.erase(std::remove_if(knobs_.begin(), knobs_.end(),
                                  [&](const Knob& knob) {
                                    return std::find(options_.knobs.begin(), options_.knobs.end(), knob.name) ==
                                           options_.knobs.end();
                                  }),
                   knobs_.end());
    return knobs_;
  }

  /// Once more with a kept visibility map, the scene's own setting and the front, where it took much of their time.
  /// False where the user stops it.
  bool measure_warm() {
    constexpr double much = 0.1;
    mark_front(trade_);
    for (MeasuredRun& run : trade_.runs) {
      const auto vmap = run.stages.find("vmap");
      if (run.warm_seconds > 0.0 || !(run.on_front || run.name == own_name) || vmap == run.stages.end() ||
          vmap->second < much * run.seconds.value || 2.0 * run.seconds.value > warm_until() - elapsed())
        continue;
      stop_at_ = warm_until();
      try {
        run.warm_seconds = maker_.make_warm(run.setting.overrides, first_seed(), inner_).seconds;
      } catch (const Error&) {
        if (user_stops()) return false;
        return true; // the time is over
      }
      tell_progress();
    }
    return true;
  }
  double warm_until() const { return latest_end * options_.budget; }

  SearchWorld world() {
    return {[this](MeasuredRun& run, double most) { return measure_once(run, most); },
            [this] { return left() - warm_share * options_.budget; },
            [this](const MeasuredRun& run) { return maker_.kept_seconds(run.setting.overrides, first_seed()); },
            [this](const MeasuredRun& before, const MeasuredRun& after) {
              return errors_.at(after.name).change_from(errors_.at(before.name));
            }};
  }

  bool measure_once(MeasuredRun& run, double most) {
    const double begun = elapsed();
    if (run.name == own_name && run.repeats.empty())
      let_begin();
    else
      stop_at_ = std::min(begun + std::max(most, 0.0), latest_end * options_.budget);
    try {
      const auto seed = seed_of(run.repeats.size());
      MadePicture made = maker_.make(run.setting.overrides, seed, inner_);
      if (made.compiled) {
        stop_at_ = std::max(stop_at_, std::min(stop_at_ + (elapsed() - begun), latest_end * options_.budget));
        made = maker_.make(run.setting.overrides, seed, inner_);
      }
      add(run, made);
    } catch (const Error& error) {
      if (user_stops()) return false;
      if (!run.repeats.empty()) return true; // what is known of it stays
      if (error.kind() == ErrorKind::interrupted)
        run.refused =
            fmt::format("was stopped after {:.0f} s, which are all that the budget has for it", elapsed() - begun);
      else
        run.refused = error.what();
    }
    tell_progress();
    if (elapsed() - saved_at_ > save_interval && !trade_.runs.empty()) save();
    return true;
  }

  /// False where the error is no number.
  bool add_error(MeasuredRun& run, const Picture& picture) {
    const auto before = errors_.find(run.name);
    ErrorOfRepeats all = before != errors_.end() ? before->second : ErrorOfRepeats();
    all.add(reference_->errors(picture), picture.width, picture.height, reference_->deviation(picture));
    const Estimate error = all.estimate();
    if (!std::isfinite(error.value)) return false;
    run.error = error;
    errors_[run.name] = std::move(all);
    return true;
  }

  void add(MeasuredRun& run, const MadePicture& made) {
    const std::size_t count = run.repeats.size();
    if (!add_error(run, made.picture)) {
      run.refused = "its picture holds values that are not finite";
      return;
    }
    const Difference off = difference(made.picture, run.name, reference_->mean(), "reference").all;
    add_to_mean(run.noise, reference_->noise(made.picture), count);
    add_to_mean(run.bias, off.bias, count);
    add_to_mean(run.ssim, off.ssim, count);
    if (count == 0) {
      run.setting.method = made.method;
      run.samples = made.samples;
      run.picture = std::string(pictures_name) + "/" + run.name + ".png";
      write_png(made.picture, path_of(run.picture), exposure_);
    }
    run.repeats.push_back(made.seconds);
    const double before = run.seconds.value;
    run.seconds = estimate_of_repeats(run.repeats);
    // The stages of the repetition nearest to the median, scaled to it.
    double of_stages = before;
    if (count == 0 || std::fabs(made.seconds - run.seconds.value) <= std::fabs(before - run.seconds.value)) {
      run.stages = made.stages;
      of_stages = made.seconds;
    }
    for (auto& [stage, seconds] : run.stages)
      seconds *= run.seconds.value / of_stages;
    run.memory_bytes = std::max(run.memory_bytes, made.memory_bytes);
  }

  const MeasureOptions& options_;
  const RunControl& run_;
  const std::function<void(const Trade&)>& save_;
  PictureMaker maker_;
  RunControl inner_; ///< of the pictures: it ends with the time that they have, and says nothing
  double stop_at_ = 1e300;
  double saved_at_ = 0.0;
  double exposure_ = 0.0;
  Trade trade_;
  MadeReference made_;
  const Reference* reference_ = nullptr;
  ErrorsOfRuns errors_;
  std::vector<Knob> knobs_;
};

} // namespace

Measured measure(const api::Context& context, const MeasureOptions& options, const RunControl& run,
                 const std::function<void(const Trade&)>& save) {
  const RunScope scope(run);
  return Measurement(context, options, run, save).measure();
}

std::string state_of(const MeasureOptions& options) {
  std::string text;
  const auto add_file = [&](const std::string& name) {
    std::error_code failed;
    const std::string path = fs::weakly_canonical(name, failed).string(); // wherever the command is called
    const auto size = fs::file_size(path, failed);
    const auto time = fs::last_write_time(path, failed).time_since_epoch().count();
    text += fmt::format("{} {} {}\n", path, failed ? 0 : size, failed ? 0 : time);
  };
  add_file(options.scene);
  for (const std::string& file :
       input_files(api::Scene::from_file(options.scene, options.overrides).parts()->description()))
    add_file(file);
  if (!options.reference_file.empty()) add_file(options.reference_file);
  for (const std::string& one : options.overrides)
    text += one + "\n";
  return fmt::format("{:016x}", fnv1a(text));
}

} // namespace pointgi
