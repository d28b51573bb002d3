#include "host/app/info_estimate.h"
#include "host/api/estimate.h"
#include "host/app/light_command.h"
#include <cstdio>

namespace pointgi {

namespace {

double mebibytes(std::uint64_t bytes) {
  return static_cast<double>(bytes) / 1048576.0;
}

void print_table(const api::PictureEstimate& estimate, const Session& session) {
  const DeviceInfo& device = session.info();
  std::printf("  picture     by %s, from nothing kept but its kernels; memory is what the device holds meanwhile\n",
              device.name.c_str());
  std::printf("  %-11s %8s %11s   %s\n", "stage", "seconds", "memory", "why");
  for (const api::StageEstimate& stage : estimate.stages)
    if (!stage.runs)
      std::printf("  %-11s %8s %11s   %s\n", stage.stage.c_str(), "-", "-", stage.why.c_str());
    else if (stage.bytes == 0)
      std::printf("  %-11s %8.2f %11s   %s\n", stage.stage.c_str(), stage.seconds, "-", stage.why.c_str());
    else
      std::printf("  %-11s %8.2f %7.1f MiB   %s\n", stage.stage.c_str(), stage.seconds, mebibytes(stage.bytes),
                  stage.why.c_str());
  std::printf("  %-11s %8.2f %7.1f MiB   of %.0f MiB that the device has\n", "all", estimate.seconds(),
              mebibytes(estimate.peak_bytes()), mebibytes(device.memory_bytes));
  const std::size_t built = session.programs_compiled();
  if (built > 0) std::printf("  kernels     %zu were built now, once; they take no time of the picture\n", built);
  if (estimate.peak_bytes() > device.memory_bytes)
    std::printf("  warning     the picture needs more memory than the device has\n");
}

} // namespace

void print_estimate(const InfoOptions& options, CommandRun& run) {
  if (list_devices().empty()) {
    std::printf("  picture     not estimated: there is no OpenCL device\n");
    return;
  }
  StageLog begun;
  begun.start("scene");
  api::Scene scene = api::Scene::from_file(options.input, picture_overrides_of(options));
  scene.set_quality(options.quality, !options.spp);
  const Scene description = scene.parts()->description();
  require_possible_radiosity(description);
  begun.finish(description.clouds.size() + description.shapes.size(), "objects");
  // The report before has said all there is to say of the clouds.
  const RunControl silent{run.control().stop, run.control().progress, {}};
  const api::Context context(options.device, silent);
  context.parts()->stages = std::move(begun);
  try {
    const api::PictureEstimate estimate = api::estimate_picture(api::Prepared(context, scene, silent), {}, silent);
    run.end_progress();
    print_table(estimate, context.parts()->session);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::memory) throw;
    run.end_progress();
    std::printf("  picture     render would refuse: %s\n", error.what());
  }
}

} // namespace pointgi
