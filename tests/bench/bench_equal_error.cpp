/// Time to equal error: the renderer (radiosity, photons, gather) against the path tracer over the same splats. How
/// many samples a pixel each side needs is found in small pictures, whose reference is affordable; then both make
/// pictures of the scene's own size, from the prepared cloud on, in turn, A B A B, and the median of the pairs counts.
/// The path tracer takes few samples there, as many more of which would take that many times as long. bench_equal_error
/// --help
#include "host/measure/reference.h"
#include "host/render/render.h"
#include "host/repeats.h"
#include "host/stages/light_stages.h"
#include "host/stages/prepared_scene.h"
#include "tests/support/cache_folder.h"
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <spdlog/spdlog.h>

using namespace pointgi;

namespace {

/// Seconds of a picture, from the prepared cloud on: normals fitted, light solved, pixels made.
struct Seconds {
  double vmap = 0.0, exchange = 0.0, photon = 0.0, other = 0.0, pixels = 0.0;
  double light() const { return vmap + exchange + photon + other; }
  double all() const { return light() + pixels; }
};

/// Light as run_light_stages leaves it, on the device.
struct Solved {
  SceneLight light;
  Buffer<cl_float4> irradiance;
  Seconds seconds;
};

/// A scene on the device, of which both sides make pictures.
class Bench {
public:
  Bench(Session& session, const Scene& scene, const std::string& folder)
      : session_(session), scene_(scene), folder_(folder), ready_(prepare_scene(session, scene_, false, stages_)) {}

  const Scene& scene() const { return scene_; }

  /// Normals, and for our own picture V-map, exchange and photons.
  Solved solve(bool by_paths, unsigned seed) {
    scene_.render.seed = seed;
    light_device();
    StageLog stages;
    // What has no effect on paths is not worth a warning here.
    spdlog::set_level(by_paths ? spdlog::level::err : spdlog::level::warn);
    const IndirectRequest request{ready_.choice.variant, scene_,        ready_.frame,
                                  ready_.lighting,       ready_.points, by_paths};
    Solved solved;
    solved.light = run_light_stages(session_, ready_.on_device, request, stages);
    if (!solved.light.indirect.from_surfaces.empty())
      solved.irradiance = upload_irradiance(session_, solved.light.indirect, scene_);
    for (const StageRecord& stage : stages.records())
      (stage.name == "vmap"                    ? solved.seconds.vmap
       : stage.name == scene_.radiosity.method ? solved.seconds.exchange
       : stage.name == "photon"                ? solved.seconds.photon
                                               : solved.seconds.other) += stage.seconds;
    solved.seconds.other += stages.seconds() - solved.seconds.light();
    return solved;
  }

  /// The picture's channels; `seconds`, if given, gets the time of the pixels.
  Picture picture(const Solved& solved, const std::optional<LightPaths>& paths, unsigned seed, int spp,
                  const std::string& name, double* seconds = nullptr) {
    scene_.render.seed = seed;
    scene_.render.spp = spp;
    light_device();
    const PixelWindow window{0, scene_.render.width, 0, scene_.render.height};
    RenderRequest request{window, ready_.lighting, ready_.frame, ready_.ids, ready_.choice.variant, paths};
    const bool surfaces = !paths && !solved.light.indirect.from_surfaces.empty();
    request.irradiance = surfaces ? &solved.irradiance : nullptr;
    request.shadow_rays = !surfaces || !direct_light_by_radiosity(scene_);
    request.normal_field = solved.light.normal_field ? &*solved.light.normal_field : nullptr;
    request.photons = solved.light.photons ? &*solved.light.photons : nullptr;
    PictureWriter writer(folder_ + "/" + name + ".exr", scene_.render.width, scene_.render.height, window,
                         film_channels(request.has_indirect(), request.has_specular(), request.has_caustics()), {},
                         scene_.render.exposure);
    StageLog clock;
    std::vector<Band> bands;
    render(
        session_, ready_.on_device, request, [&](const Band& band) { bands.push_back(band); }, [](double) {},
        [] { return false; });
    if (seconds != nullptr) *seconds = clock.seconds();
    for (const Band& band : bands)
      writer.write(band);
    writer.finish(clock.seconds());
    return read_exr(writer.exr_path());
  }

  /// Of each pixel, the material of what stands there (PointId); -1: nothing.
  std::vector<int> materials_of(const Picture& picture) const {
    std::vector<int> of_id(ready_.ids.empty() ? 0 : *std::max_element(ready_.ids.begin(), ready_.ids.end()) + 1u, -1);
    const View<Splat> points = ready_.points;
    for (std::size_t i = 0; i < ready_.ids.size(); ++i)
      of_id[ready_.ids[i]] = static_cast<int>(points[i].material);
    std::vector<int> materials;
    for (const std::uint32_t id : picture.uints.at("PointId"))
      materials.push_back(id < of_id.size() ? of_id[id] : -1);
    return materials;
  }

private:
  void light_device() { ready_.lighting = device_lighting(scene_, ready_.frame, ready_.points); }

  Session& session_;
  Scene scene_;
  std::string folder_;
  StageLog stages_;
  PreparedScene ready_;
};

/// Error of the path tracer: constant / spp^exponent, the line through (log spp, log error).
struct PowerLaw {
  double exponent = 0.0, constant = 0.0;
  double spp_for(double error) const { return std::pow(constant / error, 1.0 / exponent); }
};

PowerLaw law_through(const std::vector<int>& spp, const std::vector<double>& errors) {
  double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (std::size_t k = 0; k < spp.size(); ++k) {
    const double x = std::log(static_cast<double>(spp[k])), y = std::log(errors[k]);
    sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  const auto n = static_cast<double>(spp.size());
  const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
  return {-slope, std::exp((sy - slope * sx) / n)};
}

struct Settings {
  int reference_spp = 1024, pairs = 3, floor_spp = 512, timed_spp = 8;
  double rel_mse = 1e-3;
  std::vector<int> path_spp{16, 64, 256}, gi_spp{1, 2, 4, 8, 16, 32, 64, 96, 128, 256};
};

/// The last pictures of both sides whose errors were measured.
struct Pictures {
  Picture ours, path;
};

PowerLaw measure_path(Bench& bench, const Solved& solved, const LightPaths& paths, const Reference& reference,
                      const std::vector<int>& counts, Picture& last) {
  std::vector<double> errors;
  std::printf("\npath tracer   spp      relMSE   seconds\n");
  for (const int spp : counts) {
    double seconds = 0.0;
    last = bench.picture(solved, paths, 100u + static_cast<unsigned>(spp), spp, "path", &seconds);
    errors.push_back(reference.error(last));
    std::printf("            %5d %11.3g %9.2f\n", spp, errors.back(), seconds);
    std::fflush(stdout);
  }
  for (const double error : errors)
    if (!(error > 0.0))
      throw std::runtime_error("the path tracer's error is lost in the reference's noise: more --reference-spp, or "
                               "fewer --path-spp");
  return law_through(counts, errors);
}

/// Our samples a pixel, and the error that both sides are to reach.
struct Target {
  int spp = 0;
  double error = 0.0;
};

Target choose_target(Bench& bench, const Solved& solved, const Reference& reference, const Settings& settings,
                     Picture& last) {
  const auto error_at = [&](int spp) {
    double seconds = 0.0;
    last = bench.picture(solved, {}, 200u + static_cast<unsigned>(spp), spp, "ours", &seconds);
    const double error = reference.error(last);
    std::printf("            %5d %11.3g %9.2f\n", spp, error, seconds);
    std::fflush(stdout);
    return error;
  };
  std::printf("\nours          spp      relMSE   seconds of the pixels, the same light for all\n");
  const double floor = error_at(settings.floor_spp);
  const bool reached = floor < settings.rel_mse;
  std::printf("the error that more samples do not lower, photons' noise and bias: %.3g%s\n", floor,
              reached ? "" : ", over the target: compared at our own error instead");
  // Near a floor, ten times the samples gain little: 1.25 times it is taken for reached.
  const double wanted = reached ? settings.rel_mse : 1.25 * floor;
  for (const int spp : settings.gi_spp)
    if (const double error = error_at(spp); error <= wanted) return {spp, reached ? wanted : error};
  return {settings.floor_spp, reached ? wanted : floor};
}

void print_ours(const char* what, const Seconds& s) {
  std::printf("  %s: V-map %.2f + exchange %.2f + photons %.2f + other %.2f + pixels %.2f = %.2f s\n", what, s.vmap,
              s.exchange, s.photon, s.other, s.pixels, s.all());
}

/// What a side's pictures cost: the light, and the pixels.
struct Cost {
  std::vector<double> light, pixels, all;
  void add(const Seconds& s) {
    light.push_back(s.light());
    pixels.push_back(s.pixels);
    all.push_back(s.all());
  }
  /// Of a picture of this share of the pixels, as the medians say.
  double at(double share) const { return median_of_repeats(light) + share * median_of_repeats(pixels); }
};

std::vector<double> quotients(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> quotients;
  for (std::size_t k = 0; k < a.size(); ++k)
    quotients.push_back(a[k] / b[k]);
  return quotients;
}

/// `small`: the share of the pixels that the pictures had whose errors were measured.
void measure_pairs(Bench& bench, const LightPaths& paths, const Target& target, int path_spp, const Settings& settings,
                   double small) {
  std::printf("\nat the scene's own size, %d pairs: ours of %d samples a pixel, %d of the path tracer's for %d\n",
              settings.pairs, target.spp, settings.timed_spp, path_spp);
  Cost anew, kept, path;
  for (int k = 0; k < settings.pairs; ++k) {
    const auto seed = static_cast<unsigned>(1 + k);
    { // Its cache is empty at first, so that the V-map is made, and then holds it.
      const test::CacheFolder cache;
      const Solved first = bench.solve(false, seed);
      Seconds s = first.seconds;
      bench.picture(first, {}, seed, target.spp, "ours", &s.pixels);
      anew.add(s);
      print_ours("V-map anew", s);
      const double pixels = s.pixels;
      s = bench.solve(false, seed).seconds;
      s.pixels = pixels;
      kept.add(s);
      print_ours("V-map kept", s);
    }
    const Solved traced = bench.solve(true, seed);
    Seconds s = traced.seconds;
    bench.picture(traced, paths, seed, settings.timed_spp, "path", &s.pixels);
    std::printf("  path tracer: %.2f s of %d samples a pixel", s.pixels, settings.timed_spp);
    s.pixels *= static_cast<double>(path_spp) / settings.timed_spp;
    path.add(s);
    std::printf(", %.1f s of %d\n", s.all(), path_spp);
    std::fflush(stdout);
  }
  const auto conclude = [&](const char* what, const Cost& ours) {
    std::printf("%s: ours %.2f s, path tracer %.1f s: %.1f x (median of pairs); of the small picture %.1f x\n", what,
                median_of_repeats(ours.all), median_of_repeats(path.all),
                median_of_repeats(quotients(path.all, ours.all)), path.at(small) / ours.at(small));
  };
  std::printf("\nto relMSE %.3g\n", target.error);
  conclude("V-map made anew (a first picture)", anew);
  conclude("V-map from the cache (a second picture of the scene)", kept);
}

/// Where the errors are: a line for pixels that `in` is true of.
template <typename In>
void print_region(const std::string& name, const Pictures& pictures, const Reference& reference, const In& in) {
  const std::vector<double> ours = reference.errors(pictures.ours), path = reference.errors(pictures.path);
  double mean_ours = 0.0, mean_truth = 0.0, error_ours = 0.0, error_path = 0.0, all_ours = 0.0, all_path = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    all_ours += ours[i], all_path += path[i];
    if (!in(i)) continue;
    ++count;
    error_ours += ours[i], error_path += path[i];
    for (const char* colour : Reference::colours) {
      mean_ours += pictures.ours.channels.at(colour)[i];
      mean_truth += reference.mean().channels.at(colour)[i];
    }
  }
  if (count == 0) return;
  std::printf("%-24s %7.1f %% %+9.2f %% %8.1f %% %8.1f %%\n", name.c_str(),
              100.0 * static_cast<double>(count) / static_cast<double>(ours.size()),
              mean_truth > 0.0 ? 100.0 * (mean_ours / mean_truth - 1.0) : 0.0, 100.0 * error_ours / all_ours,
              100.0 * error_path / all_path);
}

void print_regions(const Bench& bench, const Pictures& pictures, const Reference& reference) {
  std::printf("\n%-24s %9s %11s  share of relMSE\n%-24s %9s %11s %10s %10s\n", "where", "pixels", "our bias", "", "",
              "", "ours", "path's");
  print_region("everywhere", pictures, reference, [](std::size_t) { return true; });
  const std::vector<int> material = bench.materials_of(pictures.ours);
  for (int m = -1; m < static_cast<int>(bench.scene().materials.size()); ++m)
    print_region(m < 0 ? "sky" : bench.scene().materials[static_cast<std::size_t>(m)].name, pictures, reference,
                 [&](std::size_t i) { return material[i] == m; });
  if (pictures.ours.channels.count("Caustic.G") == 0) return;
  const std::vector<float>&caustic = pictures.ours.channels.at("Caustic.G"), &all = pictures.ours.channels.at("G");
  print_region("a tenth by caustics", pictures, reference, [&](std::size_t i) { return caustic[i] > 0.1f * all[i]; });
}

/// False when the sides cannot be compared. `small`: the scene with pictures of which a reference is affordable.
bool measure(Session& session, const Scene& scene, const Scene& small, const LightPaths& paths,
             const Settings& settings, const std::string& folder) {
  Bench bench(session, small, folder);
  const Solved traced = bench.solve(true, 1), solved = bench.solve(false, 1);
  bench.picture(traced, paths, 1, 1, "path"); // builds the kernels
  bench.picture(solved, {}, 1, 1, "ours");
  const Reference reference(bench.picture(traced, paths, 11, settings.reference_spp, "reference_a"),
                            bench.picture(traced, paths, 12, settings.reference_spp, "reference_b"));
  std::printf("reference: twice %d samples a pixel; its own relMSE %.2g is taken off\n", settings.reference_spp,
              reference.own_noise());
  Pictures last;
  const PowerLaw law = measure_path(bench, traced, paths, reference, settings.path_spp, last.path);
  std::printf("it falls as 1/spp^%.2f\n", law.exponent);
  const Target target = choose_target(bench, solved, reference, settings, last.ours);
  print_regions(bench, last, reference);
  const int path_spp = std::max(1, static_cast<int>(std::lround(law.spp_for(target.error))));
  const auto pixels = [](const Scene& s) { return static_cast<double>(s.render.width) * s.render.height; };
  Bench own(session, scene, folder);
  measure_pairs(own, paths, target, path_spp, settings, pixels(small) / pixels(scene));
  const PictureDifference off = difference(last.ours, "ours", reference.mean(), "reference");
  bool right = true;
  if (std::fabs(law.exponent - 1.0) > 0.2) {
    std::printf("wrong: noise alone would fall as 1/spp; the reference is not the path tracer's own limit\n");
    right = false;
  }
  if (!(std::fabs(off.all.bias) < 0.05)) {
    std::printf("wrong: the two pictures' means are %.1f %% apart: they are not of the same light\n",
                100.0 * off.all.bias);
    right = false;
  }
  return right;
}

} // namespace

int main(int argc, char** argv) {
  CLI::App app{"Time to equal error: our picture against the path tracer's over the same splats"};
  Settings settings;
  std::string file = "scenes/demo/room.toml", size = "160x120", list, folder;
  std::vector<std::string> overrides;
  app.add_option("scene", file, "scene file");
  app.add_option("--size", size, "WIDTHxHEIGHT of the pictures whose errors are measured");
  app.add_option("--pairs", settings.pairs, "measurements of each side")->check(CLI::Range(1, 100));
  app.add_option("--rel-mse", settings.rel_mse, "the error to reach")->check(CLI::PositiveNumber);
  app.add_option("--reference-spp", settings.reference_spp, "samples of each half of the reference");
  app.add_option("--path-spp", settings.path_spp, "at which the path tracer's error is measured")->delimiter(',');
  app.add_option("--spp", settings.gi_spp, "of ours to choose from, rising")->delimiter(',');
  app.add_option("--floor-spp", settings.floor_spp, "of ours, for the error that samples do not lower");
  app.add_option("--timed-spp", settings.timed_spp, "of the path tracer, timed at the scene's own size")
      ->check(CLI::PositiveNumber);
  app.add_option("--paths", list, "classes of light paths that the path tracer takes, as of pointgi render; all");
  app.add_option("--set", overrides, "key.path=value of the scene");
  app.add_option("--output", folder, "folder that keeps the last pictures");
  CLI11_PARSE(app, argc, argv);
  spdlog::set_level(spdlog::level::warn);
  try {
    const test::TemporaryFolder temporary;
    const Scene own = load_any(file, overrides);
    int width = 0, height = 0;
    if (std::sscanf(size.c_str(), "%dx%d", &width, &height) != 2 || width < 1 || height < 1)
      throw Error(ErrorKind::usage, "--size: expected WIDTHxHEIGHT, found \"" + size + "\"");
    overrides.push_back("render.size=[" + std::to_string(width) + ", " + std::to_string(height) + "]");
    Session session(choose_device(""));
    std::printf("device: %s (%s)\nscene: %s, %s%s%s\n", session.info().name.c_str(), session.info().platform.c_str(),
                file.c_str(), size.c_str(), list.empty() ? "" : ", paths ", list.c_str());
    return measure(session, own, load_any(file, overrides), light_paths(list, own.render.max_depth), settings,
                   folder.empty() ? temporary.file("") : folder)
               ? 0
               : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
