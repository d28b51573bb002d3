#pragma once
/// What a knob's measured curve says, in words.
#include "host/measure/knobs.h"
#include "host/measure/trade.h"

namespace pointgi {

/// In a sentence: whether the error falls along the knob's runs within their intervals, and where not. `skipped`:
/// values that were not measured.
std::string finding_of(const Trade& trade, const Knob& knob, const KnobCurve& curve,
                       const std::vector<std::string>& skipped);

} // namespace pointgi
