/// Drivers that do otherwise than others are known by their platform, and each row has what is said of it.
#include "host/cl/quirks.h"
#include <catch2/catch.hpp>
#include <cstdlib>
#include <map>

using namespace pointgi;

namespace {

/// A device of the driver's, as it says.
DeviceInfo device(const std::string& platform, const std::string& name, const std::string& driver, bool cpu) {
  DeviceInfo info;
  info.platform = platform;
  info.name = name;
  info.driver = driver;
  info.is_cpu = cpu;
  info.is_gpu = !cpu;
  return info;
}

const DeviceInfo pocl3 = device("Portable Computing Language", "pthread-Intel(R) Xeon(R) Processor", "3.1", true);
const DeviceInfo pocl6 =
    device("Portable Computing Language", "cpu-skylake-avx512-Intel(R) Xeon(R) Processor", "6.0+debian", true);
const DeviceInfo rusticl = device("rusticl", "llvmpipe (LLVM 19.1.7, 256 bits)", "25.0.7-2+deb13u1", true);
const DeviceInfo radeon = device("rusticl", "AMD Radeon RX 6700 XT (radeonsi, navi22)", "25.0.7", false);
const DeviceInfo intel = device("Intel(R) OpenCL", "Intel(R) Xeon(R) Processor", "2026.22.10.0.01_160000", true);
const DeviceInfo nvidia = device("NVIDIA CUDA", "NVIDIA A100-SXM4-80GB", "550.54.15", false);
const DeviceInfo amd = device("AMD Accelerated Parallel Processing", "gfx1030", "3581.0", false);

} // namespace

TEST_CASE("each quirk concerns the devices of its driver and no other", "[quirks_test]") {
  const std::map<Quirk, std::vector<DeviceInfo>> expected{{Quirk::keeps_kernels, {pocl3, pocl6}},
                                                          {Quirk::mixes_image_params, {rusticl, radeon}}};
  REQUIRE(quirk_rows().size() == expected.size());
  for (const QuirkRow& row : quirk_rows()) {
    CAPTURE(row.driver);
    CHECK(std::string(row.reason).size() > 40);
    for (const DeviceInfo& info : {pocl3, pocl6, rusticl, radeon, intel, nvidia, amd}) {
      const auto& of_it = expected.at(row.quirk);
      const bool concerned =
          std::any_of(of_it.begin(), of_it.end(), [&](const DeviceInfo& d) { return d.name == info.name; });
      CAPTURE(info.platform, info.name);
      CHECK(row.concerns(info) == concerned);
      CHECK(has_quirk(info, row.quirk) == concerned);
    }
  }
}

TEST_CASE("programs are built with an option more where a driver wants one", "[quirks_test]") {
  CHECK(quirk_options(rusticl) == " -D INLINE_FUNCTIONS");
  CHECK(quirk_options(radeon) == " -D INLINE_FUNCTIONS");
  for (const DeviceInfo& info : {pocl3, pocl6, intel, nvidia, amd})
    CHECK(quirk_options(info).empty());
}

TEST_CASE("threads are limited whichever driver the CPU's is", "[quirks_test]") {
  std::map<std::string, std::string> before;
  const auto names = {"POCL_MAX_PTHREAD_COUNT", "POCL_CPU_MAX_CU_COUNT", "CL_CONFIG_CPU_TBB_NUM_WORKERS",
                      "LP_NUM_THREADS"};
  for (const char* name : names)
    if (const char* value = std::getenv(name)) before[name] = value;
  limit_driver_threads(3);
  for (const char* name : names) {
    const char* value = std::getenv(name);
    CHECK((value != nullptr && std::string(value) == "3"));
    if (before.count(name) != 0)
      setenv(name, before[name].c_str(), 1);
    else
      unsetenv(name);
  }
}
