#include "host/cl/quirks.h"
#include <algorithm>
#include <cstdlib>

namespace pointgi {

const std::vector<QuirkRow>& quirk_rows() {
  static const std::vector<QuirkRow> rows{
      {Quirk::keeps_kernels, "PoCL 3.0 to 6.0",
       [](const DeviceInfo& d) { return d.platform == "Portable Computing Language"; },
       "PoCL keeps each kernel between runs as it was launched. Asked for a program's binary it compiles all of the "
       "program's kernels once more, for work-groups of any size, which nothing then uses."},
      {Quirk::mixes_image_params, "Mesa rusticl 25.0", [](const DeviceInfo& d) { return d.platform == "rusticl"; },
       "A function that reads two of its image parameters reads the first one's image for both: no ray meets a splat "
       "in "
       "image2d, and llvmpipe crashes in image1d_buffer. Functions that the compiler inlines before it translates to "
       "SPIR-V are right."},
  };
  return rows;
}

bool has_quirk(const DeviceInfo& device, Quirk quirk) {
  const auto& rows = quirk_rows();
  return std::any_of(rows.begin(), rows.end(),
                     [&](const QuirkRow& row) { return row.quirk == quirk && row.concerns(device); });
}

std::string quirk_options(const DeviceInfo& device) {
  return has_quirk(device, Quirk::mixes_image_params) ? " -D INLINE_FUNCTIONS" : "";
}

void limit_driver_threads(int threads) {
  for (const char* variable : {"POCL_MAX_PTHREAD_COUNT", "POCL_CPU_MAX_CU_COUNT", // PoCL, to 4 and from 5
                               "CL_CONFIG_CPU_TBB_NUM_WORKERS",                   // Intel's CPU runtime
                               "LP_NUM_THREADS"})                                 // llvmpipe, below rusticl
    setenv(variable, std::to_string(threads).c_str(), 1);
}

} // namespace pointgi
