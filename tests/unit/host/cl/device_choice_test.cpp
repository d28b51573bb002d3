/// Which device is used, of devices that nobody has here.
#include "host/cl/device_choice.h"
#include "host/error.h"
#include <catch2/catch.hpp>
#include <set>

using namespace pointgi;
using Catch::Contains;

namespace {

DeviceInfo device(const std::string& name, char kind, std::uint64_t gigabytes) {
  DeviceInfo info;
  info.name = name;
  info.platform = "Fake";
  info.is_gpu = kind == 'g';
  info.is_cpu = kind == 'c';
  info.memory_bytes = gigabytes << 30;
  return info;
}

/// A computer with everything in it.
const std::vector<DeviceInfo>& devices() {
  static const std::vector<DeviceInfo> all{device("Xeon", 'c', 256), device("Small GPU", 'g', 4),
                                           device("FPGA", 'a', 64), device("Large GPU", 'g', 24),
                                           device("Other Small GPU", 'g', 4)};
  return all;
}

/// A test that only these fail, which notes who was asked.
struct FakeTest {
  std::set<std::size_t> broken;
  std::vector<std::size_t> asked;

  DeviceTest test() {
    return [this](std::size_t place) {
      asked.push_back(place);
      return broken.count(place) != 0 ? "kernels/a.cl did not compile at place " + std::to_string(place) : "";
    };
  }
};

} // namespace

TEST_CASE("without a selector the GPU of most memory is taken, and no other is tested") {
  FakeTest fake;
  const DeviceChoice choice = choose_among(devices(), "", fake.test());
  CHECK(devices()[choice.place].name == "Large GPU");
  CHECK(choice.warnings.empty());
  CHECK(fake.asked == std::vector<std::size_t>{3});
}

TEST_CASE("a GPU that does not pass its test is left with a warning, for the next and at last for the CPU") {
  FakeTest one{{3}, {}}, gpus{{1, 3, 4}, {}};
  DeviceChoice choice = choose_among(devices(), "", one.test());
  CHECK(choice.place == 1); // of equal ones the first
  REQUIRE(choice.warnings.size() == 1);
  CHECK_THAT(choice.warnings[0], Contains("Large GPU") && Contains("did not compile at place 3"));
  choice = choose_among(devices(), "", gpus.test());
  CHECK(devices()[choice.place].name == "Xeon");
  CHECK(choice.warnings.size() == 3);
  CHECK(gpus.asked == std::vector<std::size_t>{3, 1, 4}); // a CPU is not asked
}

TEST_CASE("a device that is named and does not pass its test is an error with the reason") {
  for (const char* selector : {"3", "gpu", "large"}) {
    FakeTest fake{{3}, {}};
    try {
      choose_among(devices(), selector, fake.test());
      FAIL("taken");
    } catch (const Error& error) {
      CHECK(error.kind() == ErrorKind::device);
      CHECK_THAT(error.what(), Contains("Large GPU") && Contains("did not compile at place 3"));
      CHECK_THAT(error.remedy(), Contains("--device"));
    }
  }
  FakeTest fake{{3}, {}};
  CHECK(choose_among(devices(), "cpu", fake.test()).place == 0);
  CHECK(choose_among(devices(), "fpga", fake.test()).place == 2);
  CHECK(choose_among(devices(), "1", fake.test()).place == 1);
  CHECK(fake.asked == std::vector<std::size_t>{2, 1});
}

TEST_CASE("where no device works or none is there, the error says so") {
  FakeTest fake{{0}, {}};
  CHECK_THROWS_WITH(choose_among({device("Lone GPU", 'g', 8)}, "", fake.test()),
                    Contains("no OpenCL device works") && Contains("Lone GPU"));
  CHECK_THROWS_WITH(choose_among({}, "", fake.test()), Contains("no OpenCL device was found"));
  CHECK_THROWS_WITH(choose_among(devices(), "quantum", fake.test()), Contains("there is:") && Contains("3  Large GPU"));
  CHECK_THROWS_WITH(choose_among(devices(), "5", fake.test()), Contains("there is:"));
}
