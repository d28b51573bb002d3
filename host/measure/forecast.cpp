#include "host/measure/forecast.h"
#include "host/scene/limits.h"
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace pointgi {

namespace {

constexpr const char* samples_text = "render.spp=";

/// The stage that takes time for each sample.
constexpr const char* picture_stage = "render";

std::vector<std::string> light_overrides(const MeasuredRun& run) {
  std::vector<std::string> all;
  for (const std::string& text : run.setting.overrides)
    if (text.rfind(samples_text, 0) != 0) all.push_back(text);
  return all;
}

using Group = std::vector<const MeasuredRun*>;

/// Runs that differ in their samples alone, of few samples first.
std::vector<Group> groups_of(const Trade& trade) {
  std::map<std::vector<std::string>, Group> by_light;
  for (const MeasuredRun& run : trade.runs)
    if (run.refused.empty() && !run.repeats.empty()) by_light[light_overrides(run)].push_back(&run);
  std::vector<Group> groups;
  for (auto& [overrides, group] : by_light) {
    std::stable_sort(group.begin(), group.end(), [](const auto* a, const auto* b) { return a->samples < b->samples; });
    groups.push_back(std::move(group));
  }
  return groups;
}

double picture_seconds(const MeasuredRun& run) {
  const auto stage = run.stages.find(picture_stage);
  return stage == run.stages.end() ? 0.0 : stage->second;
}

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// What the variances of a group's pictures tell of one sample; absent: nothing, as of single samples.
std::optional<double> noise_of_one(const Group& group) {
  std::vector<double> noises;
  for (const MeasuredRun* run : group)
    if (std::isfinite(run->noise)) noises.push_back(run->noise * run->samples);
  return noises.empty() ? std::nullopt : std::optional(median_of(noises));
}

/// By how much a group's errors are off, relative, from those of the model and of the light that fits best; squared.
double misfit(const Group& group, double of_one, const NoiseModel& model) {
  double sum = 0.0, weights = 0.0, squares = 0.0;
  const auto weight_of = [](const MeasuredRun& run) { return 1.0 / (run.error.value * run.error.value); };
  const auto rest_of = [&](const MeasuredRun& run) { return run.error.value - model.noise(of_one, run.samples); };
  for (const MeasuredRun* run : group) {
    sum += weight_of(*run) * rest_of(*run);
    weights += weight_of(*run);
  }
  const double light = std::max(0.0, sum / weights);
  for (const MeasuredRun* run : group)
    squares += weight_of(*run) * std::pow(rest_of(*run) - light, 2.0);
  return squares;
}

NoiseModel model_of(const std::vector<Group>& groups) {
  std::vector<std::pair<Group, double>> told;
  bool tells_power = false; // light, factor and power take three numbers of samples
  for (Group group : groups) {
    const auto of_one = noise_of_one(group);
    const auto is_lost = [](const MeasuredRun* run) { return !(run->error.value > 0.0); };
    group.erase(std::remove_if(group.begin(), group.end(), is_lost), group.end());
    if (!of_one || group.size() < 2) continue;
    std::set<int> counts;
    for (const MeasuredRun* run : group)
      counts.insert(run->samples);
    // The difference must be one of noise, not of chance.
    if (counts.size() < 2 || group.front()->error.low <= group.back()->error.high) continue;
    tells_power = tells_power || counts.size() > 2;
    told.emplace_back(std::move(group), *of_one);
  }
  if (told.empty()) return {};
  // The best of a grid, then of a finer one about it.
  NoiseModel best;
  double least = std::numeric_limits<double>::infinity();
  const auto search = [&](NoiseModel about, double factor_step, double power_step) {
    constexpr int steps = 20;
    for (int i = -steps; i <= steps; ++i)
      for (int j = -steps; j <= steps; ++j) {
        const NoiseModel model{about.factor * std::exp(i * factor_step),
                               std::clamp(about.power + j * power_step, 1.0, 2.0)};
        double off = 0.0;
        for (const auto& [group, of_one] : told)
          off += misfit(group, of_one, model);
        if (off < least) least = off, best = model;
      }
  };
  search({0.5, tells_power ? 1.5 : 1.0}, 0.1, tells_power ? 0.025 : 0.0);
  search(best, 0.005, tells_power ? 0.00125 : 0.0);
  return best;
}

} // namespace

NoiseModel noise_model(const Trade& trade) {
  return model_of(groups_of(trade));
}

std::vector<LightChoice> light_choices(const Trade& trade) {
  const std::vector<Group> groups = groups_of(trade);
  const NoiseModel model = model_of(groups);
  std::vector<double> noises;
  for (const Group& group : groups)
    if (const auto of_one = noise_of_one(group)) noises.push_back(*of_one);
  const double usual_noise = noises.empty() ? 0.0 : median_of(noises);
  std::vector<LightChoice> choices;
  for (const Group& group : groups) {
    const MeasuredRun& best = *group.back();
    LightChoice choice;
    choice.name = best.name;
    choice.overrides = light_overrides(best);
    choice.seconds_a_sample = picture_seconds(best) / (double(trade.width) * trade.height * best.samples);
    choice.light_seconds = std::max(0.0, best.seconds.value - picture_seconds(best));
    choice.noise_a_sample = noise_of_one(group).value_or(usual_noise);
    choice.noise = model;
    const double noise = model.noise(choice.noise_a_sample, best.samples);
    choice.light_error = {best.error.value - noise, best.error.low - noise, best.error.high - noise};
    choices.push_back(std::move(choice));
  }
  return choices;
}

double seconds_of(const LightChoice& light, double pixels, int samples) {
  return light.light_seconds + light.seconds_a_sample * pixels * samples;
}

double error_of(const LightChoice& light, int samples) {
  return std::max(light.light_error.value, 0.0) + light.noise.noise(light.noise_a_sample, samples);
}

namespace {

const double most_samples = limits::spp.high;

PictureChoice picture_of(const LightChoice& light, double pixels, double samples) {
  const int count = static_cast<int>(std::clamp(samples, 1.0, most_samples));
  return {light, count, seconds_of(light, pixels, count), error_of(light, count)};
}

} // namespace

std::optional<PictureChoice> choose_for_error(const std::vector<LightChoice>& lights, double pixels, double error) {
  std::optional<PictureChoice> best;
  for (const LightChoice& light : lights) {
    const double left = error - std::max(light.light_error.value, 0.0);
    const double samples = left > 0.0 ? light.noise.samples(light.noise_a_sample, left) : 2.0 * most_samples;
    if (samples > most_samples) continue;
    const PictureChoice choice = picture_of(light, pixels, std::ceil(samples));
    if (!best || choice.seconds < best->seconds) best = choice;
  }
  return best;
}

std::optional<PictureChoice> choose_for_time(const std::vector<LightChoice>& lights, double pixels, double seconds) {
  std::optional<PictureChoice> best;
  for (const LightChoice& light : lights) {
    const double samples = (seconds - light.light_seconds) / (std::max(light.seconds_a_sample, 1e-12) * pixels);
    if (!(samples >= 1.0)) continue;
    const PictureChoice choice = picture_of(light, pixels, std::floor(samples));
    if (!best || choice.error < best->error) best = choice;
  }
  return best;
}

} // namespace pointgi
