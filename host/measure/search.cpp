#include "host/measure/search.h"
#include "host/measure/candidates.h"
#include "host/measure/moves.h"
#include "host/repeats.h"
#include <algorithm>
#include <cmath>
#include <limits>

namespace pointgi {

namespace {

double seconds_of(const MeasuredRun& run) {
  return point_of(run).seconds;
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
    const bool whole = choose_start() && singles() && confirm_rises() && combinations(best_candidates) &&
                       repeats(true) && combinations(near_candidates) && repeats(false);
    mark_front(trade_);
    if (!lines_.empty()) tell_curves();
    return whole;
  }

private:
  /// The place of the run that has the same settings, whatever its name.
  std::size_t known_place(const MeasuredRun& run) const {
    const auto is_same = [&](const MeasuredRun& one) { return one.setting.overrides == run.setting.overrides; };
    return static_cast<std::size_t>(std::find_if(trade_.runs.begin(), trade_.runs.end(), is_same) -
                                    trade_.runs.begin());
  }

  bool is_known(const MeasuredRun& run) const { return known_place(run) < trade_.runs.size(); }

  /// The same, the run being added where there is none. What is kept of runs is found by their names: one that other
  /// settings have, as those of an earlier measurement may, is not given again.
  std::size_t place_of(MeasuredRun run) {
    if (is_known(run)) return known_place(run);
    const auto is_taken = [&](const std::string& name) {
      return std::any_of(trade_.runs.begin(), trade_.runs.end(), [&](const auto& one) { return one.name == name; });
    };
    if (is_taken(run.name)) run.name = name_of_overrides(run.setting.overrides);
    const std::string name = run.name;
    for (int number = 2; is_taken(run.name); ++number)
      run.name = name + "_" + std::to_string(number);
    trade_.runs.push_back(std::move(run));
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
    run.name = run.setting.overrides == start().setting.overrides ? start().name
                                                                  : start().name + "_" + knob.name + "-" + value.text;
    return run;
  }

  /// How long the next value of a knob will take, by those before it.
  double next_seconds(const KnobLine& line) const {
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
  void foretell(KnobLine& line) const {
    const Knob& knob = *line.knob;
    if (line.next >= knob.values.size()) return;
    const MeasuredRun run = run_of(knob, knob.values[line.next]);
    line.cost = is_known(run) ? 0.0 : cost_of(run, next_seconds(line));
  }

  /// How much later than its cost says a value's turn comes: knobs that the scene's own method reads come first, those
  /// of methods that are far from the front and those for which other kernels have to be built come last.
  double patience(const KnobLine& line) const {
    constexpr double soon = 1.0, later = 1.5, last = 4.0, far = 0.5; // of a logarithm
    const Knob& knob = *line.knob;
    if (knob.is_of_program()) return last;
    if (knob.method.empty() || knob.method == own().setting.method) return knob.is_of_several_keys ? later : soon;
    const auto is_near = [&](std::size_t at) {
      return trade_.runs[at].refused.empty() && behind_of(trade_.runs[at]) <= far;
    };
    return line.runs.empty() || std::any_of(line.runs.begin(), line.runs.end(), is_near) ? later : last;
  }

  bool single(KnobLine& line, double reserve) {
    foretell(line); // what was kept may have made room since
    const std::size_t place = line.next++;
    const KnobValue& value = line.knob->values[place];
    const MeasuredRun run = run_of(*line.knob, value);
    if (!is_known(run) && (!line.ended.empty() || line.cost > std::min(world_.left() - reserve, longest_))) {
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
    if (!trade_.runs[at].refused.empty() && line.knob->falls && line.ended.empty()) line.ended = value.text;
    return true;
  }

  /// Of all knobs the cheapest of their next values, until none fits.
  bool singles() {
    const double reserve = (1.0 - options_.singles_share) * world_.left();
    for (const Knob& knob : knobs_) {
      KnobLine line;
      line.knob = &knob;
      foretell(line);
      lines_.push_back(std::move(line));
    }
    for (;;) {
      KnobLine* next = nullptr;
      for (KnobLine& line : lines_)
        if (line.next < line.knob->values.size() &&
            (next == nullptr || patience(line) * line.cost < patience(*next) * next->cost))
          next = &line;
      if (next == nullptr) return true;
      if (!single(*next, reserve)) return false;
      foretell(*next);
    }
  }

  /// Where the error rises against theory, that may be chance of one seed: others tell. False where it is to end.
  bool confirm_rise(MeasuredRun& before, MeasuredRun& after, double least_left) {
    while (rises(before, after, world_.change) &&
           std::min(before.repeats.size(), after.repeats.size()) < options_.repeats)
      for (MeasuredRun* run : {&before, &after}) {
        const std::size_t known = run->repeats.size();
        if (known >= options_.repeats) continue;
        if (seconds_of(*run) > world_.left() - least_left) return true;
        if (!world_.measure(*run, world_.left() - least_left)) return false;
        if (run->repeats.size() == known) return true; // the time was over
      }
    return true;
  }

  bool confirm_rises() {
    constexpr double share = 0.25; // of what is left
    const double least_left = (1.0 - share) * world_.left();
    for (const KnobLine& line : lines_) {
      std::vector<std::size_t> done;
      for (const std::size_t at : line.runs)
        if (trade_.runs[at].refused.empty()) done.push_back(at);
      for (std::size_t i = 1; i < done.size() && line.knob->falls; ++i)
        if (!confirm_rise(trade_.runs[done[i - 1]], trade_.runs[done[i]], least_left)) return false;
    }
    return true;
  }

  double behind_of(const MeasuredRun& run) const { return behind(point_of(run), points_of(trade_)); }

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

  TriedKnobs tried() const {
    return {trade_,
            knobs_,
            lines_,
            start_,
            options_.steady,
            options_.candidates,
            [this](const MeasuredRun& run, double seconds) { return cost_of(run, seconds); }};
  }

  using Candidates = std::vector<Candidate> (*)(const TriedKnobs&, double);

  bool combinations(Candidates candidates) {
    constexpr double most_for_repeats = 0.5, little = 0.25;
    // All are compared with the scene's own.
    if (seconds_of(own()) < little * world_.left() && !again(0)) return false;
    const double most_reserved = most_for_repeats * world_.left();
    for (;;) {
      const double reserve = std::min(most_reserved, seconds_of_second_runs());
      std::vector<std::size_t> places;
      const std::size_t before = trade_.runs.size();
      for (const Candidate& candidate : candidates(tried(), world_.left() - reserve)) {
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
    for (KnobLine& line : lines_) {
      KnobCurve curve{line.knob->name, {}, line.knob->falls, {}};
      if (start_ != 0 && line.knob->left_out.empty() && !line.knob->is_of_several_keys) curve.about = start().name;
      for (const std::size_t at : line.runs)
        curve.runs.push_back(trade_.runs[at].name);
      curve.values = line.values;
      for (const KnobValue& value : line.knob->values)
        if (value.in_scene) curve.own = value.text;
      std::string why = line.ended.empty() ? "for want of time" : "as " + line.ended + " was refused";
      std::vector<std::string> skipped = line.skipped;
      for (; line.next < line.knob->values.size(); ++line.next) {
        skipped.push_back(line.knob->values[line.next].text);
        why = "before it was ended";
      }
      curve.finding = finding_of(trade_, *line.knob, curve, {skipped, why}, world_.change);
      trade_.knobs.push_back(curve);
    }
  }

  Trade& trade_;
  const std::vector<Knob>& knobs_;
  const SearchWorld& world_;
  const SearchOptions& options_;
  double longest_ = std::numeric_limits<double>::infinity();
  std::size_t start_ = 0; ///< the run about which knobs are turned
  std::vector<KnobLine> lines_;
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
