#pragma once
/// What a knob's curve shows, in words.
#include "host/measure/knobs.h"
#include "host/measure/trade.h"
#include <functional>

namespace pointgi {

/// The error of the second run less that of the first, and the interval that holds it in 95 of 100 measurements.
using ErrorChange = std::function<Estimate(const MeasuredRun& before, const MeasuredRun& after)>;

/// Values of a knob that were not measured, and why: "for want of time".
struct SkippedValues {
  std::vector<std::string> values = {};
  std::string why = "for want of time";
};

/// Whether the second has more error than the first: by more than the interval of the change holds, and by more than
/// a twentieth of it, as the noise of light is alike over whole surfaces and intervals know nothing of that.
bool rises(const MeasuredRun& before, const MeasuredRun& after, const ErrorChange& change = {});

/// Of a knob whose error falls by theory "falls", and from which value on that is little, or where it does not and why;
/// of others which value has the least error. Then the values that were skipped. `change`, if given, is used where it
/// tells more than the errors' own intervals: runs of one seed have much in common.
std::string finding_of(const Trade& trade, const Knob& knob, const KnobCurve& curve, const SkippedValues& skipped,
                       const ErrorChange& change = {});

} // namespace pointgi
