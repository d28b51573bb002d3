#pragma once
/// What a knob's curve shows, in words.
#include "host/measure/knobs.h"
#include "host/measure/trade.h"
#include <functional>

namespace pointgi {

/// The error of the second run less that of the first, and the interval that holds it in 95 of 100 measurements.
using ErrorChange = std::function<Estimate(const MeasuredRun& before, const MeasuredRun& after)>;

/// "falls", or where the error of the curve's runs does not fall from value to value and why, with what theory says;
/// and the values that were skipped. `change`, if given, tells more than the errors' own intervals: runs of one seed
/// have much in common.
std::string finding_of(const Trade& trade, const Knob& knob, const KnobCurve& curve,
                       const std::vector<std::string>& skipped, const ErrorChange& change = {});

} // namespace pointgi
