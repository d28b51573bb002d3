#include "host/measure/search.h"
#include "host/measure/finding.h"
#include "host/measure/front_gain.h"
#include "host/measure/intervals.h"
#include "host/measure/moves.h"
#include "host/repeats.h"
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace pointgi {

namespace {

/// An error that is lost in the reference's noise counts as this one.
constexpr double least_error = 1e-9;

double seconds_of(const MeasuredRun& run) {
  return std::max(run.seconds.value, 1e-6);
}

/// No less than can be told of it: what is lost in the reference's noise is not infinitely better than other runs.
double error_of(const MeasuredRun& run) {
  constexpr double share_told = 0.25; // of half of the interval
  return std::max({run.error.value, share_told * 0.5 * (run.error.high - run.error.low), least_error});
}

/// A run may take this long [s] whatever the budget: its kernels may have to be built.
constexpr double least_limit = 3.0;

class Search {
public:
  Search(Trade& trade, const std::vector<Knob>& knobs, const SearchWorld& world, const SearchOptions& options)
      : trade_(trade), knobs_(knobs), world_(world), options_(options) {}

  bool run() {
    const double budget = world_.left();
    MeasuredRun own;
    own.name = own_name;
    if (!once(place_of(own), budget)) return false;
    // Where there are few knobs, each may take more.
    const double share =
        std::max(options_.longest_share, 0.5 / static_cast<double>(std::max<std::size_t>(1, knobs_.size())));
    longest_ = std::max({share * budget, 3.0 * seconds_of(trade_.runs.front()), least_limit});
    const bool whole = choose_start() && singles() && confirm_rises() && combinations(&Search::best_candidates) &&
                       repeats(true) && combinations(&Search::near_candidates) && repeats(false);
    mark_front(trade_);
    if (!lines_.empty()) tell_curves();
    return whole;
  }

private:
  /// The run of that name, as it is already or added.
  std::size_t place_of(const MeasuredRun& run) {
    for (std::size_t i = 0; i < trade_.runs.size(); ++i)
      if (trade_.runs[i].name == run.name) return i;
    trade_.runs.push_back(run);
    return trade_.runs.size() - 1;
  }

  bool is_known(const MeasuredRun& run) const {
    return std::any_of(trade_.runs.begin(), trade_.runs.end(),
                       [&](const MeasuredRun& other) { return other.name == run.name; });
  }

  /// A first repetition, where there is none. A run that has never been measured does not stay.
  bool once(std::size_t at, double most) {
    MeasuredRun& run = trade_.runs[at];
    if (!run.repeats.empty() || !run.refused.empty()) return true;
    if (world_.measure(run, most)) return true;
    trade_.runs.erase(trade_.runs.begin() + static_cast<std::ptrdiff_t>(at));
    return false;
  }

  const MeasuredRun& own() const { return trade_.runs.front(); }
  const MeasuredRun& start() const { return trade_.runs[start_]; }

  /// Knobs alone are turned about the scene's own setting, or where that would take too long about a cheap one, from
  /// which dearer settings can be told as well.
  bool choose_start() {
    double values = 0.0;
    for (const Knob& knob : knobs_)
      if (!costs_little(knob)) values += static_cast<double>(knob.values.size());
    if (values * seconds_of(own()) <= options_.singles_share * world_.left()) return true;
    MeasuredRun cheap;
    cheap.name = cheap_name;
    cheap.setting.overrides = cheapest(knobs_, own().setting.method);
    if (cheap.setting.overrides.empty()) return true;
    const std::size_t at = place_of(cheap);
    if (!once(at, std::min(world_.left(), longest_))) return false;
    if (!trade_.runs[at].refused.empty() || seconds_of(trade_.runs[at]) > 0.5 * seconds_of(own())) return true;
    start_ = at;
    longest_ = std::max(options_.longest_share * world_.left(), least_limit);
    return again(at); // all others are told by their differences from it
  }

  /// What a first measurement costs of a run that takes so long.
  double cost_of(const MeasuredRun& run, double seconds) const {
    return world_.kept ? std::max(0.0, seconds - world_.kept(run)) : seconds;
  }

  struct Line {
    const Knob* knob;
    std::vector<std::size_t> runs;               ///< in the order of the values
    std::vector<std::string> values;             ///< of the runs
    std::map<std::size_t, std::size_t> of_value; ///< the run of a value, by its place
    std::vector<std::string> skipped;
    std::size_t next = 0; ///< the place of the value that is to be measured now
    double cost = 0.0;    ///< of its first measurement, foretold
    bool ended = false;   ///< dearer values would not fit either
  };

  MeasuredRun run_of(const Knob& knob, const KnobValue& value) const {
    MeasuredRun run;
    run.setting.knob = knob.name;
    run.setting.value = value.text;
    if (start_ == 0 || knob.is_of_several_keys) {
      run.name = value.own ? own_name : knob.name + "-" + value.text;
      run.setting.overrides = value.own ? Overrides() : with_value({}, knob, value, knobs_, own().setting.method);
      return run;
    }
    const std::string& method = own().setting.method;
    const std::string wanted = value.own ? method : method_of(value.overrides, method);
    run.setting.overrides = with_value(cheapest(knobs_, wanted), knob, value, knobs_, method);
    run.name = run.setting.overrides == start().setting.overrides
                   ? std::string(cheap_name)
                   : std::string(cheap_name) + "_" + knob.name + "-" + value.text;
    return run;
  }

  /// How long the next value of a knob will take, by those before it.
  double next_seconds(const Line& line) const {
    constexpr double usual_growth = 1.5, least_step = 1.5;
    std::vector<std::pair<std::string, double>> known;
    for (std::size_t i = 0; i < line.runs.size(); ++i)
      if (trade_.runs[line.runs[i]].refused.empty())
        known.emplace_back(line.values[i], seconds_of(trade_.runs[line.runs[i]]));
    if (known.empty()) return seconds_of(line.knob->is_of_several_keys ? own() : start());
    const auto& [last, seconds] = known.back();
    const std::string& next = line.knob->values[line.next].text;
    if (!is_number(last) || !is_number(next)) return usual_growth * seconds;
    // Costs grow as the values, or as 1 over them, from what all values cost. Of two that are close chance tells more.
    const bool rising = std::stod(next) > std::stod(last);
    const auto size = [&](const std::string& value) { return rising ? std::stod(value) : 1.0 / std::stod(value); };
    const auto before = std::find_if(known.rbegin() + 1, known.rend(),
                                     [&](const auto& one) { return size(last) >= least_step * size(one.first); });
    if (before == known.rend()) return usual_growth * seconds;
    const double slope = std::max(0.0, seconds - before->second) / (size(last) - size(before->first));
    return seconds + slope * (size(next) - size(last));
  }

  bool costs_little(const Knob& knob) const {
    return world_.kept && std::all_of(knob.values.begin(), knob.values.end(), [&](const KnobValue& value) {
             return value.own || world_.kept(run_of(knob, value)) > 0.0;
           });
  }

  /// What the next value of a knob costs.
  void foretell(Line& line) const {
    const Knob& knob = *line.knob;
    if (line.next >= knob.values.size()) return;
    const MeasuredRun run = run_of(knob, knob.values[line.next]);
    line.cost = is_known(run) ? 0.0 : cost_of(run, next_seconds(line));
  }

  /// How much later than its cost says a value's turn comes: knobs that the scene's own method reads come first, those
  /// of methods that are far from the front and those for which other kernels have to be built come last.
  double patience(const Line& line) const {
    constexpr double soon = 1.0, later = 1.5, last = 4.0, far = 0.5; // of a logarithm
    const Knob& knob = *line.knob;
    if (knob.is_of_program()) return last;
    if (knob.method.empty() || knob.method == own().setting.method) return knob.is_of_several_keys ? later : soon;
    const auto is_near = [&](std::size_t at) {
      return trade_.runs[at].refused.empty() && behind_of(trade_.runs[at]) <= far;
    };
    return line.runs.empty() || std::any_of(line.runs.begin(), line.runs.end(), is_near) ? later : last;
  }

  bool single(Line& line, double reserve) {
    foretell(line); // what was kept may have made room since
    const std::size_t place = line.next++;
    const KnobValue& value = line.knob->values[place];
    const MeasuredRun run = run_of(*line.knob, value);
    if (!is_known(run) && (line.ended || line.cost > std::min(world_.left() - reserve, longest_))) {
      line.skipped.push_back(value.text);
      return true;
    }
    const std::size_t at = place_of(run);
    if (!once(at, std::min(world_.left(), longest_))) {
      line.next = place;
      return false;
    }
    line.runs.push_back(at);
    line.values.push_back(value.text);
    line.of_value[place] = at;
    line.ended = line.ended || (!trade_.runs[at].refused.empty() && line.knob->falls);
    return true;
  }

  /// Of all knobs the cheapest of their next values, until none fits.
  bool singles() {
    const double reserve = (1.0 - options_.singles_share) * world_.left();
    for (const Knob& knob : knobs_) {
      Line line{&knob, {}, {}, {}, {}};
      foretell(line);
      lines_.push_back(std::move(line));
    }
    for (;;) {
      Line* next = nullptr;
      for (Line& line : lines_)
        if (line.next < line.knob->values.size() &&
            (next == nullptr || patience(line) * line.cost < patience(*next) * next->cost))
          next = &line;
      if (next == nullptr) return true;
      if (!single(*next, reserve)) return false;
      foretell(*next);
    }
  }

  /// Where the error rises against theory, that may be chance of one seed: others tell.
  bool confirm_rises() {
    for (const Line& line : lines_)
      for (std::size_t i = 1; i < line.runs.size() && line.knob->falls; ++i) {
        const std::size_t before = line.runs[i - 1], after = line.runs[i];
        while (rises(trade_.runs[before], trade_.runs[after], world_.change) &&
               std::min(trade_.runs[before].repeats.size(), trade_.runs[after].repeats.size()) < options_.repeats)
          for (const std::size_t at : {before, after}) {
            MeasuredRun& run = trade_.runs[at];
            if (run.repeats.size() >= options_.repeats) continue;
            if (seconds_of(run) > std::min(longest_, 0.5 * world_.left())) return true;
            if (!world_.measure(run, world_.left())) return false;
          }
      }
    return true;
  }

  static TradePoint point_of(const MeasuredRun& run) { return {seconds_of(run), error_of(run)}; }

  std::vector<TradePoint> points() const {
    std::vector<TradePoint> all;
    for (const MeasuredRun& run : trade_.runs)
      if (run.refused.empty() && !run.repeats.empty()) all.push_back(point_of(run));
    return all;
  }

  double behind_of(const MeasuredRun& run) const { return behind(point_of(run), points()); }

  struct Candidate {
    MeasuredRun run;
    TradePoint foretold;
    double cost = 0.0; ///< of a first measurement; asked once, as a scene may be read for it
  };

  /// The run that shows what a knob's value does alone; nullptr: there is none.
  const MeasuredRun* shown(const Line& line, std::size_t value) const {
    const auto at = line.of_value.find(value);
    return at != line.of_value.end() && trade_.runs[at->second].refused.empty() ? &trade_.runs[at->second] : nullptr;
  }

  /// The run that shows what the value does that a setting has, but for that value.
  const MeasuredRun* shown(const Line& line, const Overrides& overrides) const {
    if (const auto value = value_in(overrides, *line.knob)) return shown(line, *value);
    // None of the knob's: the scene's own, which the start has as well, or that of a method the scene has not chosen.
    if (line.knob->method.empty()) return value_in(start().setting.overrides, *line.knob) ? nullptr : &start();
    for (const Line& other : lines_)
      for (const auto& [value, at] : other.of_value)
        if (other.knob->key == method_key && other.knob->values[value].text == line.knob->method)
          return trade_.runs[at].refused.empty() ? &trade_.runs[at] : nullptr;
    return nullptr;
  }

  /// By how much the times of one setting differ, relative.
  double scatter() const { return std::max(options_.steady, 2.0 * time_deviation(trade_)); }

  /// The setting of a run with another value of a knob: the time and the error change by what the knob alone has shown.
  std::optional<Candidate> moved(const MeasuredRun& from, const Line& line, std::size_t place) const {
    const Knob& knob = *line.knob;
    const KnobValue& value = knob.values[place];
    const std::string& method = own().setting.method;
    if (!goes_with(from.setting.overrides, knob, value, method)) return std::nullopt;
    const MeasuredRun *after = shown(line, place), *before = shown(line, from.setting.overrides);
    if (after == nullptr || before == nullptr) return std::nullopt;
    Candidate candidate;
    candidate.run.setting.overrides = with_value(from.setting.overrides, knob, value, knobs_, method);
    candidate.run.name =
        name_about(candidate.run.setting.overrides, start().setting.overrides, start().name, knobs_, method);
    constexpr double least_left = 0.3; // of a sum that would be less
    const double of_from = error_of(from), of_after = error_of(*after), of_before = error_of(*before);
    // What a cheaper value adds it adds to any setting. What a dearer one takes away may be little in one that has
    // less.
    const double error = of_after > of_before
                             ? of_from + of_after - of_before
                             : std::max(of_from + of_after - of_before, of_from * of_after / of_before);
    double seconds = seconds_of(*after) - seconds_of(*before);
    if (std::fabs(seconds) < scatter() * seconds_of(*before)) seconds = 0.0; // may be chance
    candidate.foretold = {std::max(seconds_of(from) + seconds, least_left * seconds_of(from)), error};
    return candidate;
  }

  /// The settings a knob away from those on and near the front that have not been measured, of a cost of `most` or
  /// less.
  std::vector<Candidate> neighbours(double most) const {
    constexpr double near = 0.25; // of a logarithm
    std::set<Overrides> known;
    for (const MeasuredRun& run : trade_.runs)
      known.insert(run.setting.overrides);
    const std::vector<TradePoint> measured = points();
    std::vector<Candidate> all;
    for (const MeasuredRun& from : trade_.runs) {
      if (!from.refused.empty() || behind(point_of(from), measured) > near) continue;
      for (const Line& line : lines_)
        for (std::size_t v = 0; v < line.knob->values.size() && !line.knob->is_of_several_keys; ++v)
          if (auto candidate = moved(from, line, v);
              candidate && known.insert(candidate->run.setting.overrides).second) {
            candidate->cost = cost_of(candidate->run, candidate->foretold.seconds);
            if (candidate->cost <= most) all.push_back(std::move(*candidate));
          }
    }
    return all;
  }

  /// One after the other that which is foretold to gain most area of the trade a second that it costs, the ones before
  /// it being taken to come out as foretold; what is ahead by less than times scatter gains nothing.
  std::vector<Candidate> best_candidates(double most) const {
    std::vector<Candidate> all = neighbours(most), chosen;
    std::vector<TradePoint> measured = points();
    constexpr double beyond = 2.0; // what the measured ones reach
    TradePoint worst{0.0, 0.0};
    for (const TradePoint& point : measured)
      worst = {std::max(worst.seconds, beyond * point.seconds), std::max(worst.error, beyond * point.error)};
    const double least_gain = std::log1p(options_.steady);
    while (chosen.size() < options_.candidates) {
      const Candidate* best = nullptr;
      double most_gained = 0.0;
      for (const Candidate& candidate : all) {
        if (behind(candidate.foretold, measured) > -least_gain) continue;
        const double gained = area_gained(candidate.foretold, measured, worst) / std::max(candidate.cost, 1e-6);
        if (gained > most_gained) best = &candidate, most_gained = gained;
      }
      if (best == nullptr) break;
      measured.push_back(best->foretold);
      chosen.push_back(*best);
    }
    return chosen;
  }

  /// Those nearest to the front: what is foretold may be off by some.
  std::vector<Candidate> near_candidates(double most) const {
    constexpr double hopeless = 0.7; // twice as slow and as far off as the front
    const std::vector<TradePoint> measured = points();
    std::vector<std::pair<double, Candidate>> ranked;
    for (Candidate& candidate : neighbours(most))
      if (const double rank = std::max(0.0, behind(candidate.foretold, measured)); rank <= hopeless)
        ranked.emplace_back(rank, std::move(candidate));
    std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) {
      return a.first != b.first ? a.first < b.first : a.second.cost < b.second.cost;
    });
    if (ranked.size() > options_.candidates) ranked.resize(options_.candidates);
    std::vector<Candidate> chosen;
    for (auto& [rank, candidate] : ranked)
      chosen.push_back(std::move(candidate));
    return chosen;
  }

  /// The better half of the runs at these places.
  std::vector<std::size_t> better_half(std::vector<std::size_t> places) const {
    std::stable_sort(places.begin(), places.end(), [&](std::size_t a, std::size_t b) {
      return behind_of(trade_.runs[a]) < behind_of(trade_.runs[b]);
    });
    places.resize((places.size() + 1) / 2);
    return places;
  }

  bool again(std::size_t at) {
    MeasuredRun& run = trade_.runs[at];
    if (is_settled(run, options_) || seconds_of(run) > world_.left()) return true;
    return world_.measure(run, world_.left());
  }

  /// Seconds that a second run of the scene's own setting and of those of the front takes.
  double seconds_of_second_runs() {
    double seconds = 0.0;
    mark_front(trade_);
    for (const MeasuredRun& run : trade_.runs)
      if ((run.on_front || &run == &own()) && run.repeats.size() < 2) seconds += seconds_of(run);
    return seconds;
  }

  bool combinations(std::vector<Candidate> (Search::*candidates)(double) const) {
    constexpr double most_for_repeats = 0.5, little = 0.25;
    // All are compared with the scene's own.
    if (seconds_of(own()) < little * world_.left() && !again(0)) return false;
    const double most_reserved = most_for_repeats * world_.left();
    for (;;) {
      const double reserve = std::min(most_reserved, seconds_of_second_runs());
      std::vector<std::size_t> places;
      const std::size_t before = trade_.runs.size();
      for (const Candidate& candidate : (this->*candidates)(world_.left() - reserve)) {
        constexpr double off = 1.5; // it may take longer than foretold
        const double most = world_.left() - reserve;
        if (candidate.cost > most) continue;
        const std::size_t at = place_of(candidate.run);
        if (!once(at, std::min(std::max(most, 0.0), std::max(longest_, off * candidate.cost)))) return false;
        if (trade_.runs[at].refused.empty()) places.push_back(at);
      }
      if (trade_.runs.size() == before) return true;
      for (unsigned repeat = 1; repeat < options_.repeats; ++repeat) {
        places = better_half(places);
        for (const std::size_t at : places)
          if (behind_of(trade_.runs[at]) <= 0.0 && seconds_of(trade_.runs[at]) < world_.left() - reserve && !again(at))
            return false;
      }
    }
  }

  /// Once more each, where their times are not steady.
  bool repeat(bool front_only) {
    const std::vector<std::size_t> front = mark_front(trade_);
    for (std::size_t at = 0; at < trade_.runs.size(); ++at) {
      if (front_only && at > 0 && std::find(front.begin(), front.end(), at) == front.end()) continue;
      if (!again(at)) return false;
    }
    return true;
  }

  bool repeats(bool front_only) {
    for (unsigned repeated = 1; repeated < options_.repeats; ++repeated)
      if (!repeat(front_only)) return false;
    return true;
  }

  void tell_curves() {
    trade_.knobs.clear();
    for (const Line& line : lines_) {
      KnobCurve curve{line.knob->name, {}, line.knob->falls, {}};
      if (start_ != 0 && line.knob->left_out.empty() && !line.knob->is_of_several_keys) curve.about = start().name;
      for (const std::size_t at : line.runs)
        curve.runs.push_back(trade_.runs[at].name);
      curve.values = line.values;
      std::vector<std::string> skipped = line.skipped;
      for (std::size_t v = line.next; v < line.knob->values.size(); ++v) // interrupted before
        skipped.push_back(line.knob->values[v].text);
      curve.finding = finding_of(trade_, *line.knob, curve, skipped, world_.change);
      trade_.knobs.push_back(curve);
    }
  }

  Trade& trade_;
  const std::vector<Knob>& knobs_;
  const SearchWorld& world_;
  const SearchOptions& options_;
  double longest_ = std::numeric_limits<double>::infinity();
  std::size_t start_ = 0; ///< the run about which knobs are turned
  std::vector<Line> lines_;
};

} // namespace

bool search(Trade& trade, const std::vector<Knob>& knobs, const SearchWorld& world, const SearchOptions& options) {
  return Search(trade, knobs, world, options).run();
}

bool is_settled(const MeasuredRun& run, const SearchOptions& options) {
  if (!run.refused.empty() || run.repeats.size() >= options.repeats) return true;
  if (run.repeats.size() < 2) return false;
  const auto [least, most] = std::minmax_element(run.repeats.begin(), run.repeats.end());
  return *most - *least < 2.0 * options.steady * median_of_repeats(run.repeats);
}

Estimate estimate_of_repeats(const std::vector<double>& seconds) {
  if (seconds.empty()) return {};
  const auto [least, most] = std::minmax_element(seconds.begin(), seconds.end());
  return {median_of_repeats(seconds), *least, *most};
}

} // namespace pointgi
