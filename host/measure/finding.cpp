#include "host/measure/finding.h"
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

Estimate changed_by(const MeasuredRun& before, const MeasuredRun& after, const ErrorChange& change) {
  if (change) return change(before, after);
  const Estimate &a = before.error, &b = after.error;
  return {b.value - a.value, b.low - a.high, b.high - a.low};
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

} // namespace

bool rises(const MeasuredRun& before, const MeasuredRun& after, const ErrorChange& change) {
  constexpr double least_share = 0.05;
  if (!before.refused.empty() || !after.refused.empty()) return false;
  const Estimate changed = changed_by(before, after, change);
  return changed.low > 0.0 && changed.value > least_share * before.error.value;
}

std::string finding_of(const Trade& trade, const Knob& knob, const KnobCurve& curve,
                       const std::vector<std::string>& skipped, const ErrorChange& change) {
  if (!knob.left_out.empty()) return knob.left_out;
  const std::vector<Place> measured = places_of(trade, curve);
  std::string text;
  bool rise = false, falls = false;
  for (std::size_t i = 1; i < measured.size(); ++i) {
    const MeasuredRun &before = *measured[i - 1].run, &after = *measured[i].run;
    const Estimate changed = changed_by(before, after, change);
    falls = falls || changed.high < 0.0;
    if (!rises(before, after, change)) continue;
    rise = true;
    text += fmt::format("{}the error rises from {} to {}{}", text.empty() ? "" : "; ", measured[i - 1].value,
                        measured[i].value, reason_of(before, after, changed.value));
  }
  if (measured.size() < 2)
    text = "too few values were measured to tell";
  else if (!rise)
    text = falls ? "falls" : "the error stays the same to within its interval: others outweigh what this knob changes";
  else if (knob.falls)
    text += ", against theory";
  if (!knob.falls || rise || !falls) text += ". " + knob.theory;
  std::string list;
  for (const std::string& value : skipped)
    list += (list.empty() ? "" : ", ") + value;
  if (!list.empty()) text += (text.back() == '.' ? " " : "; ") + std::string("not measured for want of time: ") + list;
  return text;
}

} // namespace pointgi
