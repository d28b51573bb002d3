/// The order of measurements, driven by a model whose times and errors are known.
#include "host/measure/finding.h"
#include "host/measure/front_gain.h"
#include "host/measure/search.h"
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

using namespace pointgi;

namespace {

/// Two knobs: samples, whose noise falls as 1 over them and whose time grows with them, and rays of the light, whose
/// error is added. Runs take time from a clock of the model's own.
struct Model {
  double clock = 0.0, budget = 0.0;
  std::size_t runs = 0;
  std::size_t end_after = 1'000'000; ///< runs, after which the user stops it
  bool steady = false;               ///< else a second run takes longer

  static double value_of(const MeasuredRun& run, const std::string& key, double otherwise) {
    for (const std::string& text : run.setting.overrides)
      if (text.rfind(key + "=", 0) == 0) return std::stod(text.substr(key.size() + 1));
    return otherwise;
  }
  static double seconds(double spp, double rays) { return 0.2 + 0.01 * spp + 0.002 * rays; }
  static double error(double spp, double rays) { return 0.1 / spp + 1.0 / rays; }

  bool measure(MeasuredRun& run, double most) {
    if (++runs > end_after) return false;
    const double spp = value_of(run, "a.spp", 32), rays = value_of(run, "b.rays", 512);
    const double took = seconds(spp, rays);
    if (took > most) {
      clock += most;
      if (run.repeats.empty()) run.refused = "too long";
      return true;
    }
    clock += took;
    run.repeats.push_back(took * (steady || run.repeats.size() % 2 == 0 ? 1.0 : 1.3));
    run.seconds = estimate_of_repeats(run.repeats);
    const double e = error(spp, rays);
    run.error = {e, 0.95 * e, 1.05 * e};
    return true;
  }
  SearchWorld world() {
    return {[this](MeasuredRun& run, double most) { return measure(run, most); }, [this] { return budget - clock; }};
  }
};

std::vector<Knob> knobs() {
  Knob spp{"spp", "a.spp", true, "Noise falls.", {}}, rays{"rays", "b.rays", true, "Noise falls.", {}};
  for (const int n : {2, 8, 32, 128})
    spp.values.push_back({std::to_string(n), {"a.spp=" + std::to_string(n)}, n == 32, n == 32});
  for (const int n : {32, 128, 512, 2048})
    rays.values.push_back({std::to_string(n), {"b.rays=" + std::to_string(n)}, n == 512, n == 512});
  return {spp, rays};
}

Trade searched(double budget, Model& model) {
  model.budget = budget;
  Trade trade;
  search(trade, knobs(), model.world());
  return trade;
}

/// Of all 16 combinations.
std::vector<std::pair<double, double>> true_front() {
  Trade all;
  for (const int spp : {2, 8, 32, 128})
    for (const int rays : {32, 128, 512, 2048}) {
      MeasuredRun run;
      run.seconds.value = Model::seconds(spp, rays);
      run.error.value = Model::error(spp, rays);
      all.runs.push_back(run);
    }
  std::vector<std::pair<double, double>> front;
  for (const std::size_t i : mark_front(all))
    front.emplace_back(all.runs[i].seconds.value, all.runs[i].error.value);
  return front;
}

} // namespace

TEST_CASE("with time enough the search finds the front of all combinations") {
  Model model;
  Trade trade = searched(1000.0, model);
  // By the model's own times, which repeats scatter around.
  for (MeasuredRun& run : trade.runs)
    run.seconds.value = Model::seconds(Model::value_of(run, "a.spp", 32), Model::value_of(run, "b.rays", 512));
  std::vector<std::pair<double, double>> front;
  for (const std::size_t i : mark_front(trade))
    front.emplace_back(trade.runs[i].seconds.value, trade.runs[i].error.value);
  CHECK(front == true_front());
  REQUIRE(trade.knobs.size() == 2);
  CHECK(trade.knobs[0].runs == std::vector<std::string>{"spp-2", "spp-8", "own", "spp-128"});
  CHECK(trade.knobs[0].finding == "falls");
  std::set<std::string> names;
  for (const MeasuredRun& run : trade.runs) {
    CHECK(names.insert(run.name).second);
    CHECK(is_settled(run, {}));
  }
}

TEST_CASE("the search keeps to its budget and uses it") {
  for (const double budget : {2.0, 5.0, 10.0, 20.0, 40.0}) {
    INFO(budget);
    Model model;
    const Trade trade = searched(budget, model);
    CHECK(model.clock <= 1.1 * budget);
    CHECK(!trade.runs.empty());
    CHECK(trade.runs.front().name == own_name);
    if (budget <= 20.0) CHECK(model.clock > 0.5 * budget);
  }
}

TEST_CASE("the search is the same each time") {
  Model a, b;
  CHECK(json_of(searched(15.0, a)) == json_of(searched(15.0, b)));
}

TEST_CASE("a search that was ended keeps what it has, and goes on") {
  Model ended;
  ended.end_after = 5;
  ended.budget = 1000.0;
  Trade trade;
  CHECK_FALSE(search(trade, knobs(), ended.world()));
  CHECK(trade.runs.size() >= 3);
  for (const MeasuredRun& run : trade.runs)
    CHECK_FALSE(run.repeats.empty());
  const std::vector<MeasuredRun> before = trade.runs;

  Model on;
  on.budget = 1000.0;
  CHECK(search(trade, knobs(), on.world()));
  for (std::size_t i = 0; i < before.size(); ++i) {
    CHECK(trade.runs[i].name == before[i].name);
    CHECK(trade.runs[i].repeats.size() >= before[i].repeats.size());
  }
  const std::size_t runs = trade.runs.size();
  Model idle;
  idle.budget = 1000.0;
  CHECK(search(trade, knobs(), idle.world()));
  CHECK(trade.runs.size() == runs);
  CHECK(idle.runs == 0); // all are settled
}

namespace {

TradePoint true_point(const MeasuredRun& run) {
  const double spp = Model::value_of(run, "a.spp", 32), rays = Model::value_of(run, "b.rays", 512);
  return {Model::seconds(spp, rays), Model::error(spp, rays)};
}

bool is_combination(const MeasuredRun& run) {
  return run.setting.overrides.size() == 2;
}

/// The area that the runs before the `end`th leave behind them.
double area_of(const std::vector<MeasuredRun>& runs, std::size_t end) {
  double area = 0.0;
  std::vector<TradePoint> points;
  for (std::size_t i = 0; i < end; ++i) {
    area += area_gained(true_point(runs[i]), points, {10.0, 0.1});
    points.push_back(true_point(runs[i]));
  }
  return area;
}

} // namespace

TEST_CASE("the settings that gain most for their cost come first") {
  Model model;
  model.steady = true;
  const Trade trade = searched(1000.0, model); // all but hopeless ones, in the order in which they were taken
  const auto first =
      static_cast<std::size_t>(std::find_if(trade.runs.begin(), trade.runs.end(), is_combination) - trade.runs.begin());
  REQUIRE(first == 7); // after the scene's own and the values of two knobs
  REQUIRE(trade.runs.size() > first + 6);
  // Of what is gained a second the first three have more than the three after them, and these more than all others.
  const auto pace = [&](std::size_t from, std::size_t to) {
    double seconds = 0.0;
    for (std::size_t i = from; i < to; ++i)
      seconds += true_point(trade.runs[i]).seconds;
    return (area_of(trade.runs, to) - area_of(trade.runs, from)) / seconds;
  };
  CHECK(pace(first, first + 3) > 1.5 * pace(first + 3, first + 6));
  CHECK(pace(first + 3, first + 6) > pace(first + 6, trade.runs.size()));
  // The very first has most of all that there are.
  double best = 0.0;
  for (const int spp : {2, 8, 32, 128})
    for (const int rays : {32, 128, 512, 2048}) {
      std::vector<MeasuredRun> more(trade.runs.begin(), trade.runs.begin() + static_cast<std::ptrdiff_t>(first));
      more.emplace_back().setting.overrides = {"a.spp=" + std::to_string(spp), "b.rays=" + std::to_string(rays)};
      best = std::max(best, (area_of(more, first + 1) - area_of(more, first)) / true_point(more.back()).seconds);
    }
  CHECK(pace(first, first + 1) == Approx(best));
}

TEST_CASE("what a dearer value costs is foretold by how the cost grows with the value") {
  Model model;
  model.budget = 40.0;
  std::vector<Knob> two = knobs();
  two[1].values.clear(); // own is 512, and beside it stands 500
  for (const int n : {32, 500, 512, 100000})
    two[1].values.push_back({std::to_string(n), {"b.rays=" + std::to_string(n)}, n == 512, n == 512});
  Trade trade;
  search(trade, two, model.world());
  for (const MeasuredRun& run : trade.runs)
    CHECK(run.refused.empty()); // 200 s are not begun
  CHECK_THAT(trade.knobs[1].finding, Catch::Contains("not measured for want of time: 100000"));
}

TEST_CASE("errors that are lost in the reference's noise do not look infinitely small") {
  Trade trade;
  Model model;
  model.budget = 1000.0;
  SearchWorld world = model.world();
  const auto measure = world.measure;
  world.measure = [&](MeasuredRun& run, double most) {
    if (!measure(run, most)) return false;
    if (Model::value_of(run, "b.rays", 512) == 2048) run.error = {-1e-5, -3e-3, 3e-3};
    return true;
  };
  CHECK(search(trade, knobs(), world));
  std::set<std::string> names;
  for (const MeasuredRun& run : trade.runs)
    names.insert(run.name);
  CHECK(names.count("spp-8_rays-128") == 1); // 20 times as fast, and not hopeless beside it
}

TEST_CASE("a curve that rises is told, against theory or not") {
  Trade trade;
  for (const double error : {1.0, 0.5, 0.8}) {
    MeasuredRun run;
    run.name = "k-" + std::to_string(trade.runs.size());
    run.repeats = {1.0};
    run.error = {error, 0.95 * error, 1.05 * error};
    trade.runs.push_back(run);
  }
  Knob knob{"k", "a.k", true, "It falls.", {}};
  const KnobCurve curve{"k", {"k-0", "k-1", "k-2"}, true, {}, "", {"0", "10", "20"}};
  CHECK_THAT(finding_of(trade, knob, curve, {}), Catch::Matches("the error rises from 10 to 20 \\(.*says why\\), "
                                                                "against theory. It falls."));
  trade.runs[1].noise = 0.1;
  trade.runs[2].noise = 0.3;
  CHECK_THAT(finding_of(trade, knob, curve, {}), Catch::Contains("noisier"));
  trade.runs[1].bias = -0.001;
  trade.runs[2].bias = 0.5;
  CHECK_THAT(finding_of(trade, knob, curve, {}), Catch::Contains("is off by +50 % and was by -0.1 %"));
  trade.runs[2].error = {0.5, 0.4, 0.6};
  CHECK(finding_of(trade, knob, curve, {{"9"}}) ==
        "falls up to 10, and changes by less than a twentieth from there on; not measured for want of time: 9");
  trade.runs[0].error = trade.runs[1].error;
  CHECK_THAT(finding_of(trade, knob, curve, {}), Catch::Contains("stays the same"));
  SECTION("what is known of the change tells more than the errors") {
    const auto by = [](double change) {
      return [change](const MeasuredRun&, const MeasuredRun&) {
        return Estimate{change, change - 0.01, change + 0.01};
      };
    };
    CHECK(finding_of(trade, knob, curve, {}, by(-0.02)) == "falls by less than a twentieth in all");
    CHECK_THAT(finding_of(trade, knob, curve, {}, by(0.03)), Catch::Contains("rises from 0 to 10"));
    CHECK_THAT(finding_of(trade, knob, curve, {}, by(0.02)), Catch::Contains("stays the same")); // a twenty-fifth
  }
  SECTION("of noise that is not known nothing is said") {
    trade.runs[2].error = {0.8, 0.75, 0.85};
    trade.runs[2].bias = 0.0;
    trade.runs[1].noise = std::numeric_limits<double>::infinity();
    CHECK_THAT(finding_of(trade, knob, curve, {}), Catch::Contains("says why"));
  }
}

TEST_CASE("of values that differ in kind the best is told") {
  Trade trade;
  for (const double error : {1.0, 0.5, 0.51}) {
    MeasuredRun run;
    run.name = "k-" + std::to_string(trade.runs.size());
    run.error = {error, 0.9 * error, 1.1 * error};
    trade.runs.push_back(run);
  }
  Knob knob{"k", "a.k", false, "They differ.", {}};
  const KnobCurve curve{"k", {"k-0", "k-1", "k-2"}, false, {}, "", {"none", "cones", "fmm"}};
  CHECK(finding_of(trade, knob, curve, {{"all"}}) ==
        "the least error is that of cones; by chance or by less than a twentieth differ fmm. They differ. "
        "Not measured for want of time: all");
  trade.runs[0].error = {0.55, 0.5, 0.6};
  CHECK_THAT(finding_of(trade, knob, curve, {{"all"}, "as fmm was refused"}),
             Catch::EndsWith(" Not measured as fmm was refused: all"));
  CHECK(finding_of(trade, knob, curve, {}) ==
        "no value has less error than the others, to within their intervals. They differ.");
  trade.runs[1].error = {0.1, 0.09, 0.11};
  CHECK(finding_of(trade, knob, curve, {}) == "the least error is that of cones. They differ.");
}

TEST_CASE("runs that an earlier measurement has left keep their names") {
  Model model;
  model.budget = 1000.0;
  Trade trade;
  MeasuredRun own, other;
  own.name = own_name;
  other.name = "spp-8"; // of another start
  other.setting.overrides = {"a.spp=8", "b.rays=4"};
  trade.runs = {own, other};
  CHECK(search(trade, knobs(), model.world()));
  std::set<std::string> names;
  std::set<std::vector<std::string>> settings;
  for (const MeasuredRun& run : trade.runs) {
    CHECK(names.insert(run.name).second);
    CHECK(settings.insert(run.setting.overrides).second);
  }
  CHECK(settings.count({"a.spp=8"}) == 1);
}

TEST_CASE("what two knobs have in common is measured once") {
  Model model;
  model.budget = 1000.0;
  std::vector<Knob> three = knobs();
  Knob other{"fewest", "b.rays", true, "Noise falls.", {}};
  other.values = {{"few", {"b.rays=32"}}, {"many", {"b.rays=2048"}}};
  three.push_back(other);
  Trade trade;
  CHECK(search(trade, three, model.world()));
  std::set<std::vector<std::string>> settings;
  for (const MeasuredRun& run : trade.runs)
    CHECK(settings.insert(run.setting.overrides).second);
  REQUIRE(trade.knobs.size() == 3);
  CHECK(trade.knobs[2].runs == std::vector<std::string>{trade.knobs[1].runs.front(), trade.knobs[1].runs.back()});
  CHECK(trade.knobs[2].values == std::vector<std::string>{"few", "many"});
  CHECK(trade.knobs[1].own == "512");
}

TEST_CASE("repeats are summed up by their median and range") {
  CHECK(estimate_of_repeats({}).value == 0.0);
  const Estimate e = estimate_of_repeats({3.0, 1.0, 2.0, 10.0});
  CHECK(e.value == 2.5);
  CHECK(e.low == 1.0);
  CHECK(e.high == 10.0);
}
