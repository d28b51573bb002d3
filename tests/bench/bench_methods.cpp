/// Every radiosity method and its knobs on the same scenes: seconds, rays, bytes, and how far the radiosity is from
/// that of the solver of every pair, or where all pairs are too many from that of very many directions. bench_methods
/// --help
#include "host/cache/vmap_cache.h"
#include "host/radiosity/direct.h"
#include "host/radiosity/directions.h"
#include "host/radiosity/plan.h"
#include "tests/bench/methods_scenes.h"
#include "tests/support/cache_folder.h"
#include "tests/support/exchange.h"
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <numeric>
#include <spdlog/spdlog.h>

using namespace pointgi;
using namespace pointgi::bench;

namespace {

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void quiet(const std::string&) {}

struct Way {
  std::string name;
  RadiositySettings settings;
};

Way way(const std::string& name, const std::string& method, void (*set)(RadiositySettings&)) {
  Way w{name, {}};
  w.settings.method = method;
  set(w.settings);
  return w;
}

struct Result {
  double seconds = 0.0;
  std::uint64_t rays = 0, bytes = 0;
  std::vector<double> radiosity; ///< [points x 3]: reflected, all light
};

Result run_once(Session& session, const BenchScene& scene, const Way& w) {
  const NoVMapsKept anew;
  const auto begin = std::chrono::steady_clock::now();
  const RadiosityMethod& method = *radiosity_method(w.settings.method);
  const ExchangeScene exchange = scene.exchange();
  std::optional<RadiosityMap> map;
  if (method.without_vmap == nullptr) map = map_visibility(session, exchange, w.settings, quiet);
  const std::uint64_t bytes_of_map = map ? map->vmap.links.size() * sizeof(Link) + map->vmap.point_shares.size() : 0;
  const auto prepared = method.prepare(session, exchange, w.settings, std::move(map), quiet);
  const RadiosityField field = prepared->solve({scene.direct, scene.emitted}, w.settings.tolerance, quiet);
  Result result;
  result.seconds = seconds_since(begin);
  result.rays = prepared->rays();
  result.bytes = bytes_of_map;
  for (const MethodStatistic& s : prepared->statistics())
    if (std::string(s.name).find("bytes") != std::string::npos) result.bytes = s.value;
  if (std::string(method.name) == "direct") {
    std::size_t points = 0;
    for (const Splat& s : scene.points)
      points += scene.exchanges.empty() || scene.exchanges[static_cast<std::size_t>(s.material)] != 0;
    result.bytes = direct_bytes(points);
  }
  for (std::size_t i = 0; i < field.irradiance.size(); ++i)
    result.radiosity.push_back(double{scene.points[i / 3].colour[i % 3]} *
                               (double{scene.direct[i]} + double{field.irradiance[i]}));
  return result;
}

/// Once more where kernels ran for the first time, as a driver then loads them.
Result run(Session& session, const BenchScene& scene, const Way& w) {
  for (;;) {
    const std::size_t programs = session.programs_asked().size(), kernels = session.kernel_times().size();
    Result result = run_once(session, scene, w);
    if (session.programs_asked().size() == programs && session.kernel_times().size() == kernels) return result;
  }
}

struct Errors {
  double relative = 0.0; ///< L2
  double bias = 0.0;     ///< of the mean by area
  double seam = 0.0; ///< the 99.9th percentile of the errors' difference between a point and its nearest, over the mean
};

/// A near point of each that faces about the same way, among those beside it in the pool's order; itself where there is
/// none.
std::vector<std::uint32_t> neighbours_of(const BenchScene& scene) {
  constexpr int reach = 24;
  std::vector<std::uint32_t> result(scene.points.size());
  const auto points = static_cast<int>(scene.points.size());
  for (int i = 0; i < points; ++i) {
    const Splat& p = scene.points[i];
    double nearest = INFINITY;
    result[i] = static_cast<std::uint32_t>(i);
    for (int j = std::max(0, i - reach); j < std::min(points, i + reach + 1); ++j) {
      const Splat& q = scene.points[j];
      double square = 0.0, cosine = 0.0;
      for (int a = 0; a < 3; ++a) {
        square += (double{p.position[a]} - q.position[a]) * (double{p.position[a]} - q.position[a]);
        cosine += double{p.normal[a]} * q.normal[a];
      }
      if (j == i || cosine < 0.9 || square >= nearest) continue;
      nearest = square;
      result[i] = static_cast<std::uint32_t>(j);
    }
  }
  return result;
}

Errors errors_of(const BenchScene& scene, const std::vector<std::uint32_t>& neighbours, const std::vector<double>& b,
                 const std::vector<double>& truth) {
  Errors e;
  e.relative = test::relative_l2(b, truth);
  double sum = 0.0, of_truth = 0.0, area = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    sum += b[i] * double{scene.points[i / 3].area};
    of_truth += truth[i] * double{scene.points[i / 3].area};
    area += double{scene.points[i / 3].area};
  }
  e.bias = sum / of_truth - 1.0;
  std::vector<double> seams;
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    const std::size_t j = neighbours[i];
    seams.push_back(std::fabs((b[3 * i] - truth[3 * i]) - (b[3 * j] - truth[3 * j])) / (of_truth / area));
  }
  std::sort(seams.begin(), seams.end());
  e.seam = seams[static_cast<std::size_t>(0.999 * static_cast<double>(seams.size() - 1))];
  return e;
}

std::string row(const std::string& scene, const std::string& name, const Result& r, const Errors* e) {
  std::string text = fmt::format("| {} | {} | {:.2f} | {:.1f} | {:.0f} |", scene, name, r.seconds,
                                 1e-6 * static_cast<double>(r.rays), 1e-6 * static_cast<double>(r.bytes));
  text += e == nullptr ? " truth | | |"
                       : fmt::format(" {:.2f} | {:+.2f} | {:.1f} |", 100 * e->relative, 100 * e->bias, 100 * e->seam);
  std::printf("%s\n", text.c_str());
  std::fflush(stdout);
  return text + "\n";
}

std::vector<Way> usual_ways() {
  return {
      way("fmm", "fmm", [](RadiositySettings&) {}),
      way("directions 256", "directions", [](RadiositySettings& s) { s.directions = 256; }),
      way("directions 512", "directions", [](RadiositySettings&) {}),
      way("directions 1024", "directions", [](RadiositySettings& s) { s.directions = 1024; }),
      way("hemicube 588", "directions", [](RadiositySettings& s) { s.directions = 588, s.direction_set = "hemicube"; }),
      way("cones", "cones", [](RadiositySettings&) {}),
      way("cones 6, isotropic", "cones", [](RadiositySettings& s) { s.cones = 6, s.anisotropic = false; }),
      way("gather static 128", "gather", [](RadiositySettings& s) { s.sampling = "static"; }),
      way("gather monte_carlo 128", "gather", [](RadiositySettings& s) { s.sampling = "monte_carlo"; }),
      way("gather mipmap 128", "gather", [](RadiositySettings& s) { s.sampling = "mipmap"; }),
      way("gather adaptive 128", "gather", [](RadiositySettings& s) { s.sampling = "adaptive"; })};
}

std::vector<Way> windows_ways() {
  std::vector<Way> ways;
  for (const char* sampling : {"static", "monte_carlo", "mipmap", "adaptive"})
    for (const int window : {4, 16, 64}) {
      const bool anew = std::string(sampling) == "monte_carlo" || std::string(sampling) == "adaptive";
      if (anew && window < 64) continue; // minutes
      Way w = way(fmt::format("gather {} {}", sampling, window), "gather", [](RadiositySettings&) {});
      w.settings.sampling = sampling;
      w.settings.window = window;
      ways.push_back(w);
    }
  for (const int voxels : {32, 64, 128}) {
    Way w = way(fmt::format("gather all, voxels {}", voxels), "gather",
                [](RadiositySettings& s) { s.visibility = "voxels"; });
    w.settings.voxels = voxels;
    ways.push_back(w);
  }
  return ways;
}

Way many_directions() {
  return way("directions 2048", "directions", [](RadiositySettings& s) { s.directions = 2048, s.tolerance = 1e-4; });
}

/// What auto chooses, and whether fmm or so many directions that their error is not larger were cheaper.
struct Choice {
  std::string scene, chosen, equal;
  double estimate = 0.0, vmap_rays = 0.0, directions = 0.0, fmm_seconds = 0.0, directions_seconds = 0.0;

  bool right() const { return (chosen == "fmm") == (fmm_seconds < directions_seconds); }
};

class Bench {
public:
  explicit Bench(Session& session) : session_(session) {}

  /// All of `ways` against the truth; where `choice`, the planner beside them.
  void measure(const BenchScene& scene, const Way& truth, const std::vector<Way>& ways, bool choice) {
    const auto neighbours = neighbours_of(scene);
    const Result exact = run(session_, scene, truth);
    table_ += row(scene.name, truth.name, exact, nullptr);
    std::map<std::string, std::pair<Result, Errors>> found;
    for (const Way& w : ways) {
      const Result r = run(session_, scene, w);
      const Errors e = errors_of(scene, neighbours, r.radiosity, exact.radiosity);
      table_ += row(scene.name, w.name, r, &e);
      found[w.name] = {r, e};
    }
    if (!choice) return;
    Choice c;
    c.scene = scene.name;
    const RadiosityMap clusters = cluster_points(session_, scene.exchange(), {});
    const MethodPlan plan = plan_method(session_, scene.exchange(), {}, clusters, false);
    c.chosen = plan.method->name;
    c.estimate = plan.vmap.rays;
    c.vmap_rays = static_cast<double>(found["fmm"].first.rays);
    c.directions = static_cast<double>(found["directions 512"].first.rays);
    c.fmm_seconds = found["fmm"].first.seconds;
    // Sums over pairs share a fault along edges, which directions lack: where they are the truth, 512 directions have
    // the error of fmm (0.4 %).
    const double error = truth.settings.method == "direct" ? INFINITY : found["fmm"].second.relative;
    c.equal = std::isfinite(error) ? "directions 1024" : "directions 512";
    for (const char* fewer : {"directions 256", "directions 512", "directions 1024"})
      if (std::isfinite(error) && found[fewer].second.relative <= error) {
        c.equal = fewer;
        break;
      }
    c.directions_seconds = found[c.equal].first.seconds;
    choices_.push_back(c);
    std::printf("%s", choice_row(c).c_str());
  }

  static std::string choice_row(const Choice& c) {
    return fmt::format("| {} | {:.1f} | {:.1f} | {:.1f} | {:.2f} | {:.2f}, {} | {} | {} |\n", c.scene,
                       1e-6 * c.estimate, 1e-6 * c.vmap_rays, 1e-6 * c.directions, c.fmm_seconds, c.directions_seconds,
                       c.equal, c.chosen, c.right() ? "yes" : "no");
  }

  std::string tables() const {
    std::string text = "| scene | method | seconds | million rays | MB kept | relative L2 % | bias % | seam % |\n"
                       "|---|---|---|---|---|---|---|---|\n" +
                       table_;
    if (choices_.empty()) return text;
    text += "\nMillions of rays, and seconds:\n\n| scene | V-map's, estimated | asked | of 512 directions | fmm s | "
            "directions of no larger error s | "
            "`auto` takes | the cheaper |\n|---|---|---|---|---|---|---|---|\n";
    for (const Choice& c : choices_)
      text += choice_row(c);
    return text;
  }

private:
  Session& session_;
  std::string table_;
  std::vector<Choice> choices_;
};

/// What beams of directions gain over single rays: pairs of runs, one after the other.
std::string beams_table(Session& session) {
  constexpr int pairs = 7;
  std::string text = "| scene | in beams | single rays s | beams s | ratio, median | least | most |\n"
                     "|---|---|---|---|---|---|---|\n";
  for (const BenchScene& scene : {room(session, 20'000), shrub(session, 15'500)}) {
    if (!directions_in_beams(scene.variant, false)) continue;
    std::vector<std::uint32_t> places(scene.points.size());
    std::iota(places.begin(), places.end(), 0u);
    double share = 0.0;
    const auto seconds = [&](RayGrouping grouping) {
      TraversalVariant variant = scene.variant;
      variant.grouping = grouping;
      const DeviceDirections directions(session, scene.pools, variant, scene.points, places, {});
      share = static_cast<double>(directions.beam_rays()) / (512.0 * static_cast<double>(places.size()));
      return directions.trace_seconds();
    };
    seconds(RayGrouping::ray); // builds the kernels
    seconds(RayGrouping::packet);
    std::vector<double> single, beams, ratios;
    for (int i = 0; i < pairs; ++i) {
      single.push_back(seconds(RayGrouping::ray));
      beams.push_back(seconds(RayGrouping::packet));
      ratios.push_back(beams.back() / single.back());
    }
    for (std::vector<double>* values : {&single, &beams, &ratios})
      std::sort(values->begin(), values->end());
    text += fmt::format("| {} | {:.0f} % | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} |\n", scene.name, 100.0 * share,
                        single[pairs / 2], beams[pairs / 2], ratios[pairs / 2], ratios.front(), ratios.back());
  }
  return text;
}

/// Directions in shrubs that have more leaves in the same crown: the medians of three runs.
std::string shrub_table(Session& session) {
  constexpr int runs = 3;
  std::string text =
      "| shrub | points | million rays of 256 directions | seconds | exponent of seconds |\n|---|---|---|---|---|\n";
  const Way w = way("", "directions", [](RadiositySettings& s) { s.directions = 256; });
  double points_before = 0.0, seconds_before = 0.0;
  for (const std::size_t count : {8'500u, 15'500u, 35'000u, 150'000u}) {
    const BenchScene scene = shrub(session, count);
    std::vector<double> seconds;
    std::uint64_t rays = 0;
    for (int i = 0; i < runs; ++i) {
      const Result r = run(session, scene, w);
      seconds.push_back(r.seconds);
      rays = r.rays;
    }
    std::sort(seconds.begin(), seconds.end());
    const auto points = static_cast<double>(scene.points.size());
    const double median = seconds[runs / 2];
    text += fmt::format(
        "| {} | {} | {:.2f} | {:.2f} | {} |\n", count, scene.points.size(), 1e-6 * static_cast<double>(rays), median,
        points_before == 0.0
            ? ""
            : fmt::format("{:.2f}", std::log(median / seconds_before) / std::log(points / points_before)));
    points_before = points;
    seconds_before = median;
  }
  return text;
}

/// Puts `text` between the marks of a file, in place of what stands there.
void write_between(const std::string& file, const std::string& mark, const std::string& text) {
  std::ifstream in(file);
  std::string all((std::istreambuf_iterator<char>(in)), {});
  const std::string begin = "<!-- begin " + mark + " -->\n", end = "<!-- end " + mark + " -->";
  const std::size_t from = all.find(begin), to = all.find(end);
  if (from == std::string::npos || to == std::string::npos)
    throw std::runtime_error(file + ": no place for the tables, between \"" + begin + "\" and \"" + end + "\"");
  all.replace(from + begin.size(), to - from - begin.size(), text);
  std::ofstream(file) << all;
}

} // namespace

int main(int argc, char** argv) {
  CLI::App app{"Radiosity methods against the solver of every pair"};
  std::string page;
  bool only_room = false, only_lamps = false, only_growth = false, only_shrubs = false, only_beams = false,
       only_choice = false;
  std::vector<std::string> files, boxed_files;
  app.add_option("--files", files, "scenes and clouds besides the rooms")->check(CLI::ExistingFile);
  app.add_option("--boxed", boxed_files, "clouds whose y is up, each in a box with a lamp")->check(CLI::ExistingFile);
  app.add_option("--page", page, "a file between whose marks the tables are put")->check(CLI::ExistingFile);
  app.add_flag("--room", only_room, "only the rooms");
  app.add_flag("--lamps", only_lamps, "only lamps of several sizes");
  app.add_flag("--growth", only_growth, "only how rays grow with the points");
  app.add_flag("--beams", only_beams, "only what beams of directions gain over single rays");
  app.add_flag("--shrubs", only_shrubs, "only how seconds grow with the points of a shrub");
  app.add_flag("--files-only", only_choice, "only --files and --boxed");
  CLI11_PARSE(app, argc, argv);
  const bool all = !only_room && !only_lamps && !only_growth && !only_shrubs && !only_beams && !only_choice;
  try {
    spdlog::set_level(spdlog::level::err);
    const test::CacheFolder empty; // or V-maps of earlier runs are taken
    Session session(choose_device(""));
    std::string text = fmt::format("Device: {} ({}).\n\n", session.info().name, session.info().platform);
    const Way direct = way("direct", "direct", [](RadiositySettings&) {});
    for (const Way& w : usual_ways()) // builds the kernels
      run(session, room(session, 1000), w);
    if (all || only_room) {
      Bench bench(session);
      std::vector<Way> ways = usual_ways();
      const std::vector<Way> more = windows_ways();
      ways.insert(ways.end(), more.begin(), more.end());
      bench.measure(room(session, 20'000), direct, ways, true);
      // Without what traces other pairs in each pass: minutes.
      const std::vector<Way> usual = usual_ways();
      bench.measure(room(session, 100'000), many_directions(), {usual.begin(), usual.begin() + 8}, true);
      text += bench.tables() + "\n";
    }
    if (all || only_lamps) {
      Bench bench(session);
      for (const double side : {1.0, 0.5, 0.25, 0.12, 0.06})
        bench.measure(lamp_room(session, side), direct,
                      {way("fmm", "fmm", [](RadiositySettings&) {}),
                       way("directions 512", "directions", [](RadiositySettings&) {})},
                      false);
      text += bench.tables() + "\n";
    }
    if (all || only_growth) {
      const test::CacheFolder anew;
      text += "| points | fmm | directions 512 | gather mipmap 128 | gather all |\n|---|---|---|---|---|\n";
      for (const std::size_t points : {2'500u, 5'000u, 10'000u, 20'000u}) {
        const BenchScene scene = room(session, points);
        text += fmt::format("| {} |", scene.points.size());
        for (const Way& w :
             {way("", "fmm", [](RadiositySettings&) {}), way("", "directions", [](RadiositySettings&) {}),
              way("", "gather", [](RadiositySettings& s) { s.sampling = "mipmap"; }),
              way("", "gather", [](RadiositySettings&) {})}) {
          const Result r = run(session, scene, w);
          text += fmt::format(" {:.2f} million rays, {:.2f} s |", 1e-6 * static_cast<double>(r.rays), r.seconds);
        }
        text += "\n";
      }
      text += "\n";
    }
    if (all || only_beams) text += beams_table(session) + "\n";
    if (all || only_shrubs) text += shrub_table(session) + "\n";
    if (all || only_choice) {
      Bench bench(session);
      const auto measure = [&](const BenchScene& scene) {
        const std::vector<Way> usual = usual_ways();
        bench.measure(scene, many_directions(), {usual.begin(), usual.begin() + 6}, true);
      };
      for (const std::string& file : files)
        measure(from_file(session, std::filesystem::path(file).stem().string(), file));
      for (const std::string& file : boxed_files)
        measure(boxed(session, file));
      if (!files.empty() || !boxed_files.empty()) text += bench.tables();
    }
    std::printf("\n%s", text.c_str());
    if (!page.empty()) write_between(page, "tables", text);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
  return 0;
}
