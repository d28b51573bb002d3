/// What happens when the device refuses: faults are injected where the device would be asked.
#include "host/error.h"
#include "host/passes/build_pools.h"
#include "host/passes/visibility.h"
#include "host/radiosity/fmm.h"
#include "host/tune/variant_list.h"
#include "tests/support/clouds.h"
#include "tests/support/device.h"
#include "tests/support/exchange.h"
#include <catch2/catch.hpp>
#include <cstring>

using namespace pointgi;
using namespace pointgi::test;
using Catch::Contains;
using Kind = DeviceCall::Kind;

namespace {

/// A function that gives `code` to calls of `kind`, from the one after `lets_pass` on.
FaultInjector faults(Kind kind, int code, int lets_pass = 0) {
  return [=, seen = 0](const DeviceCall& call) mutable {
    return call.kind == kind && seen++ >= lets_pass ? code : CL_SUCCESS;
  };
}

Error error_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error;
  }
  FAIL("no error");
  return {ErrorKind::internal, ""};
}

/// The default device as if it had two compute units, for which launches may be small.
Device small_device() {
  Device device = choose_device("");
  device.info.compute_units = 2;
  return device;
}

/// One kernel, ready to be launched.
struct Probe {
  Session device{choose_device("")};
  cl::Kernel kernel = device.kernel("test/probe.cl", build_options(TraversalVariant{}), "probe_rng");
  Buffer<cl_uint4> out = device.allocate<cl_uint4>(64);

  void launch() { device.launch(kernel, LaunchShape::line(64), out, cl_uint{64}); }
};

} // namespace

TEST_CASE("a launch without resources is no lack of memory by itself, and says what it may be", "[faults]") {
  Probe probe;
  probe.device.inject_faults(faults(Kind::launch, CL_OUT_OF_RESOURCES));
  const Error resources = error_of([&] { probe.launch(); });
  CHECK(resources.kind() == ErrorKind::device);
  CHECK_THAT(resources.what(), Contains("probe_rng") && Contains("CL_OUT_OF_RESOURCES") && Contains("registers") &&
                                   Contains("lost") && Contains("64 work-items") && Contains("1024 bytes"));
  probe.device.inject_faults(faults(Kind::launch, CL_MEM_OBJECT_ALLOCATION_FAILURE));
  const Error memory = error_of([&] { probe.launch(); });
  CHECK(memory.kind() == ErrorKind::memory);
  CHECK_THAT(memory.what(), Contains(std::to_string(probe.device.info().memory_bytes) + " bytes"));
  probe.device.inject_faults({});
  CHECK_NOTHROW(probe.launch());
}

TEST_CASE("a buffer that the device refuses is too much memory: required, held and available are told", "[faults]") {
  Probe probe;
  for (const int code : {CL_OUT_OF_RESOURCES, CL_MEM_OBJECT_ALLOCATION_FAILURE, CL_OUT_OF_HOST_MEMORY}) {
    probe.device.inject_faults(faults(Kind::allocation, code));
    const Error error = error_of([&] { probe.device.allocate<char>(5'000'000); });
    CHECK(error.kind() == ErrorKind::memory);
    CHECK_THAT(error.what(), Contains("5000000 bytes") && Contains("hold 1024 bytes") &&
                                 Contains(std::to_string(probe.device.info().memory_bytes) + " bytes"));
    CHECK_FALSE(error.remedy().empty());
  }
}

TEST_CASE("a program that does not build, and copies that fail, are errors of the device", "[faults]") {
  Session device(choose_device(""));
  device.inject_faults(faults(Kind::build, CL_BUILD_PROGRAM_FAILURE));
  // No cache has heard of these options.
  CHECK(error_of([&] { device.program("test/probe.cl", build_options({}) + " -D FAULTY"); }).kind() ==
        ErrorKind::device);
  const auto buffer = device.allocate<char>(16);
  device.inject_faults(faults(Kind::download, CL_INVALID_VALUE));
  CHECK(error_of([&] { device.download(buffer, 16); }).kind() == ErrorKind::device);
}

TEST_CASE("segments that are too many for the device's memory are asked in smaller launches", "[faults]") {
  Session device(small_device());
  const TraversalVariant variant = plain_variant(TraversalForm::step);
  const auto splats = mixed_splats();
  const DevicePools pools = upload_pools(device, build_pools(splats, variant), variant.storage);
  std::vector<Segment> segments;
  for (std::uint32_t i = 0; i < 60'000; ++i)
    segments.push_back({static_cast<std::uint32_t>(i * 7919u % splats.size()),
                        static_cast<std::uint32_t>(i * 104'729u % splats.size())});
  const auto answers = [&](std::size_t most_items) {
    std::size_t refused = 0;
    device.inject_faults([&](const DeviceCall& call) {
      const bool fails = call.kind == Kind::launch && call.work_items > most_items;
      refused += fails;
      return fails ? CL_OUT_OF_RESOURCES : CL_SUCCESS;
    });
    DeviceVisibility visibility(device, pools, variant, splats);
    const auto blocked = visibility.blocked(segments);
    device.inject_faults({});
    CHECK((refused > 0) == (most_items < segments.size()));
    return blocked;
  };
  CHECK(answers(1000) == answers(segments.size()));
  CHECK_THROWS_WITH(answers(0), Contains("smallest") && Contains("CL_OUT_OF_RESOURCES"));
  device.inject_faults({});
}

TEST_CASE("radiosity has the same bits where the device refuses large launches", "[faults]") {
  Session device(small_device());
  const ClusterTree tree = build_clusters(inside_sphere(5000), {});
  const auto links = links_without_visibility(tree);
  const auto b = varied_radiosity(tree.points);
  const auto irradiance = [&](std::size_t most_items) {
    std::size_t refused = 0;
    DeviceFmm fmm(device, tree, links, {});
    device.inject_faults([&](const DeviceCall& call) {
      const bool fails = call.kind == Kind::launch && call.work_items > most_items;
      refused += fails;
      return fails ? CL_MEM_OBJECT_ALLOCATION_FAILURE : CL_SUCCESS;
    });
    std::vector<double> h;
    fmm.apply(b, LinearisationPoint::current, h);
    device.inject_faults({});
    CHECK((refused > 0) == (most_items < 1'000'000));
    return h;
  };
  CHECK(irradiance(200) == irradiance(1'000'000));
}

TEST_CASE("a fill takes one value to the device, and leaves the rest of the buffer alone", "[faults]") {
  Session device(choose_device(""));
  std::uint64_t uploaded = 0;
  const auto filled = [&](auto value, auto before, std::size_t count) {
    const std::size_t size = count + 5;
    using T = decltype(value);
    const auto buffer = device.allocate<T>(size);
    device.fill(buffer, before, size);
    uploaded = 0;
    device.inject_faults([&](const DeviceCall& call) {
      uploaded += call.kind == Kind::upload ? call.bytes : 0;
      return CL_SUCCESS;
    });
    device.fill(buffer, value, count);
    device.inject_faults({});
    CHECK(uploaded <= sizeof(T));
    const std::vector<T> found = device.download(buffer, size);
    const auto is = [&](const T& expected) {
      return [&](const T& one) { return std::memcmp(&one, &expected, sizeof(T)) == 0; };
    };
    CHECK(std::all_of(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count), is(value)));
    CHECK(std::all_of(found.begin() + static_cast<std::ptrdiff_t>(count), found.end(), is(before)));
  };
  struct Odd {
    cl_uint words[3];
  };
  struct Large {
    cl_uint words[64];
  };
  for (const std::size_t count : {0, 1, 2, 3, 1000}) {
    filled(2.5f, -1.0f, count);
    filled(cl_float4{{1, 2, 3, 4}}, cl_float4{{9, 9, 9, 9}}, count);
    filled(Odd{{1, 2, 3}}, Odd{{7, 7, 7}}, count);
    filled(Large{{1, 2, 3}}, Large{{7, 7, 7}}, count);
  }
}
