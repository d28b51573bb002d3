#include "host/measure/search.h"
#include "host/measure/finding.h"
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

/// A cost that grows from value to value is taken to grow no faster than this.
constexpr double fastest_growth = 5.0;

double seconds_of(const MeasuredRun& run) {
  return std::max(run.seconds.value, 1e-6);
}

double error_of(const MeasuredRun& run) {
  return std::max(run.error.value, least_error);
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
    const bool whole = choose_start() && singles() && combinations() && repeats();
    mark_front(trade_);
    tell_curves();
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
    return true;
  }

  /// What a first measurement costs of a run that takes so long.
  double cost_of(const MeasuredRun& run, double seconds) const {
    return world_.kept ? std::max(0.0, seconds - world_.kept(run)) : seconds;
  }

  /// How long the next value of a knob will take, by those before it.
  double next_seconds(const std::vector<std::size_t>& before) const {
    std::vector<double> costs;
    for (const std::size_t i : before)
      if (trade_.runs[i].refused.empty()) costs.push_back(seconds_of(trade_.runs[i]));
    if (costs.empty()) return seconds_of(start());
    if (costs.size() == 1) return costs.back() * 2.0;
    return costs.back() * std::clamp(costs.back() / costs[costs.size() - 2], 1.0, fastest_growth);
  }

  struct Line {
    const Knob* knob;
    std::vector<std::size_t> runs;               ///< in the order of the values
    std::map<std::size_t, std::size_t> of_value; ///< the run of a value, by its place
    std::vector<std::string> skipped;
    bool ended = false; ///< dearer values would not fit either
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

  bool single(Line& line, std::size_t place, double reserve) {
    const KnobValue& value = line.knob->values[place];
    const MeasuredRun run = run_of(*line.knob, value);
    const double room = world_.left() - reserve;
    if (!is_known(run) && (line.ended || cost_of(run, next_seconds(line.runs)) > std::min(room, longest_))) {
      line.skipped.push_back(value.text);
      return true;
    }
    const std::size_t at = place_of(run);
    if (!once(at, std::min(world_.left(), longest_))) return false;
    line.runs.push_back(at);
    line.of_value[place] = at;
    line.ended = line.ended || (!trade_.runs[at].refused.empty() && line.knob->falls);
    return true;
  }

  bool singles() {
    const double reserve = (1.0 - options_.singles_share) * world_.left();
    for (const Knob& knob : knobs_)
      lines_.push_back({&knob, {}, {}, {}});
    std::size_t most = 0;
    for (Line& line : lines_) {
      most = std::max(most, line.knob->values.size());
      if (costs_little(*line.knob))
        for (std::size_t v = 0; v < line.knob->values.size(); ++v)
          if (!single(line, v, reserve)) return false;
    }
    for (std::size_t v = 0; v < most; ++v)
      for (Line& line : lines_)
        if (v < line.knob->values.size() && !costs_little(*line.knob) && !single(line, v, reserve)) return false;
    return true;
  }

  bool costs_little(const Knob& knob) const {
    return world_.kept && std::all_of(knob.values.begin(), knob.values.end(), [&](const KnobValue& value) {
             return value.own || world_.kept(run_of(knob, value)) > 0.0;
           });
  }

  /// How much a run is beaten by, as a factor's logarithm: the least that both of its figures must fall by until no
  /// other run beats it. 0: it is on the front.
  double behind(double seconds, double error) const {
    double most = 0.0;
    for (const MeasuredRun& other : trade_.runs)
      if (other.refused.empty() && !other.repeats.empty())
        most = std::max(most, std::min(std::log(seconds / seconds_of(other)), std::log(error / error_of(other))));
    return most;
  }
  double behind(const MeasuredRun& run) const { return behind(seconds_of(run), error_of(run)); }

  struct Candidate {
    MeasuredRun run;
    double seconds = 0.0, error = 0.0; ///< foretold
    double cost = 0.0;                 ///< of a first measurement; asked once, as a scene may be read for it
    double rank = 0.0;
  };

  /// What the run of a value showed, against that of the value that a setting has; absent: not measured.
  const MeasuredRun* shown(const Line& line, std::optional<std::size_t> value) const {
    const auto at = value ? line.of_value.find(*value) : line.of_value.end();
    const MeasuredRun& run = at == line.of_value.end() ? start() : trade_.runs[at->second];
    return run.refused.empty() ? &run : nullptr;
  }

  /// The setting of a run with another value of a knob: the time and the error change by what the knob alone has shown.
  std::optional<Candidate> moved(const MeasuredRun& from, const Line& line, std::size_t place) const {
    const Knob& knob = *line.knob;
    const KnobValue& value = knob.values[place];
    const std::string& method = own().setting.method;
    if (!goes_with(from.setting.overrides, knob, value, method)) return std::nullopt;
    const MeasuredRun *after = shown(line, place), *before = shown(line, value_in(from.setting.overrides, knob));
    if (line.of_value.count(place) == 0 || after == nullptr || before == nullptr) return std::nullopt;
    Candidate candidate;
    candidate.run.setting.overrides = with_value(from.setting.overrides, knob, value, knobs_, method);
    candidate.run.name =
        name_about(candidate.run.setting.overrides, start().setting.overrides, start().name, knobs_, method);
    constexpr double least_left = 0.3; // of a sum that would be less
    candidate.seconds =
        std::max(seconds_of(from) + seconds_of(*after) - seconds_of(*before), least_left * seconds_of(from));
    candidate.error = std::max(error_of(from) + error_of(*after) - error_of(*before), least_left * error_of(from));
    candidate.rank = behind(candidate.seconds, candidate.error);
    return candidate;
  }

  std::vector<Candidate> candidates() const {
    // Logarithms: a quarter slower and less accurate than the front; twice so, by what is foretold.
    constexpr double near = 0.25, hopeless = 0.7;
    std::set<Overrides> known;
    for (const MeasuredRun& run : trade_.runs)
      known.insert(run.setting.overrides);
    std::vector<Candidate> all;
    for (const MeasuredRun& from : trade_.runs) {
      if (!from.refused.empty() || behind(from) > near) continue;
      for (const Line& line : lines_)
        for (std::size_t v = 0; v < line.knob->values.size() && !line.knob->is_of_several_keys; ++v)
          if (auto candidate = moved(from, line, v);
              candidate && candidate->rank <= hopeless && known.insert(candidate->run.setting.overrides).second) {
            candidate->cost = cost_of(candidate->run, candidate->seconds);
            all.push_back(*candidate);
          }
    }
    std::stable_sort(all.begin(), all.end(), [&](const auto& a, const auto& b) {
      return a.rank != b.rank ? a.rank < b.rank : a.cost < b.cost;
    });
    if (all.size() > options_.candidates) all.resize(options_.candidates);
    return all;
  }

  /// The better half of the runs at these places.
  std::vector<std::size_t> better_half(std::vector<std::size_t> places) const {
    std::stable_sort(places.begin(), places.end(),
                     [&](std::size_t a, std::size_t b) { return behind(trade_.runs[a]) < behind(trade_.runs[b]); });
    places.resize((places.size() + 1) / 2);
    return places;
  }

  bool again(std::size_t at) {
    MeasuredRun& run = trade_.runs[at];
    if (is_settled(run, options_) || seconds_of(run) > world_.left()) return true;
    return world_.measure(run, world_.left());
  }

  bool combinations() {
    constexpr double for_repeats = 0.3; // of the budget left now
    const double reserve = for_repeats * world_.left();
    for (;;) {
      std::vector<std::size_t> places;
      const std::size_t before = trade_.runs.size();
      for (const Candidate& candidate : candidates()) {
        if (candidate.cost > std::min(world_.left() - reserve, longest_)) continue;
        const std::size_t at = place_of(candidate.run);
        if (!once(at, std::min(world_.left(), longest_))) return false;
        if (trade_.runs[at].refused.empty()) places.push_back(at);
      }
      if (places.empty() || trade_.runs.size() == before) return true;
      for (unsigned repeat = 1; repeat < options_.repeats; ++repeat) {
        places = better_half(places);
        for (const std::size_t at : places)
          if (world_.left() > reserve && !again(at)) return false;
      }
    }
  }

  bool repeats() {
    for (const bool front_only : {true, false})
      for (unsigned repeat = 1; repeat < options_.repeats; ++repeat) {
        const std::vector<std::size_t> front = mark_front(trade_);
        for (std::size_t at = 0; at < trade_.runs.size(); ++at) {
          if (front_only && at > 0 && std::find(front.begin(), front.end(), at) == front.end()) continue;
          if (!again(at)) return false;
        }
      }
    return true;
  }

  void tell_curves() {
    trade_.knobs.clear();
    for (const Line& line : lines_) {
      KnobCurve curve{line.knob->name, {}, line.knob->falls, {}};
      if (start_ != 0 && line.knob->left_out.empty() && !line.knob->is_of_several_keys) curve.about = start().name;
      for (const std::size_t at : line.runs)
        curve.runs.push_back(trade_.runs[at].name);
      curve.finding = finding_of(trade_, *line.knob, curve, line.skipped);
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
  return run.repeats.size() > 1 && run.seconds.high - run.seconds.low < 2.0 * options.steady * run.seconds.value;
}

Estimate estimate_of_repeats(const std::vector<double>& seconds) {
  if (seconds.empty()) return {};
  const auto [least, most] = std::minmax_element(seconds.begin(), seconds.end());
  return {median_of_repeats(seconds), *least, *most};
}

} // namespace pointgi
