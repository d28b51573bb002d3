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

Estimate by_intervals(const MeasuredRun& before, const MeasuredRun& after) {
  const Estimate &a = before.error, &b = after.error;
  return {b.value - a.value, b.low - a.high, b.high - a.low};
}

/// Why the second has more error than the first, as far as mean and noise of the pictures tell.
std::string reason_of(const MeasuredRun& before, const MeasuredRun& after) {
  constexpr double half = 0.5; // of the rise: it is the greatest part of it
  const double rise = after.error.value - before.error.value;
  if (after.bias * after.bias - before.bias * before.bias > half * rise)
    return fmt::format(" (the picture as a whole is off by {:+.2g} % and was by {:+.2g} %: two errors made up for each "
                       "other before)",
                       100.0 * after.bias, 100.0 * before.bias);
  if (after.noise - before.noise > half * rise) return " (its pixels are noisier)";
  return " (by more than chance; neither the mean of the picture nor its noise says why)";
}

} // namespace

std::string finding_of(const Trade& trade, const Knob& knob, const KnobCurve& curve,
                       const std::vector<std::string>& skipped, const ErrorChange& change) {
  if (!knob.left_out.empty()) return knob.left_out;
  const std::vector<Place> measured = places_of(trade, curve);
  std::string text;
  bool rises = false, falls = false;
  for (std::size_t i = 1; i < measured.size(); ++i) {
    const MeasuredRun &before = *measured[i - 1].run, &after = *measured[i].run;
    const Estimate changed = change ? change(before, after) : by_intervals(before, after);
    falls = falls || changed.high < 0.0;
    if (changed.low <= 0.0) continue;
    rises = true;
    text += fmt::format("{}the error rises from {} to {}{}", text.empty() ? "" : "; ", measured[i - 1].value,
                        measured[i].value, reason_of(before, after));
  }
  if (measured.size() < 2)
    text = "too few values were measured to tell";
  else if (!rises)
    text = falls ? "falls" : "the error stays the same to within its interval: others outweigh what this knob changes";
  else if (knob.falls)
    text += ", against theory";
  if (!knob.falls || rises || !falls) text += ". " + knob.theory;
  std::string list;
  for (const std::string& value : skipped)
    list += (list.empty() ? "" : ", ") + value;
  if (!list.empty())
    text += (text.back() == '.' ? " " : "; ") + std::string("not measured, the budget being too small: ") + list;
  return text;
}

} // namespace pointgi
