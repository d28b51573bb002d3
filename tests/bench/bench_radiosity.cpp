/// Radiosity by V-map and fast multipole method: how it grows with the points of one room, beside directions (one run
/// each); and against the direct solver, which traces a ray a pair: both run in turn, A B A B, and the median of the
/// pairs counts. bench_radiosity --help
#include "fmm/ref/direct_sum.h"
#include "fmm/solve/solve.h"
#include "host/passes/visibility.h"
#include "host/radiosity/direct.h"
#include "host/radiosity/fmm.h"
#include "host/radiosity/method.h"
#include "host/scene/scene.h"
#include "octree/vmap/make_links.h"
#include "tests/support/exchange.h"
#include "tests/support/lit_room.h"
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <random>

using namespace pointgi;

namespace {

struct Settings {
  float epsilon = static_cast<float>(RadiositySettings{}.epsilon);
  unsigned samples = static_cast<unsigned>(RadiositySettings{}.vmap_samples);
  unsigned point_samples = static_cast<unsigned>(RadiositySettings{}.point_samples);
  unsigned leaf = ClusterOptions{}.leaf_capacity;
  unsigned order = static_cast<unsigned>(RadiositySettings{}.order);
  double tolerance = RadiositySettings{}.tolerance;
};

/// Seconds on the clock, and on the device's.
struct Seconds {
  double wall = 0.0, device = 0.0;
  Seconds operator+(const Seconds& s) const { return {wall + s.wall, device + s.device}; }
};

class Stopwatch {
public:
  explicit Stopwatch(const Session& session) : session_(session) { restart(); }
  /// Since it was made or asked last.
  Seconds lap() {
    const Seconds passed{std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(),
                         device() - device_};
    restart();
    return passed;
  }

private:
  double device() const {
    double sum = 0.0;
    for (const auto& [name, time] : session_.kernel_times())
      sum += time.seconds;
    return sum;
  }
  void restart() {
    begin_ = std::chrono::steady_clock::now();
    device_ = device();
  }

  const Session& session_;
  std::chrono::steady_clock::time_point begin_;
  double device_ = 0.0;
};

/// What a solver found: B and the H of surfaces alone, [points x 3] in the pool's order.
struct Field {
  std::vector<double> radiosity, from_surfaces;
  unsigned applies = 0;
};

/// `place[k]`: where the operator's point k stands in the pool.
Field solve(RadiosityOperator& exchange, const test::LitRoom& room, View<std::uint32_t> place, double tolerance) {
  const std::size_t n = room.points.size();
  std::vector<float> emission(3 * n), albedo(3 * n), area(n);
  std::vector<double> h;
  for (std::size_t k = 0; k < n; ++k) {
    const Splat& splat = room.points[place[k]];
    area[k] = splat.area;
    for (std::size_t c = 0; c < 3; ++c) {
      albedo[3 * k + c] = splat.colour[c];
      emission[3 * k + c] = albedo[3 * k + c] * room.direct[3 * place[k] + c];
    }
  }
  SolveOptions options;
  options.tolerance = tolerance;
  const Solution solution = solve_radiosity(exchange, emission, albedo, area, options);
  if (solution.end != SolveEnd::converged) std::printf("warning: %s\n", complaint_of(solution).c_str());
  exchange.apply(solution.radiosity, LinearisationPoint::current, h);
  Field field{std::vector<double>(3 * n), std::vector<double>(3 * n), solution.applies + 1};
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t c = 0; c < 3; ++c) {
      field.from_surfaces[3 * place[k] + c] = h[3 * k + c];
      field.radiosity[3 * place[k] + c] = double{emission[3 * k + c]} + double{albedo[3 * k + c]} * h[3 * k + c];
    }
  return field;
}

struct FmmRun {
  Field field;
  LinkStatistics links;
  Seconds vmap, lists, solve;
  Seconds all() const { return vmap + lists + solve; }
};

FmmRun run_fmm(Session& session, const test::LitRoom& room, const Settings& settings) {
  FmmRun run;
  Stopwatch watch(session);
  ClusterOptions clusters;
  clusters.leaf_capacity = settings.leaf;
  const ClusterTree tree = build_clusters(room.points, clusters);
  DeviceVisibility oracle(session, room.pools, room.variant, tree.points);
  LinkOptions options;
  options.samples = settings.samples;
  options.point_samples = settings.point_samples;
  options.epsilon = settings.epsilon;
  const VMap map = make_links(tree, oracle, options);
  run.vmap = watch.lap();
  FmmOptions fmm;
  fmm.grid.order = settings.order;
  DeviceFmm exchange(session, tree, map.links, fmm, map.point_shares);
  run.lists = watch.lap();
  run.field = solve(exchange, room, tree.order, settings.tolerance);
  run.solve = watch.lap();
  run.links = map.statistics;
  return run;
}

struct DirectionsRun {
  Field field; ///< radiosity by all light, as the operators' is
  std::uint64_t rays = 0;
  Seconds all;
};

/// As a scene is solved that says no more than the method and the tolerance.
DirectionsRun run_directions(Session& session, const test::LitRoom& room, double tolerance) {
  DirectionsRun run;
  Stopwatch watch(session);
  TraversalVariant variant = room.variant;
  variant.grouping = RayGrouping::packet; // the default of devices that have it
  if (!why_not(variant, session.info()).empty()) variant = room.variant;
  const RadiositySettings settings;
  const auto prepared = radiosity_method("directions")
                            ->prepare(session, {room.pools, variant, room.points, {}, 1.0, 1}, settings, std::nullopt,
                                      [](const std::string&) {});
  const RadiosityField field = prepared->solve({room.direct, {}}, tolerance, [](const std::string&) {});
  run.all = watch.lap();
  run.rays = prepared->rays();
  run.field.from_surfaces.assign(field.irradiance.begin(), field.irradiance.end());
  run.field.radiosity = room.radiosity(field.irradiance);
  return run;
}

struct DirectRun {
  Field field;
  std::uint64_t rays = 0;
  Seconds trace, solve;
  Seconds all() const { return trace + solve; }
};

DirectRun run_direct(Session& session, const test::LitRoom& room, const Settings& settings) {
  DirectRun run;
  Stopwatch watch(session);
  DeviceDirect exchange(session, room.pools, room.variant, room.points, {});
  run.trace = watch.lap();
  std::vector<std::uint32_t> place(room.points.size());
  for (std::uint32_t i = 0; i < place.size(); ++i)
    place[i] = i;
  run.field = solve(exchange, room, place, settings.tolerance);
  run.solve = watch.lap();
  run.rays = exchange.rays();
  return run;
}

/// The H of surfaces against the same B summed over all points with a ray a pair, relative L2 at `count` points.
double error_at(Session& session, const test::LitRoom& room, const Field& field, std::size_t count) {
  std::mt19937 random(5);
  std::vector<double> found, exact;
  DeviceVisibility oracle(session, room.pools, room.variant, room.points);
  const std::vector<ExchangePoint> points(room.points.begin(), room.points.end());
  for (std::size_t k = 0; k < count; ++k) {
    const auto i = static_cast<std::uint32_t>(random() % points.size());
    std::vector<Segment> segments;
    std::vector<double> factors;
    for (std::uint32_t j = 0; j < points.size(); ++j)
      if (const double factor = point_exchange(points[i], points[j]); factor > 0.0) {
        segments.push_back({std::min(i, j), std::max(i, j)});
        factors.push_back(factor);
      }
    const auto blocked = oracle.blocked(segments);
    for (std::size_t c = 0; c < 3; ++c) {
      double sum = 0.0;
      for (std::size_t s = 0; s < segments.size(); ++s)
        if (!blocked[s]) sum += factors[s] * field.radiosity[3 * (segments[s].from + segments[s].to - i) + c];
      exact.push_back(sum);
      found.push_back(field.from_surfaces[3 * i + c]);
    }
  }
  return test::relative_l2(found, exact);
}

double million(std::uint64_t count) {
  return 1e-6 * static_cast<double>(count);
}

/// Slope of the line through (log x, log y), least squares: y grows like x to this power.
double growth(const std::vector<double>& x, const std::vector<double>& y) {
  double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double u = std::log(x[k]), v = std::log(y[k]);
    sx += u, sy += v, sxx += u * u, sxy += u * v;
  }
  const auto n = static_cast<double>(x.size());
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

void print_settings(const Settings& s) {
  std::printf("epsilon %g, K %u, %u a point, leaves of %u, order %u, tolerance %g\n", static_cast<double>(s.epsilon),
              s.samples, s.point_samples, s.leaf, s.order, s.tolerance);
}

constexpr const char* fmm_header =
    "  points |  links M  rays M applies |    V-map    lists    solve      all s | on the "
    "device";

void print_fmm(std::size_t points, const FmmRun& run) {
  std::printf("%8zu | %8.3f %7.2f %7u | %8.2f %8.2f %8.2f %8.2f | %7.2f", points,
              million(run.links.far + run.links.mid + run.links.near_), million(run.links.rays), run.field.applies,
              run.vmap.wall, run.lists.wall, run.solve.wall, run.all().wall, run.all().device);
}

void measure_growth(Session& session, const std::vector<std::size_t>& sizes, const Settings& settings,
                    std::size_t receivers) {
  std::printf("\nGrowth: a closed room with a block, a lamp and a bumpy body. ");
  print_settings(settings);
  std::printf("%s | error of H at %zu points\n", fmm_header, receivers);
  std::vector<double> points, wall, device, rays;
  for (const std::size_t size : sizes) {
    const test::LitRoom room(session, size);
    const FmmRun run = run_fmm(session, room, settings);
    print_fmm(room.points.size(), run);
    std::printf(" | %6.2f %%\n", 100.0 * error_at(session, room, run.field, receivers));
    std::fflush(stdout);
    const DirectionsRun directions = run_directions(session, room, settings.tolerance);
    std::printf("%8s | %8s %7.2f %7s | %35.2f | %7.2f | %6.2f %%\n", "", "by rays", million(directions.rays), "",
                directions.all.wall, directions.all.device,
                100.0 * error_at(session, room, directions.field, receivers));
    std::fflush(stdout);
    points.push_back(static_cast<double>(room.points.size()));
    wall.push_back(run.all().wall);
    device.push_back(run.all().device);
    rays.push_back(static_cast<double>(run.links.rays));
  }
  if (points.size() > 1)
    std::printf("growth exponents: V-map + lists + solve %.2f (on the device %.2f), rays %.2f\n", growth(points, wall),
                growth(points, device), growth(points, rays));
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

/// Seconds of the direct solver at `points` by the rates measured: rays and pairs grow with the square.
double extrapolated(const DirectRun& run, std::size_t measured, std::size_t points) {
  const double ratio = static_cast<double>(points) / static_cast<double>(measured);
  return run.all().wall * ratio * ratio;
}

void measure_against_direct(Session& session, std::size_t size, int pairs, const Settings& settings,
                            std::size_t extrapolate_to) {
  const test::LitRoom room(session, size);
  const std::size_t n = room.points.size();
  std::printf("\nAgainst the direct solver, %zu points, %d pairs. ", n, pairs);
  print_settings(settings);
  std::vector<double> ratios, device_ratios, fmm_seconds, direct_seconds;
  FmmRun fmm;
  DirectRun direct;
  for (int k = 0; k < pairs; ++k) {
    fmm = run_fmm(session, room, settings);
    direct = run_direct(session, room, settings);
    std::printf("  fmm: V-map %.2f + lists %.2f + solve %.2f = %.2f s (device %.2f), %.2f M rays, %u applies | direct: "
                "rays %.2f + solve %.2f = %.2f s (device %.2f), %.1f M rays, %u applies\n",
                fmm.vmap.wall, fmm.lists.wall, fmm.solve.wall, fmm.all().wall, fmm.all().device,
                million(fmm.links.rays), fmm.field.applies, direct.trace.wall, direct.solve.wall, direct.all().wall,
                direct.all().device, million(direct.rays), direct.field.applies);
    std::fflush(stdout);
    ratios.push_back(direct.all().wall / fmm.all().wall);
    device_ratios.push_back(direct.all().device / fmm.all().device);
    fmm_seconds.push_back(fmm.all().wall);
    direct_seconds.push_back(direct.all().wall);
  }
  std::printf("fmm %.2f s, direct %.2f s: %.1f x (median of pairs; on the device %.1f x, rays %.1f x)\n",
              median(fmm_seconds), median(direct_seconds), median(ratios), median(device_ratios),
              static_cast<double>(direct.rays) / static_cast<double>(fmm.links.rays));
  std::printf("relative L2 between them: B %.2f %%, H of surfaces %.2f %%\n",
              100.0 * test::relative_l2(fmm.field.radiosity, direct.field.radiosity),
              100.0 * test::relative_l2(fmm.field.from_surfaces, direct.field.from_surfaces));
  if (extrapolate_to == 0) return;
  const test::LitRoom large(session, extrapolate_to);
  const FmmRun run = run_fmm(session, large, settings);
  const double by_pairs = extrapolated(direct, n, large.points.size());
  std::printf(
      "at %zu points: fmm %.1f s; direct, %.1f M rays/s and %.0f M pairs/s an apply as above, would take %.0f s: "
      "%.0f x\n",
      large.points.size(), run.all().wall, million(direct.rays) / direct.trace.wall,
      1e-6 * static_cast<double>(n) * static_cast<double>(n) * direct.field.applies / direct.solve.wall, by_pairs,
      by_pairs / run.all().wall);
}

void sweep(Session& session, std::size_t size, const std::vector<float>& epsilons, const std::vector<unsigned>& samples,
           Settings settings) {
  const test::LitRoom room(session, size);
  const DirectRun direct = run_direct(session, room, settings);
  std::printf("\nSweep, leaves of %u, order %u, tolerance %g; direct: %.1f M rays, %.2f s (device %.2f)\n epsilon    K "
              "| %s | error of B, "
              "of H | rays, device\n",
              settings.leaf, settings.order, settings.tolerance, million(direct.rays), direct.all().wall,
              direct.all().device, fmm_header);
  for (const float epsilon : epsilons)
    for (const unsigned k : samples) {
      settings.epsilon = epsilon;
      settings.samples = k;
      const FmmRun run = run_fmm(session, room, settings);
      std::printf("%8g %4u | ", static_cast<double>(epsilon), k);
      print_fmm(room.points.size(), run);
      std::printf(" | %5.2f %% %5.2f %% | %5.0f x %5.0f x\n",
                  100.0 * test::relative_l2(run.field.radiosity, direct.field.radiosity),
                  100.0 * test::relative_l2(run.field.from_surfaces, direct.field.from_surfaces),
                  static_cast<double>(direct.rays) / static_cast<double>(run.links.rays),
                  direct.all().device / run.all().device);
      std::fflush(stdout);
    }
}

} // namespace

int main(int argc, char** argv) {
  CLI::App app{"Radiosity by V-map and fast multipole method: growth, and against the direct solver"};
  Settings settings;
  std::vector<std::size_t> sizes{25'000, 50'000, 100'000, 200'000, 400'000};
  std::vector<float> epsilons{1e-2f, 5e-3f, 3e-3f, 2e-3f, 1e-3f};
  std::vector<unsigned> samples{4, 8, 16};
  std::size_t points = 20'000, receivers = 300, large = 400'000;
  int pairs = 3;
  bool only_growth = false, only_direct = false, only_sweep = false;
  app.add_flag("--growth", only_growth, "only how it grows with --sizes");
  app.add_flag("--direct", only_direct, "only against the direct solver at --points");
  app.add_flag("--sweep", only_sweep, "only errors and seconds of all --epsilons and --sample-counts at --points");
  app.add_option("--sizes", sizes, "points of the room as it grows")->delimiter(',')->check(CLI::Range(500, 5'000'000));
  app.add_option("--points", points, "points of the room beside the direct solver")->check(CLI::Range(500, 100'000));
  app.add_option("--pairs", pairs, "measurements of each side")->check(CLI::Range(1, 1000));
  app.add_option("--receivers", receivers, "points at which the growing room's error is measured");
  app.add_option("--extrapolate-to", large, "points to extrapolate the direct solver to, 0: not");
  app.add_option("--epsilon", settings.epsilon, "radiosity.epsilon")->check(CLI::Range(0.0, 1.0));
  app.add_option("--samples", settings.samples, "radiosity.vmap_samples")->check(CLI::Range(1, 1024));
  app.add_option("--point-samples", settings.point_samples, "radiosity.point_samples")->check(CLI::Range(0, 65536));
  app.add_option("--leaf", settings.leaf, "points of a cluster that is not divided")->check(CLI::Range(1, 4096));
  app.add_option("--order", settings.order, "radiosity.order")->check(CLI::Range(2, 6));
  app.add_option("--tolerance", settings.tolerance, "radiosity.tolerance");
  app.add_option("--epsilons", epsilons, "of the sweep")->delimiter(',');
  app.add_option("--sample-counts", samples, "of the sweep")->delimiter(',');
  CLI11_PARSE(app, argc, argv);
  const bool both = !only_growth && !only_direct && !only_sweep;
  try {
    Session session(choose_device(""));
    std::printf("device: %s (%s)\n", session.info().name.c_str(), session.info().platform.c_str());
    const test::LitRoom small(session, 2000); // builds the kernels
    run_fmm(session, small, settings);
    run_directions(session, small, settings.tolerance);
    if (both || only_growth) measure_growth(session, sizes, settings, receivers);
    if (both || only_direct) measure_against_direct(session, points, pairs, settings, large);
    if (only_sweep) sweep(session, points, epsilons, samples, settings);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
  return 0;
}
