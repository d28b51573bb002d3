#include "host/measure/forecast.h"
#include "host/scene/limits.h"
#include <algorithm>
#include <cmath>

namespace pointgi {

namespace {

constexpr const char* samples_key = "render.spp=";

/// The stage that takes time for each sample.
constexpr const char* picture_stage = "render";

std::vector<std::string> light_overrides(const MeasuredRun& run) {
  std::vector<std::string> all;
  for (const std::string& text : run.setting.overrides)
    if (text.rfind(samples_key, 0) != 0) all.push_back(text);
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

double factor_of(const std::vector<Group>& groups) {
  std::vector<double> factors;
  for (const Group& group : groups) {
    const auto known =
        std::find_if(group.begin(), group.end(), [](const auto* run) { return std::isfinite(run->noise); });
    if (known == group.end()) continue;
    const MeasuredRun &noisy = **known, &clean = *group.back();
    // The difference must be one of noise, not of chance.
    if (noisy.noise > 2.0 * clean.noise && noisy.error.low > clean.error.high)
      factors.push_back((noisy.error.value - clean.error.value) / (noisy.noise - clean.noise));
  }
  return factors.empty() ? 1.0 : std::clamp(median_of(factors), 0.1, 1.5);
}

} // namespace

double noise_factor(const Trade& trade) {
  return factor_of(groups_of(trade));
}

std::vector<LightChoice> light_choices(const Trade& trade) {
  const std::vector<Group> groups = groups_of(trade);
  const double factor = factor_of(groups);
  std::vector<double> noises;
  for (const Group& group : groups)
    for (const MeasuredRun* run : group)
      if (std::isfinite(run->noise)) noises.push_back(factor * run->noise * run->samples);
  const double usual_noise = noises.empty() ? 0.0 : median_of(noises);
  std::vector<LightChoice> choices;
  for (const Group& group : groups) {
    const MeasuredRun& best = *group.back();
    LightChoice choice;
    choice.name = best.name;
    choice.overrides = light_overrides(best);
    choice.seconds_a_sample = picture_seconds(best) / (double(trade.width) * trade.height * best.samples);
    choice.light_seconds = std::max(0.0, best.seconds.value - picture_seconds(best));
    choice.noise_a_sample = std::isfinite(best.noise) ? factor * best.noise * best.samples : usual_noise;
    const double noise = choice.noise_a_sample / best.samples;
    choice.light_error = {best.error.value - noise, best.error.low - noise, best.error.high - noise};
    choices.push_back(std::move(choice));
  }
  return choices;
}

double seconds_of(const LightChoice& light, double pixels, int samples) {
  return light.light_seconds + light.seconds_a_sample * pixels * samples;
}

double error_of(const LightChoice& light, int samples) {
  return std::max(light.light_error.value, 0.0) + light.noise_a_sample / samples;
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
    if (!(left > 0.0) || light.noise_a_sample / left > most_samples) continue;
    const PictureChoice choice = picture_of(light, pixels, std::ceil(light.noise_a_sample / left));
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
