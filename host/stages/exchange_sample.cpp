#include "host/stages/exchange_sample.h"
#include "host/cache/vmap_cache.h"
#include "host/cl/batches.h"
#include "host/radiosity/direction_set.h"
#include "host/stages/device_need.h"
#include "octree/clock.h"
#include <algorithm>
#include <cmath>

namespace pointgi {

namespace {

/// Rays of the solution that tells how many applies there will be, and of the points that tell what a ray of
/// "directions" costs: each about half a second of two cores.
constexpr double coarse_rays = 6e5, traced_rays = 1e6;
constexpr int fewest_directions = 4;
/// Neighbours that stay together where rays of neighbours go together.
constexpr std::size_t neighbours = 256;
/// Points of the samples: pairs of 1500 are a million, and so are the rays of a map of 3000.
constexpr std::size_t pair_points = 1500, map_points = 3000, first_points = 256;
constexpr std::uint64_t most_left = std::uint64_t{1} << 60; ///< room for all hits
/// Of solutions that only tell what an apply costs.
constexpr double loose = 0.5;

void quiet(const std::string&) {}

/// The scene with some of the points that exchange light, `together` of them from each of evenly spaced places of the
/// pool; all still block it.
class ThinScene {
public:
  ThinScene(const ExchangeScene& whole, std::size_t most, std::size_t together = 1) : whole_(whole) {
    const std::vector<std::uint32_t> places = exchanging_points(whole);
    points_.assign(whole.points.begin(), whole.points.end());
    exchanges_.assign(whole.exchanges.begin(), whole.exchanges.end());
    for (const Splat& s : points_)
      exchanges_.resize(std::max(exchanges_.size(), material_of(s) + 1), 1);
    const auto other = static_cast<float>(exchanges_.size());
    exchanges_.push_back(0);
    const double share =
        std::min(1.0, static_cast<double>(most) / static_cast<double>(std::max<std::size_t>(1, places.size())));
    double at = 0.0;
    for (std::size_t first = 0; first < places.size(); first += together) {
      const std::size_t end = std::min(places.size(), first + together);
      if ((at += share) >= 1.0 - 1e-9) {
        at -= 1.0;
        count_ += end - first;
        continue;
      }
      for (std::size_t k = first; k < end; ++k) // what sides it has stays
        points_[places[k]].material += other - std::floor(points_[places[k]].material);
    }
    ratio_ = count_ > 0 ? static_cast<double>(places.size()) / static_cast<double>(count_) : 1.0;
  }

  /// Those that are left stand for all: they send as much, and the light goes as often from bounce to bounce.
  void spread_areas() {
    for (Splat& s : points_)
      s.area *= static_cast<float>(ratio_);
  }

  ExchangeScene scene() const {
    ExchangeScene thin = whole_;
    thin.points = points_;
    thin.exchanges = exchanges_;
    return thin;
  }
  std::size_t count() const { return count_; }
  double ratio() const { return ratio_; } ///< all points over these

private:
  const ExchangeScene& whole_;
  std::vector<Splat> points_;
  std::vector<std::uint8_t> exchanges_;
  std::size_t count_ = 0;
  double ratio_ = 1.0;
};

/// A method at work.
struct Worked {
  std::unique_ptr<PreparedRadiosity> prepared;
  double prepare_seconds = 0.0, solve_seconds = 0.0;
  unsigned applies = 0; ///< of the solution, and the last one that gathers; or passes
  std::uint64_t bytes = 0;
  Solution solution;

  double apply_seconds() const { return solve_seconds / std::max(1u, applies); }
};

Worked work(Session& session, const RadiosityMethod& method, const ExchangeScene& scene,
            const RadiositySettings& settings, const EnteringLight& light, double tolerance,
            std::optional<RadiosityMap> map = {}) {
  Worked worked;
  const std::uint64_t held = session.held_bytes();
  Clock::time_point begin = Clock::now();
  worked.prepared = method.prepare(session, scene, settings, std::move(map), quiet);
  worked.prepare_seconds = seconds_since(begin);
  worked.bytes = session.held_bytes() - std::min(held, session.held_bytes());
  begin = Clock::now();
  worked.solution = worked.prepared->solve(light, tolerance, quiet).solution;
  worked.solve_seconds = seconds_since(begin);
  worked.applies = worked.solution.applies + (method.has_passes ? 0u : 1u);
  return worked;
}

/// Seconds of the device in a kernel until now.
double kernel_seconds(const Session& session, const char* kernel) {
  const auto found = session.kernel_times().find(kernel);
  return found == session.kernel_times().end() ? 0.0 : found->second.seconds;
}

double statistic(const PreparedRadiosity& prepared, const std::string& name) {
  for (const MethodStatistic& s : prepared.statistics())
    if (name == s.name) return static_cast<double>(s.value);
  return 0.0;
}

class Sampler {
public:
  Sampler(Session& session, const ExchangeScene& exchange, const RadiositySettings& settings,
          const RadiosityMethod& method, const ExchangeKnown& known)
      : session_(session), exchange_(exchange), settings_(settings), method_(method),
        known_(known), count_{exchanging_points(exchange).size(), exchange.points.size} {}

  ExchangeEstimate estimate() {
    if (count_.points == 0) return {};
    const std::string name = method_.name;
    estimate_.method_bytes = exchange_need(name, settings_, count_, session_.bytes_left()).usual;
    if (name == "gather") {
      sample_gather();
      return std::move(estimate_);
    }
    const Worked coarse = solve_coarsely();
    estimate_.applies = coarse.applies;
    if (name == "directions")
      sample_directions(coarse);
    else if (name == "fmm")
      sample_fmm();
    else if (name == "cones")
      sample_cones();
    else if (name == "direct")
      sample_direct();
    return std::move(estimate_);
  }

private:
  Worked warm(const RadiositySettings& settings, std::optional<RadiosityMap> map = {}) {
    const ThinScene few(exchange_, first_points);
    return work(session_, method_, few.scene(), settings, known_.light, loose, std::move(map));
  }

  /// By few directions, whatever the method.
  Worked solve_coarsely() {
    const RadiosityMethod& directions = *radiosity_method("directions");
    RadiositySettings few = settings_;
    few.directions = std::clamp(static_cast<int>(coarse_rays / static_cast<double>(count_.points)),
                                std::min(fewest_directions, settings_.directions), settings_.directions);
    few.direction_set = "stratified";
    const ThinScene first(exchange_, first_points);
    work(session_, directions, first.scene(), few, known_.light, loose);
    const double received = kernel_seconds(session_, "receive_by_directions"),
                 traced = kernel_seconds(session_, "trace_directions");
    Worked coarse = work(session_, directions, exchange_, few, known_.light, settings_.tolerance);
    coarse_receive_ = kernel_seconds(session_, "receive_by_directions") - received;
    coarse_trace_ = kernel_seconds(session_, "trace_directions") - traced;
    return coarse;
  }

  /// Rays of all directions from some points: of few directions fewer go together. What is done with the hits, and what
  /// the host does, the coarse solution tells.
  void sample_directions(const Worked& coarse) {
    const bool hemicube = settings_.direction_set == "hemicube";
    const auto all =
        static_cast<double>(direction_set(hemicube ? DirectionPattern::hemicube : DirectionPattern::stratified,
                                          static_cast<unsigned>(settings_.directions))
                                .weights.size());
    if (hemicube) warm(settings_);
    const ThinScene thin(exchange_, static_cast<std::size_t>(std::max(traced_rays / all, 64.0)), neighbours);
    const double traced = kernel_seconds(session_, "trace_directions");
    const Worked worked = work(session_, method_, thin.scene(), settings_, known_.light, loose);
    const double trace = thin.ratio() * (kernel_seconds(session_, "trace_directions") - traced);
    const double ratio = all / std::max(1.0, statistic(*coarse.prepared, "directions"));
    const auto need = [&](std::uint64_t left) {
      return static_cast<double>(exchange_need("directions", settings_, count_, left).usual);
    };
    // Hits that are not kept are traced again.
    const double again = coarse.applies * (1.0 - need(session_.bytes_left()) / need(most_left));
    estimate_.solve_seconds = coarse.solve_seconds + (ratio - 1.0) * coarse_receive_ + again * trace;
    estimate_.prepare_seconds = coarse.prepare_seconds - coarse_trace_ + trace;
    estimate_.rays = static_cast<double>(count_.points) * all * (1.0 + again);
  }

  RadiosityMap thin_map(const ThinScene& thin) {
    const NoVMapsKept anew;
    return find_visibility(session_, thin.scene(), settings_, cluster_points(session_, thin.scene(), settings_),
                           LinkEstimate{}, quiet);
  }

  void sample_fmm() {
    const ThinScene few(exchange_, first_points), thin(exchange_, map_points);
    work(session_, method_, few.scene(), settings_, known_.light, loose, thin_map(few));
    RadiosityMap map = thin_map(thin);
    const double made = static_cast<double>(map.vmap.links.size()),
                 asked = static_cast<double>(map.vmap.statistics.rays);
    const LinkEstimate made_links{0.0, made, asked,
                                  made * sizeof(Link) + static_cast<double>(map.vmap.point_shares.size())};
    const auto order = static_cast<unsigned>(settings_.order);
    const double thin_bytes = static_cast<double>(fmm_bytes(map.tree, order, made_links));
    const Worked worked = work(session_, method_, thin.scene(), settings_, known_.light, loose, std::move(map));
    LinkEstimate all = known_.links;
    const double most = static_cast<double>(most_vmap_rays(settings_, count_.points));
    if (most > 0.0 && all.rays > most) // what is left then is taken as it is
      for (double LinkEstimate::*figure :
           {&LinkEstimate::links, &LinkEstimate::bytes, &LinkEstimate::seconds, &LinkEstimate::rays})
        all.*figure *= most / all.rays;
    const double more_links = made > 0.0 ? all.links / made : 1.0;
    estimate_.vmap_seconds = all.seconds;
    estimate_.prepare_seconds = more_links * worked.prepare_seconds;
    estimate_.solve_seconds = more_links * estimate_.applies * worked.apply_seconds();
    estimate_.links = all.links;
    estimate_.rays = all.rays;
    const double rays_a_second = all.rays / std::max(1e-6, all.seconds);
    estimate_.vmap_bytes = vmap_bytes(
        count_.points, static_cast<std::size_t>(std::clamp(launch_seconds * rays_a_second, 16384.0, 4194304.0)));
    estimate_.method_bytes = static_cast<std::uint64_t>(static_cast<double>(fmm_bytes(known_.tree, order, all)) *
                                                        static_cast<double>(worked.bytes) / std::max(1.0, thin_bytes));
  }

  void sample_cones() {
    RadiositySettings first = settings_;
    first.voxels = 32;
    warm(first);
    Worked worked = work(session_, method_, exchange_, settings_, known_.light, loose);
    estimate_.prepare_seconds = worked.prepare_seconds;
    estimate_.solve_seconds = estimate_.applies * worked.apply_seconds();
    estimate_.method_bytes =
        std::max(worked.bytes, exchange_need("cones", settings_, count_, 0).least) + sizeof(cl_float4) * count_.pool;
    estimate_.at_pixels = worked.prepared->cones_of(known_.light.direct);
  }

  void sample_direct() {
    warm(settings_);
    const ThinScene thin(exchange_, pair_points);
    const Worked worked = work(session_, method_, thin.scene(), settings_, known_.light, loose);
    const double pairs = thin.ratio() * thin.ratio();
    estimate_.prepare_seconds = pairs * worked.prepare_seconds;
    estimate_.solve_seconds = pairs * estimate_.applies * worked.apply_seconds();
    estimate_.rays = pairs * static_cast<double>(worked.prepared->rays());
  }

  /// One pass, and some: those after the first read what it has seen, where that is kept. Their light tells how many
  /// there will be: that of few senders fades otherwise than that of all.
  void sample_gather() {
    ThinScene thin(exchange_, pair_points);
    thin.spread_areas();
    const bool all = settings_.sampling == "all";
    constexpr unsigned more = 8;
    RadiositySettings one = settings_;
    one.window = std::max(1, static_cast<int>(std::lround(settings_.window / thin.ratio())));
    one.passes = 1;
    warm(one);
    const Worked first = work(session_, method_, thin.scene(), one, known_.light, loose);
    one.passes = 1 + more;
    const Worked some = work(session_, method_, thin.scene(), one, known_.light, settings_.tolerance);
    const double later_passes = std::max(1.0, some.applies - 1.0);
    const double a_pass = std::max(0.0, some.solve_seconds - first.solve_seconds) / later_passes;
    estimate_.applies = settings_.passes > 0 ? static_cast<unsigned>(settings_.passes)
                                             : passes_until(some.solution.history, settings_.tolerance);
    const double pairs = thin.ratio() * (all ? thin.ratio() : thin.ratio() * one.window / settings_.window);
    estimate_.prepare_seconds = pairs * first.prepare_seconds;
    estimate_.solve_seconds = pairs * (first.solve_seconds + (estimate_.applies - 1.0) * a_pass);
    const double rays = static_cast<double>(first.prepared->rays()),
                 later = (static_cast<double>(some.prepared->rays()) - rays) / later_passes;
    estimate_.rays = pairs * (rays + (estimate_.applies - 1.0) * later);
  }

  Session& session_;
  const ExchangeScene& exchange_;
  const RadiositySettings& settings_;
  const RadiosityMethod& method_;
  const ExchangeKnown& known_;
  ExchangedCount count_;
  double coarse_receive_ = 0.0, coarse_trace_ = 0.0; ///< seconds of the device
  ExchangeEstimate estimate_;
};

} // namespace

ExchangeEstimate sample_exchange(Session& session, const ExchangeScene& exchange, const RadiositySettings& settings,
                                 const RadiosityMethod& method, const ExchangeKnown& known) {
  return Sampler(session, exchange, settings, method, known).estimate();
}

unsigned passes_until(const std::vector<double>& history, double tolerance) {
  constexpr unsigned most = 10000; // as solve_by_bounces ends
  double before = 1.0, residual = 1.0, rate = 0.0;
  for (unsigned pass = 1; pass < most; ++pass) {
    if (pass <= history.size())
      residual = history[pass - 1];
    else
      residual *= rate;
    rate = std::min(1.0, residual / before);
    before = residual;
    if (!(residual > 0.0) || residual * rate <= tolerance * std::max(1e-12, 1.0 - rate)) return pass;
  }
  return most;
}

} // namespace pointgi
