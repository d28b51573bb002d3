#include "host/measure/candidates.h"
#include "host/measure/forecast.h"
#include "host/measure/intervals.h"
#include <algorithm>
#include <cmath>
#include <set>

namespace pointgi {

namespace {

/// Of what is lost in the reference's noise.
constexpr double least_error = 1e-9;

double seconds_of(const MeasuredRun& run) {
  return point_of(run).seconds;
}

double error_of(const MeasuredRun& run) {
  return point_of(run).error;
}

/// That solved the scene's own light.
const std::string& method_of_scene(const TriedKnobs& tried) {
  return tried.trade.runs.front().setting.method;
}

const MeasuredRun& start_of(const TriedKnobs& tried) {
  return tried.trade.runs[tried.start];
}

/// The run that shows what a knob's value does alone; nullptr: there is none.
const MeasuredRun* shown(const TriedKnobs& tried, const KnobLine& line, std::size_t value) {
  const auto at = line.of_value.find(value);
  return at != line.of_value.end() && tried.trade.runs[at->second].refused.empty() ? &tried.trade.runs[at->second]
                                                                                   : nullptr;
}

/// The run that shows what the value does that a setting has, but for that value.
const MeasuredRun* shown(const TriedKnobs& tried, const KnobLine& line, const Overrides& overrides) {
  if (const auto value = value_in(overrides, *line.knob)) return shown(tried, line, *value);
  // None of the knob's: the scene's own, which the start has as well, or that of a method the scene has not chosen.
  if (line.knob->method.empty())
    return value_in(start_of(tried).setting.overrides, *line.knob) ? nullptr : &start_of(tried);
  for (const KnobLine& other : tried.lines)
    for (const auto& [value, at] : other.of_value)
      if (other.knob->key == method_key && other.knob->values[value].text == line.knob->method)
        return tried.trade.runs[at].refused.empty() ? &tried.trade.runs[at] : nullptr;
  return nullptr;
}

/// By how much the times of one setting differ, relative.
double scatter(const TriedKnobs& tried) {
  return std::max(tried.steady, 2.0 * time_deviation(tried.trade));
}

/// What a cheaper value adds to the error it adds to any setting. What a dearer one takes away may be little in one
/// that has less.
double with_change(double error, double before, double after) {
  const double changed = error + after - before;
  return after > before ? changed : std::max(changed, error * after / before);
}

/// The error of a run with so many samples a pixel.
double with_samples(const MeasuredRun& run, int samples, const NoiseModel& model) {
  const double of_one = run.noise * run.samples, light = error_of(run) - model.noise(of_one, run.samples);
  return std::max(light, least_error) + model.noise(of_one, samples);
}

/// The setting of a run with another value of a knob: the time and the error change by what the knob alone has shown.
std::optional<Candidate> moved(const TriedKnobs& tried, const MeasuredRun& from, const KnobLine& line,
                               std::size_t place, const NoiseModel& noise, double scattered) {
  const Knob& knob = *line.knob;
  const KnobValue& value = knob.values[place];
  const std::string& method = method_of_scene(tried);
  if (!goes_with(from.setting.overrides, knob, value, method)) return std::nullopt;
  const MeasuredRun *after = shown(tried, line, place), *before = shown(tried, line, from.setting.overrides);
  if (after == nullptr || before == nullptr) return std::nullopt;
  Candidate candidate;
  candidate.run.setting.overrides = with_value(from.setting.overrides, knob, value, tried.knobs, method);
  candidate.run.name = name_about(candidate.run.setting.overrides, start_of(tried).setting.overrides,
                                  start_of(tried).name, tried.knobs, method);
  constexpr double least_left = 0.3; // of a sum that would be less
  double seconds = seconds_of(*after) - seconds_of(*before);
  if (std::fabs(seconds) < scattered * seconds_of(*before)) seconds = 0.0; // may be chance
  candidate.foretold = {std::max(seconds_of(from) + seconds, least_left * seconds_of(from)),
                        knob.key == samples_key && std::isfinite(from.noise)
                            ? with_samples(from, std::stoi(value.text), noise)
                            : with_change(error_of(from), error_of(*before), error_of(*after))};
  return candidate;
}

/// The settings a knob away from those on and near the front that have not been measured, of a cost of `most` or
/// less.
std::vector<Candidate> neighbours(const TriedKnobs& tried, double most) {
  constexpr double near = 0.25; // of a logarithm
  std::set<Overrides> known;
  for (const MeasuredRun& run : tried.trade.runs)
    known.insert(run.setting.overrides);
  const std::vector<TradePoint> measured = points_of(tried.trade);
  const NoiseModel noise = noise_model(tried.trade);
  const double scattered = scatter(tried);
  std::vector<Candidate> all;
  for (const MeasuredRun& from : tried.trade.runs) {
    if (!from.refused.empty() || behind(point_of(from), measured) > near) continue;
    for (const KnobLine& line : tried.lines)
      for (std::size_t v = 0; v < line.knob->values.size() && !line.knob->is_of_several_keys; ++v)
        if (auto candidate = moved(tried, from, line, v, noise, scattered);
            candidate && known.insert(candidate->run.setting.overrides).second) {
          candidate->cost = tried.cost_of(candidate->run, candidate->foretold.seconds);
          if (candidate->cost <= most) all.push_back(std::move(*candidate));
        }
  }
  return all;
}

} // namespace

std::vector<Candidate> best_candidates(const TriedKnobs& tried, double most) {
  std::vector<Candidate> all = neighbours(tried, most), chosen;
  std::vector<TradePoint> measured = points_of(tried.trade);
  constexpr double beyond = 2.0; // what the measured ones reach
  TradePoint worst{0.0, 0.0};
  for (const TradePoint& point : measured)
    worst = {std::max(worst.seconds, beyond * point.seconds), std::max(worst.error, beyond * point.error)};
  const double least_gain = std::log1p(tried.steady);
  while (chosen.size() < tried.number) {
    const Candidate* best = nullptr;
    double most_gained = 0.0;
    for (const Candidate& candidate : all) {
      if (behind(candidate.foretold, measured) > -least_gain) continue;
      const double gained = area_gained(candidate.foretold, measured, worst) / std::max(candidate.cost, 1e-6);
      if (gained > most_gained) best = &candidate, most_gained = gained;
    }
    if (best == nullptr) break;
    measured.push_back(best->foretold);
    chosen.push_back(*best);
  }
  return chosen;
}

std::vector<Candidate> near_candidates(const TriedKnobs& tried, double most) {
  constexpr double hopeless = 0.7; // twice as slow and as far off as the front
  const std::vector<TradePoint> measured = points_of(tried.trade);
  std::vector<std::pair<double, Candidate>> ranked;
  for (Candidate& candidate : neighbours(tried, most))
    if (const double rank = std::max(0.0, behind(candidate.foretold, measured)); rank <= hopeless)
      ranked.emplace_back(rank, std::move(candidate));
  std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first < b.first : a.second.cost < b.second.cost;
  });
  if (ranked.size() > tried.number) ranked.resize(tried.number);
  std::vector<Candidate> chosen;
  for (auto& [rank, candidate] : ranked)
    chosen.push_back(std::move(candidate));
  return chosen;
}

TradePoint point_of(const MeasuredRun& run) {
  constexpr double least_seconds = 1e-6, share_told = 0.25; // of half of the interval
  return {std::max(run.seconds.value, least_seconds),
          std::max({run.error.value, share_told * 0.5 * (run.error.high - run.error.low), least_error})};
}

std::vector<TradePoint> points_of(const Trade& trade) {
  std::vector<TradePoint> all;
  for (const MeasuredRun& run : trade.runs)
    if (run.refused.empty() && !run.repeats.empty()) all.push_back(point_of(run));
  return all;
}

} // namespace pointgi
