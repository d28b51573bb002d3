#include "host/measure/finding.h"
#include <fmt/format.h>

namespace pointgi {

std::string finding_of(const Trade& trade, const Knob& knob, const KnobCurve& curve,
                       const std::vector<std::string>& skipped) {
  if (!knob.left_out.empty()) return knob.left_out;
  std::vector<const MeasuredRun*> measured;
  for (const std::string& name : curve.runs)
    for (const MeasuredRun& run : trade.runs)
      if (run.name == name && run.refused.empty()) measured.push_back(&run);
  std::string text;
  bool rises = false, falls = false;
  for (std::size_t i = 1; i < measured.size(); ++i) {
    const Estimate &before = measured[i - 1]->error, &after = measured[i]->error;
    falls = falls || after.high < before.low;
    if (after.low <= before.high) continue;
    rises = true;
    text += fmt::format("{}the error rises from {} to {}", text.empty() ? "" : "; ", measured[i - 1]->name,
                        measured[i]->name);
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
