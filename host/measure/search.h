#pragma once
/// Which settings are measured, in which order, within a budget. It knows nothing of pictures: a function that costs
/// time answers for a setting, so that a model can stand in for it.
#include "host/measure/knobs.h"
#include "host/measure/trade.h"
#include <functional>

namespace pointgi {

/// How the search gets to know a setting.
struct SearchWorld {
  /// Measures `run` once more, if it can within `most` seconds: adds to its repeats, and sets its figures or `refused`.
  /// Returns false where the whole search is to end, and the run is then as it was.
  std::function<bool(MeasuredRun& run, double most)> measure;
  std::function<double()> left; ///< seconds of the budget
};

struct SearchOptions {
  unsigned repeats = 3;        ///< of a run, at most
  double steady = 0.1;         ///< half of the range of a run's repeats, relative: below it no more are needed
  double singles_share = 0.5;  ///< of the budget left after the scene's own setting, for the knobs alone
  double longest_share = 0.1;  ///< of the budget, for one run that takes more than three times the scene's own
  std::size_t candidates = 16; ///< combinations of a generation
};

/// Measures the scene's own setting, each knob's values alone, then combinations near the front, and fills trade.runs
/// and trade.knobs. Runs that the trade has already are not measured once more where they have their repeats.
///
/// Knobs alone go in turns from their cheap values to their dear ones; a value is skipped, and named in the knob's
/// finding, where by the pace of the cheaper ones it would not fit. Combinations: what a setting on or near the front
/// and a value of a knob ask for, together; ranked by what both have saved and lost against the scene's own setting,
/// the better ones measured once, the better half of these twice, half of that three times; then again from the new
/// front, until no new one is left. What is left of the budget repeats the front, then the others, until their times
/// are steady. The outcome depends on the answers alone. False where `measure` ended it.
bool search(Trade& trade, const std::vector<Knob>& knobs, const SearchWorld& world, const SearchOptions& options = {});

/// The scene as it is, among the runs.
inline constexpr char own_name[] = "own";

/// Whether the times of a run are steady, or it was refused, or has as many as are asked for.
bool is_settled(const MeasuredRun& run, const SearchOptions& options);

/// Median, least and greatest; zeros of none.
Estimate estimate_of_repeats(const std::vector<double>& seconds);

/// In a sentence: whether the error falls along the knob's runs within their intervals, and where not. `skipped`:
/// values that were not measured.
std::string finding_of(const Trade& trade, const Knob& knob, const KnobCurve& curve,
                       const std::vector<std::string>& skipped);

} // namespace pointgi
