/// Calls of Open Image Denoise, as a stand-in sees them (tests/fakes/oidn.cpp), and its faults.
#include "host/denoise/denoiser.h"
#include "host/error.h"
#include "tests/support/fake_oidn.h"
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;
using Catch::Contains;

namespace {

constexpr int width = 7, height = 5;

struct Images {
  std::vector<float> light, albedo, normal, output;
  DenoiseImages all;

  Images() {
    for (int i = 0; i < 3 * width * height; ++i) {
      light.push_back(static_cast<float>(i));
      albedo.push_back(static_cast<float>(i % 8) * 0.125f);
      normal.push_back(static_cast<float>(i % 5) * 0.25f - 0.5f);
    }
    output.resize(light.size());
    all.width = width;
    all.height = height;
    all.light = light.data();
    all.albedo = albedo.data();
    all.normal = normal.data();
    all.output = output.data();
  }
};

/// What `call` throws, with its kind.
template <typename Call>
std::string thrown(ErrorKind kind, Call call) {
  try {
    call();
  } catch (const Error& error) {
    CHECK(error.kind() == kind);
    CHECK_THAT(error.what(), Catch::StartsWith("--denoise: "));
    CHECK(!error.remedy().empty());
    return error.what();
  }
  return "nothing";
}

} // namespace

TEST_CASE("the filter gets light, albedo and normal as tight rows of float3, on a device of the threads asked for") {
  const FakeOidn fake;
  const TemporaryFolder folder;
  const Variable log("FAKE_OIDN_LOG", folder.file("log").c_str());
  const Denoiser denoiser(3);
  CHECK(denoiser.version() == "2.3.7");
  CHECK(denoiser.file() == fake_oidn("works") + "/libOpenImageDenoise.so.2");
  Images images;
  images.all.clean = true;
  denoiser.filter(images.all);
  const std::string of_image = ":7x5+0,12,84:3";
  CHECK(contents(folder.file("log")) == "RT albedo" + of_image + " color" + of_image + " normal" + of_image +
                                            " output" + of_image +
                                            " cleanAux=1 hdr=1 numThreads=3 setAffinity=0 committed=11\n");
  for (std::size_t i = 0; i < images.light.size(); ++i)
    CHECK(images.output[i] == images.light[i] * (1.0f + images.albedo[i] + images.normal[i]));
}

TEST_CASE("albedo and normal are denoised alone and in their place") {
  const FakeOidn fake;
  const TemporaryFolder folder;
  const Variable log("FAKE_OIDN_LOG", folder.file("log").c_str());
  const Denoiser denoiser(1);
  Images images;
  const std::vector<float> before = images.albedo;
  DenoiseImages alone;
  alone.width = width;
  alone.height = height;
  alone.albedo = alone.output = images.albedo.data();
  denoiser.filter(alone);
  CHECK(contents(folder.file("log")) ==
        "RT albedo:7x5+0,12,84:3 output:7x5+0,12,84:3 numThreads=1 setAffinity=0 committed=11\n");
  for (std::size_t i = 0; i < before.size(); ++i)
    CHECK(images.albedo[i] == 0.5f * before[i]);
}

TEST_CASE("a library that makes no device, or is too old, is refused with its own words") {
  const auto make = [] { Denoiser(1); };
  {
    const FakeOidn fake("no device");
    CHECK_THAT(thrown(ErrorKind::usage, make),
               Contains("cannot denoise on this processor: SSE4.1 support is required at minimum"));
  }
  {
    const FakeOidn fake("commit");
    CHECK_THAT(thrown(ErrorKind::usage, make), Contains("the device is made of paper"));
  }
  {
    const FakeOidn fake("old");
    CHECK_THAT(thrown(ErrorKind::usage, make),
               Contains("is Open Image Denoise 1.3.7, which is too old: version 2 is needed"));
  }
}

TEST_CASE("an error of the filter is told, and want of memory as such") {
  Images images;
  {
    const FakeOidn fake("filter");
    const Denoiser denoiser(1);
    const auto filter = [&] { denoiser.filter(images.all); };
    CHECK_THAT(thrown(ErrorKind::device, filter), Contains("Open Image Denoise 2.3.7 failed: the weights are gone"));
  }
  const FakeOidn fake("memory");
  const Denoiser denoiser(1);
  const auto filter = [&] { denoiser.filter(images.all); };
  CHECK_THAT(thrown(ErrorKind::memory, filter), Contains("failed: out of memory; set a smaller --size"));
}

TEST_CASE("the trial finds every fault in a process of its own, and a crash is told") {
  const auto trial = [] { try_denoiser(); };
  {
    const FakeOidn fake;
    CHECK(thrown(ErrorKind::usage, trial) == "nothing");
  }
  {
    const FakeOidn fake("crash");
    CHECK_THAT(thrown(ErrorKind::usage, trial), Contains("the library of Open Image Denoise crashes (Aborted)"));
  }
  {
    const FakeOidn fake("filter");
    CHECK_THAT(thrown(ErrorKind::device, trial), Contains("the weights are gone"));
  }
  {
    const FakeOidn fake("nan");
    CHECK_THAT(thrown(ErrorKind::usage, trial), Contains("makes a grey picture into nan"));
  }
  const Variable library("POINTGI_OIDN", "/nowhere");
  CHECK_THAT(thrown(ErrorKind::usage, trial), Contains("which is not there"));
}
