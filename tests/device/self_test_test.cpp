/// Every device may fail: what its self-test says then.
#include "host/tune/self_test.h"
#include "tests/support/device.h"
#include "tests/support/source_folder.h"
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <sstream>

using namespace pointgi;
using namespace pointgi::test;
using Catch::Contains;

namespace {

/// Has programs read from a copy of kernels/ in which, in one file, `from` is `to`.
class AlteredKernels {
public:
  AlteredKernels(const std::string& file, const std::string& from, const std::string& to) {
    const std::string kernels = folder_.file("kernels");
    std::filesystem::copy(source_folder() + "/kernels", kernels, std::filesystem::copy_options::recursive);
    std::ostringstream text;
    text << std::ifstream(kernels + "/" + file).rdbuf();
    std::string altered = text.str();
    REQUIRE(altered.find(from) != std::string::npos);
    altered.replace(altered.find(from), from.size(), to);
    std::ofstream(kernels + "/" + file) << altered;
    setenv("POINTGI_KERNEL_DIR", kernels.c_str(), 1);
  }
  ~AlteredKernels() { unsetenv("POINTGI_KERNEL_DIR"); }
  AlteredKernels(const AlteredKernels&) = delete;
  AlteredKernels& operator=(const AlteredKernels&) = delete;

private:
  TemporaryFolder folder_;
};

/// What the self-test says of a new session on this device, told to be a GPU where `as_gpu`.
std::string said(bool as_gpu, const FaultInjector& faults = {}) {
  Device device = choose_device("");
  if (as_gpu) {
    device.info.is_cpu = false;
    device.info.is_gpu = true;
  }
  Session session(device);
  session.inject_faults(faults);
  return self_test(session);
}

} // namespace

TEST_CASE("a device that works passes its self-test, by the default variant of CPUs and of GPUs", "[self-test]") {
  CHECK(said(false).empty());
  CHECK(said(true).empty());
}

TEST_CASE("a device whose answers are wrong, or none, does not pass its self-test", "[self-test][long]") {
  const auto expect = [](const char* to, const char* says) {
    const AlteredKernels altered("traverse/trace.cl", "answers[i].splat = hit.splat;", to);
    for (const bool as_gpu : {false, true})
      CHECK_THAT(said(as_gpu), Contains(says));
  };
  expect("answers[i].splat = hit.splat ^ (i % 50u == 0u ? 1u : 0u);", "do not find the nearest splat");
  expect("", "do not find the nearest splat");
  expect("answers[i].splat = nonsense;", "did not compile");
}

TEST_CASE("a device that refuses launches or memory does not pass its self-test", "[self-test]") {
  const auto fault = [](DeviceCall::Kind kind) {
    return [=](const DeviceCall& call) { return call.kind == kind ? CL_OUT_OF_RESOURCES : CL_SUCCESS; };
  };
  CHECK_THAT(said(true, fault(DeviceCall::Kind::launch)), Contains("CL_OUT_OF_RESOURCES"));
  CHECK_FALSE(said(true, fault(DeviceCall::Kind::allocation)).empty());
}
