#pragma once
/// What drivers do otherwise than others: the only place where one is known by its name.
#include "host/cl/device.h"
#include <string>
#include <vector>

namespace pointgi {

enum class Quirk {
  keeps_kernels,      ///< programs are given as source, and their binaries not asked for
  mixes_image_params, ///< functions are built with -D INLINE_FUNCTIONS (kernels/lib/pools.cl)
};

/// What is done about one driver.
struct QuirkRow {
  Quirk quirk;
  const char* driver;                  ///< for people, with the versions that were seen
  bool (*concerns)(const DeviceInfo&); ///< by the platform's name: devices' names change from version to version
  const char* reason;
};

const std::vector<QuirkRow>& quirk_rows();

bool has_quirk(const DeviceInfo& device, Quirk quirk);

/// The options that every program of the device is built with: " -D NAME…", or empty.
std::string quirk_options(const DeviceInfo& device);

/// Has the drivers of CPU devices, whichever is loaded, use so many threads: the variable of each. Before the first
/// OpenCL call.
void limit_driver_threads(int threads);

} // namespace pointgi
