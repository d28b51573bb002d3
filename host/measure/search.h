#pragma once
/// Which settings are measured, in which order, within a budget. It knows nothing of pictures: a function that costs
/// time answers for a setting, so that a model can stand in for it.
#include "host/measure/finding.h"
#include "host/measure/trade.h"
#include <functional>

namespace pointgi {

/// How the search gets to know a setting.
struct SearchWorld {
  /// Measures `run` once more, if it can within `most` seconds: adds to its repeats, and sets its figures or `refused`.
  /// Returns false where the whole search is to end, and the run is then as it was.
  std::function<bool(MeasuredRun& run, double most)> measure;
  std::function<double()> left; ///< seconds of the budget
  /// Seconds of `run` that its first measurement need not take, as an earlier one has left their result; empty: none.
  std::function<double(const MeasuredRun& run)> kept = {};
  /// See finding_of.
  ErrorChange change = {};
};

struct SearchOptions {
  unsigned repeats = 3;        ///< of a run, at most
  double steady = 0.1;         ///< half of the range of a run's repeats, relative: below it no more are needed
  double singles_share = 0.55; ///< of the budget left after the scene's own setting, for the knobs alone
  double longest_share = 0.1;  ///< of the budget, for a run of a knob alone that takes more than three times the own
  std::size_t candidates = 6;  ///< of a generation, before what it shows is asked for the next one
};

/// Measures the scene's own setting, each knob's values alone, then others near the front, and fills trade.runs and
/// trade.knobs. Runs that the trade has already are not measured once more where they have their repeats.
///
/// Knobs alone are turned about the scene's own setting; where that takes too long for the budget, about a cheap one,
/// in which all knobs that cost time have their cheapest values. Each goes from its cheap values to its dear ones; the
/// next one is always the cheapest, those of other methods and of other kernels waiting longer; a value is skipped, and
/// named in the knob's finding, where by the pace of the cheaper ones it would not fit. Where an error rises against
/// theory, other seeds are asked. Then a knob at a time is turned in the settings on and near the front; what that may
/// bring is foretold by what the knob alone has shown. Those that are foretold to gain most area of the trade for their
/// cost are measured once, the better half of these twice, half of that three times; then again from the new front,
/// until none is foretold to gain more than times scatter. The front is repeated. What is left of the budget goes to
/// settings foretold to be near the front, then to repeats of all, until their times are steady. The outcome depends on
/// the answers alone. False where `measure` ended it.
bool search(Trade& trade, const std::vector<Knob>& knobs, const SearchWorld& world, const SearchOptions& options = {});

/// The scene as it is, among the runs, and the cheap setting.
inline constexpr char own_name[] = "own", cheap_name[] = "cheap";

/// Whether the times of a run are steady, or it was refused, or has as many as are asked for.
bool is_settled(const MeasuredRun& run, const SearchOptions& options);

/// Median, least and greatest; zeros of none.
Estimate estimate_of_repeats(const std::vector<double>& seconds);

} // namespace pointgi
