#pragma once
/// Settings that are worth a measurement: a knob is turned in those on and near the front, and what that brings is
/// foretold by what the knob alone has shown.
#include "host/measure/front_gain.h"
#include "host/measure/moves.h"
#include "host/measure/trade.h"
#include <functional>
#include <map>

namespace pointgi {

/// A knob's values measured alone, about the start.
struct KnobLine {
  const Knob* knob = nullptr;
  std::vector<std::size_t> runs;               ///< places in Trade::runs, in the order of the values
  std::vector<std::string> values;             ///< of the runs
  std::map<std::size_t, std::size_t> of_value; ///< the run of a value, by its place
  std::vector<std::string> skipped;
  std::size_t next = 0; ///< the place of the value that is to be measured now
  double cost = 0.0;    ///< of its first measurement, foretold
  std::string ended;    ///< the value that was refused, after which dearer ones are not tried
};

/// What is known when candidates are asked for.
struct TriedKnobs {
  const Trade& trade;
  const std::vector<Knob>& knobs;
  const std::vector<KnobLine>& lines;
  std::size_t start;  ///< place of the run about which knobs were turned
  double steady;      ///< relative: what times of one setting differ by, at least
  std::size_t number; ///< of candidates, at most
  /// Seconds of a first measurement of a run that takes so long.
  std::function<double(const MeasuredRun& run, double seconds)> cost_of;
};

struct Candidate {
  MeasuredRun run;
  TradePoint foretold;
  double cost = 0.0; ///< of a first measurement; asked once, as a scene may be read for it
};

/// One after the other that which is foretold to gain most area of the trade a second that it costs, the ones before
/// it being taken to come out as foretold; what is ahead by less than times scatter gains nothing. `most`: of the cost
/// of one.
std::vector<Candidate> best_candidates(const TriedKnobs& tried, double most);

/// Those nearest to the front: what is foretold may be off by some.
std::vector<Candidate> near_candidates(const TriedKnobs& tried, double most);

/// A run's place in the plane. Its error is no less than can be told of it: what is lost in the reference's noise is
/// not infinitely better than other runs.
TradePoint point_of(const MeasuredRun& run);

/// Of all runs that were measured.
std::vector<TradePoint> points_of(const Trade& trade);

} // namespace pointgi
