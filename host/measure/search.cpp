#include "host/measure/search.h"
#include "host/repeats.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
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

std::string key_of(const std::string& override_text) {
  return override_text.substr(0, override_text.find('='));
}

/// Both lists of overrides in one, or none where they want other values of one key.
std::optional<std::vector<std::string>> together(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  std::vector<std::string> all = a;
  for (const std::string& one : b) {
    const auto same_key = std::find_if(all.begin(), all.end(), [&](const auto& x) { return key_of(x) == key_of(one); });
    if (same_key == all.end())
      all.push_back(one);
    else if (*same_key != one)
      return std::nullopt;
  }
  std::sort(all.begin(), all.end());
  return all;
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
    longest_ = std::max({options_.longest_share * budget, 3.0 * seconds_of(trade_.runs.front()), least_limit});
    const bool whole = singles() && combinations() && repeats();
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

  /// A first repetition, where there is none. A run that has never been measured does not stay.
  bool once(std::size_t at, double most) {
    MeasuredRun& run = trade_.runs[at];
    if (!run.repeats.empty() || !run.refused.empty()) return true;
    if (world_.measure(run, most)) return true;
    trade_.runs.erase(trade_.runs.begin() + static_cast<std::ptrdiff_t>(at));
    return false;
  }

  /// What the next value of a knob will cost, by those before it.
  double next_cost(const std::vector<std::size_t>& before) const {
    std::vector<double> costs;
    for (const std::size_t i : before)
      if (trade_.runs[i].refused.empty()) costs.push_back(seconds_of(trade_.runs[i]));
    const double own = seconds_of(trade_.runs.front());
    if (costs.empty()) return own;
    if (costs.size() == 1) return costs.back() * 2.0;
    return costs.back() * std::clamp(costs.back() / costs[costs.size() - 2], 1.0, fastest_growth);
  }

  struct Line {
    const Knob* knob;
    std::vector<std::size_t> runs;
    std::vector<std::string> skipped;
    bool ended = false; ///< dearer values would not fit either
  };

  bool single(Line& line, const KnobValue& value, double reserve) {
    MeasuredRun run;
    run.name = value.own ? own_name : line.knob->name + "-" + value.text;
    run.setting.knob = line.knob->name;
    run.setting.value = value.text;
    run.setting.overrides = value.overrides;
    std::sort(run.setting.overrides.begin(), run.setting.overrides.end());
    const bool known = std::any_of(trade_.runs.begin(), trade_.runs.end(),
                                   [&](const MeasuredRun& other) { return other.name == run.name; });
    const double room = world_.left() - reserve;
    if (!known && (line.ended || next_cost(line.runs) > std::min(room, longest_))) {
      line.skipped.push_back(value.text);
      return true;
    }
    const std::size_t at = place_of(run);
    if (!once(at, std::min(world_.left(), longest_))) return false;
    line.runs.push_back(at);
    line.ended = line.ended || (!trade_.runs[at].refused.empty() && line.knob->falls);
    return true;
  }

  bool singles() {
    const double reserve = (1.0 - options_.singles_share) * world_.left();
    for (const Knob& knob : knobs_)
      lines_.push_back({&knob, {}, {}, false});
    std::size_t most = 0;
    for (const Knob& knob : knobs_)
      most = std::max(most, knob.values.size());
    for (std::size_t v = 0; v < most; ++v)
      for (Line& line : lines_)
        if (v < line.knob->values.size() && !single(line, line.knob->values[v], reserve)) return false;
    return true;
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
    double seconds = 0.0, rank = 0.0;
  };

  /// Two settings together: what each saves in time is saved, what each adds to the error is added.
  std::optional<Candidate> combined(const MeasuredRun& a, const MeasuredRun& b) const {
    const MeasuredRun& own = trade_.runs.front();
    const auto overrides = together(a.setting.overrides, b.setting.overrides);
    if (!overrides || *overrides == a.setting.overrides || *overrides == b.setting.overrides) return std::nullopt;
    Candidate candidate;
    for (const std::string& one : *overrides) {
      const std::string key = key_of(one);
      candidate.run.name += (candidate.run.name.empty() ? "" : "_") + key.substr(key.rfind('.') + 1) + "-" +
                            one.substr(one.find('=') + 1);
    }
    candidate.run.setting.overrides = *overrides;
    candidate.seconds = std::max(1e-6, seconds_of(a) * seconds_of(b) / seconds_of(own));
    // Where both are better than the scene's own, the sum of the gains would be below what is possible.
    const double error = std::max(error_of(a) + error_of(b) - error_of(own), 0.5 * std::min(error_of(a), error_of(b)));
    candidate.rank = std::max(std::log(candidate.seconds / seconds_of(own)), std::log(error / error_of(own))) < 0.0
                         ? -1.0 // better than the scene's own in both
                         : behind(candidate.seconds, error);
    return candidate;
  }

  std::vector<Candidate> candidates() const {
    // Logarithms: a quarter slower and less accurate than the front; twice so, by what is foretold.
    constexpr double near = 0.25, hopeless = 0.7;
    std::vector<const MeasuredRun*> parents, singles;
    std::set<std::string> names;
    for (const MeasuredRun& run : trade_.runs) {
      names.insert(run.name);
      if (!run.refused.empty() || run.name == own_name) continue;
      if (behind(run) <= near) parents.push_back(&run);
      if (!run.setting.knob.empty()) singles.push_back(&run);
    }
    std::vector<Candidate> all;
    for (const MeasuredRun* parent : parents)
      for (const MeasuredRun* single : singles)
        if (auto candidate = combined(*parent, *single);
            candidate && candidate->rank <= hopeless && names.insert(candidate->run.name).second)
          all.push_back(*candidate);
    std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.rank < b.rank; });
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
      for (const Candidate& candidate : candidates()) {
        if (candidate.seconds > std::min(world_.left() - reserve, longest_)) continue;
        const std::size_t at = place_of(candidate.run);
        if (!once(at, std::min(world_.left(), longest_))) return false;
        if (trade_.runs[at].refused.empty()) places.push_back(at);
      }
      if (places.empty()) return true;
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
