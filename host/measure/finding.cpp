#include "host/measure/finding.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace pointgi {

namespace {

/// A measured value of the knob.
struct Place {
  std::string value;
  const MeasuredRun* run;
};

std::vector<Place> places_of(const Trade& trade, const KnobCurve& curve) {
  std::vector<Place> places;
  for (std::size_t i = 0; i < curve.runs.size(); ++i)
    for (const MeasuredRun& run : trade.runs)
      if (run.name == curve.runs[i] && run.refused.empty())
        places.push_back({i < curve.values.size() ? curve.values[i] : run.name, &run});
  return places;
}

/// How much more error the second has; of what is known of it the narrower interval.
Estimate changed_by(const MeasuredRun& before, const MeasuredRun& after, const ErrorChange& change) {
  const Estimate &a = before.error, &b = after.error;
  const Estimate apart{b.value - a.value, b.low - a.high, b.high - a.low};
  if (!change) return apart;
  const Estimate known = change(before, after);
  return known.high - known.low < apart.high - apart.low ? known : apart;
}

/// Of a picture whose mean was no farther off than this share of its error's root, nothing is made up for.
constexpr double balanced = 0.3;

/// Why the second has this much more error than the first, as far as mean and noise of the pictures tell.
std::string reason_of(const MeasuredRun& before, const MeasuredRun& after, double rise) {
  constexpr double half = 0.5; // of the rise: it is the greatest part of it
  const double squares = after.bias * after.bias - before.bias * before.bias;
  if (squares > half * rise) {
    const std::string off = fmt::format("the picture as a whole is off by {:+.2g} % and was by {:+.2g} %",
                                        100.0 * after.bias, 100.0 * before.bias);
    const bool was_balanced = before.bias * before.bias < balanced * balanced * before.error.value;
    return " (" + off + (was_balanced ? ": two errors may have made up for each other)" : ")");
  }
  if (std::isfinite(before.noise) && std::isfinite(after.noise) && after.noise - before.noise > half * rise)
    return " (its pixels are noisier)";
  return " (neither the mean of the picture nor the noise of its pixels says why)";
}

/// Changes of less than this share of an error are nothing to a user.
constexpr double little = 0.05;

/// From which of the values on the error stays as it is.
std::size_t level_from(const std::vector<Place>& measured) {
  std::size_t from = measured.size() - 1;
  const auto is_like = [&](std::size_t i, std::size_t j) {
    const double error = measured[i].run->error.value;
    return std::fabs(measured[j].run->error.value - error) <= little * std::fabs(error);
  };
  for (std::size_t i = measured.size() - 1; i-- > 0;) {
    for (std::size_t j = i + 1; j < measured.size(); ++j)
      if (!is_like(i, j)) return from;
    from = i;
  }
  return from;
}

/// Of a knob whose error falls by theory.
std::string told_of_falling(const std::vector<Place>& measured, const std::string& theory, const ErrorChange& change) {
  std::string rising;
  bool falls = changed_by(*measured.front().run, *measured.back().run, change).high < 0.0;
  for (std::size_t i = 1; i < measured.size(); ++i) {
    const MeasuredRun &before = *measured[i - 1].run, &after = *measured[i].run;
    const Estimate changed = changed_by(before, after, change);
    falls = falls || changed.high < 0.0;
    if (rises(before, after, change))
      rising += fmt::format("{}the error rises from {} to {}{}", rising.empty() ? "" : "; ", measured[i - 1].value,
                            measured[i].value, reason_of(before, after, changed.value));
  }
  if (!rising.empty()) return rising + ", against theory. " + theory;
  if (!falls)
    return "the error stays the same to within its interval: others outweigh what this knob changes. " + theory;
  const std::size_t from = level_from(measured);
  if (from + 1 == measured.size()) return "falls";
  if (from == 0) return "falls by less than a twentieth in all";
  return fmt::format("falls up to {}, and changes by less than a twentieth from there on", measured[from].value);
}

/// Of a knob whose values differ in kind.
std::string told_of_kinds(const std::vector<Place>& measured, const std::string& theory, const ErrorChange& change) {
  const Place& best = *std::min_element(measured.begin(), measured.end(), [](const Place& a, const Place& b) {
    return a.run->error.value < b.run->error.value;
  });
  std::string alike;
  std::size_t count = 1;
  for (const Place& other : measured) {
    if (&other == &best || rises(*best.run, *other.run, change)) continue;
    alike += (alike.empty() ? "" : ", ") + other.value;
    ++count;
  }
  if (count == measured.size()) return "no value has less error than the others, to within their intervals. " + theory;
  return "the least error is that of " + best.value +
         (alike.empty() ? "" : "; by chance or by less than a twentieth differ " + alike) + ". " + theory;
}

} // namespace

bool rises(const MeasuredRun& before, const MeasuredRun& after, const ErrorChange& change) {
  if (!before.refused.empty() || !after.refused.empty()) return false;
  const Estimate changed = changed_by(before, after, change);
  return changed.low > 0.0 && changed.value > little * before.error.value;
}

std::string finding_of(const Trade& trade, const Knob& knob, const KnobCurve& curve, const SkippedValues& skipped,
                       const ErrorChange& change) {
  if (!knob.left_out.empty()) return knob.left_out;
  const std::vector<Place> measured = places_of(trade, curve);
  std::string text = measured.size() < 2 ? "too few values were measured to tell. " + knob.theory
                     : knob.falls        ? told_of_falling(measured, knob.theory, change)
                                         : told_of_kinds(measured, knob.theory, change);
  std::string list;
  for (const std::string& value : skipped.values)
    list += (list.empty() ? "" : ", ") + value;
  if (!list.empty())
    text += std::string(text.back() == '.' ? " Not" : "; not") + " measured " + skipped.why + ": " + list;
  return text;
}

} // namespace pointgi
