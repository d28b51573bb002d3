/// What `pointgi info` tells of a picture against what the picture takes: seconds of each stage and the device's bytes.
/// The V-map is made anew. bench_estimate [--set KEY=VALUE]... SCENE...
#include "host/api/estimate.h"
#include "host/api/parts.h"
#include "host/cache/vmap_cache.h"
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <map>

using namespace pointgi;

namespace {

/// By the wall, and of the processor in all threads. Where others use the machine, too, both times are of the wall as
/// the processor was free: by the processor's time that each got, the ratio is the machine's own.
struct Times {
  double wall = 0.0, processor = 0.0;
};

Times now() {
  return {std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(),
          static_cast<double>(std::clock()) / CLOCKS_PER_SEC};
}

Times since(const Times& begin) {
  const Times end = now();
  return {end.wall - begin.wall, end.processor - begin.processor};
}

/// As pointgi render does; the writing of the files, which takes a second at most, is left out on both sides.
void measure(const std::string& name, const api::Scene& scene) {
  const api::Context context;
  const api::Prepared prepared(context, scene);
  Session& session = context.parts()->session;
  StageLog& log = context.parts()->stages;
  api::estimate_picture(prepared); // builds kernels
  Times begin = now();
  const api::PictureEstimate estimate = api::estimate_picture(prepared);
  const Times estimating = since(begin);
  const std::size_t stages_before = log.records().size();
  session.forget_peak();
  double rays = 0.0;
  begin = now();
  {
    const NoVMapsKept anew;
    const api::Light light(prepared);
    rays = static_cast<double>(light.parts()->light.indirect.rays);
    api::FilmJob job(*light.parts(), {});
    job.render([](const Band&) {});
  }
  const Times making = since(begin);
  std::map<std::string, double> measured;
  for (std::size_t i = 0; i < log.records().size(); ++i)
    if (log.records()[i].ran && (i >= stages_before || log.records()[i].name != "render"))
      measured[log.records()[i].name] += log.records()[i].seconds;
  std::printf("%s, %zu points; the estimate took %.1f s\n", name.c_str(), prepared.size(), estimating.wall);
  double told = 0.0, took = 0.0;
  for (const api::StageEstimate& stage : estimate.stages) {
    if (!stage.runs || stage.stage == "image") continue;
    const double seconds = measured[stage.stage];
    std::printf("  %-11s %8.2f s of %8.2f s, %6.1f MiB   %s\n", stage.stage.c_str(), stage.seconds, seconds,
                static_cast<double>(stage.bytes) / 1048576.0, stage.unit.c_str());
    told += stage.seconds;
    took += seconds;
  }
  const double peak = static_cast<double>(session.peak_bytes());
  const double by_processor = told / took * (estimating.processor / estimating.wall) / (making.processor / making.wall);
  std::printf("  %.2f of %.2f million rays between points\n", 1e-6 * estimate.exchange_rays, 1e-6 * rays);
  std::printf("| %s | %zu | %.1f | %.1f | %.2f | %.2f | %.1f | %.1f | %.2f |\n", name.c_str(), prepared.size(), told,
              took, told / took, by_processor, static_cast<double>(estimate.peak_bytes()) / 1048576.0, peak / 1048576.0,
              static_cast<double>(estimate.peak_bytes()) / peak);
  std::fflush(stdout);
}

} // namespace

int main(int argc, char** argv) {
  std::vector<std::string> overrides;
  std::printf(
      "| scene | points | told [s] | took [s] | ratio | by the processor | told [MiB] | held [MiB] | ratio |\n");
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--set" && i + 1 < argc)
      overrides.emplace_back(argv[++i]);
    else
      try {
        measure(word.substr(word.rfind('/') + 1), api::Scene::from_file(word, overrides));
      } catch (const std::exception& error) {
        std::printf("%s: %s\n", word.c_str(), error.what());
      }
  }
  return 0;
}
