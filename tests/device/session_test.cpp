#include "host/cl/session.h"
#include "host/error.h"
#include "host/passes/variant.h"
#include "tests/support/device.h"
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>
#include <set>

using namespace pointgi;
using namespace pointgi::test;

TEST_CASE("launches that cannot work are refused before the device sees them") {
  Session& device = session();
  cl::Kernel kernel = device.kernel("test/probe.cl", build_options(TraversalVariant{}), "probe_rng");
  const auto out = device.allocate<cl_uint4>(64);
  const cl_uint count = 64;
  CHECK_THROWS_WITH(device.launch(kernel, LaunchShape::line(64), out), Catch::Contains("2 arguments, not 1"));
  CHECK_THROWS_WITH(device.launch(kernel, LaunchShape{{65, 1}, {64, 1}}, out, count), Catch::Contains("divide"));
  const std::size_t huge = std::size_t{1} << 20;
  CHECK_THROWS_WITH(device.launch(kernel, LaunchShape{{huge, 1}, {huge, 1}}, out, count),
                    Catch::Contains("work-groups"));
  CHECK_NOTHROW(device.launch(kernel, LaunchShape::line(64), out, count));
  CHECK(device.kernel_times().at("probe_rng").launches >= 1);
}

TEST_CASE("buffers larger than the device gives in one piece are refused with both figures") {
  Device device = choose_device("");
  device.info.max_allocation_bytes = 1 << 20; // as a small device would say
  Session small(device);
  CHECK_NOTHROW(small.allocate<char>(1 << 20));
  try {
    small.allocate<char>((1 << 20) + 1);
    FAIL("not refused");
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::memory);
    CHECK_THAT(error.what(), Catch::Contains("2 MiB") && Catch::Contains("1 MiB"));
  }
}

TEST_CASE("images larger than the device's are refused with the remedy") {
  Device device = choose_device("");
  device.info.image_buffer_texels = 100;
  device.info.image2d_height = 1;
  Session small(device);
  const std::vector<float> texels(4 * 5000);
  CHECK_THROWS_WITH(small.upload_image1d(texels.data(), 101, true), Catch::Contains("storage = \"buffer\""));
  CHECK_THROWS_WITH(small.upload_image2d(texels.data(), 5000, true, 12), Catch::Contains("storage = \"buffer\""));
}

TEST_CASE("device memory is counted while it is held") {
  Session counted(choose_device(""));
  {
    const auto a = counted.allocate<char>(1000), b = counted.allocate<char>(500);
    CHECK(counted.peak_bytes() == 1500);
  }
  const auto c = counted.allocate<char>(800);
  CHECK(counted.peak_bytes() == 1500);
}

TEST_CASE("devices are chosen by index, kind and part of the name") {
  const auto devices = list_devices();
  REQUIRE_FALSE(devices.empty());
  CHECK(choose_device("0").info.name == devices[0].info.name);
  CHECK(choose_device(devices[0].info.name.substr(1, 5)).info.name == devices[0].info.name);
  CHECK_THROWS_WITH(choose_device("99"), Catch::Contains("there is:") && Catch::Contains(devices[0].info.name));
  CHECK_THROWS_AS(choose_device("no such device"), Error);
}

TEST_CASE("programs of one file and several options are dumped side by side") {
  const TemporaryFolder folder;
  Session dumping(choose_device(""));
  dumping.dump_kernels_to(folder.file("dump"));
  for (const char* more : {"", " -D ONE", " -D TWO", ""})
    dumping.program("test/probe.cl", build_options(TraversalVariant{}) + more);
  std::set<std::string> options;
  for (const auto& entry : std::filesystem::directory_iterator(folder.file("dump"))) {
    CHECK(entry.path().extension() == ".cl");
    std::ifstream file(entry.path());
    std::string first;
    std::getline(file, first);
    options.insert(first);
  }
  CHECK(options.size() == 3);
}
