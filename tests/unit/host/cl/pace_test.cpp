/// How much work goes into a launch, and how work is cut.
#include "host/cl/batches.h"
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numeric>

using namespace pointgi;

namespace {

DeviceInfo device_of(bool is_cpu, unsigned units) {
  DeviceInfo info;
  info.is_cpu = is_cpu;
  info.is_gpu = !is_cpu;
  info.compute_units = units;
  return info;
}

/// Sizes of the launches that all `items` take on a device of `seconds_an_item`, and of `overhead` a launch.
template <class Items>
std::vector<std::size_t> sizes_of(const Items& items, Pace& pace, double seconds_a_unit, double overhead = 0.0) {
  std::vector<std::size_t> sizes;
  std::size_t next = 0;
  const std::size_t done = for_each_batch(items, pace, {}, [&](std::size_t first, std::size_t count) {
    CHECK(first == next);
    next += count;
    sizes.push_back(count);
    return overhead + seconds_a_unit * items.work(first, count);
  });
  CHECK(done == items.size);
  CHECK(next == items.size);
  return sizes;
}

} // namespace

TEST_CASE("launches of 0.2 ms grow to about 0.1 s, by 4 at most a launch") {
  const double seconds_a_unit = 2e-4 / 1000.0;
  Pace pace(1000.0);
  for (int launch = 0; launch < 12; ++launch) {
    const double work = pace.of_a_launch();
    pace.learn(work, seconds_a_unit * work);
    CHECK(pace.of_a_launch() <= 4.0 * work);
  }
  CHECK(pace.of_a_launch() * seconds_a_unit == Approx(launch_seconds));
}

TEST_CASE("launches that take too long shrink, by 4 at most a launch") {
  const double seconds_a_unit = 1e-3;
  Pace pace(1e6); // 1000 s
  for (int launch = 0; launch < 12; ++launch) {
    const double work = pace.of_a_launch();
    pace.learn(work, seconds_a_unit * work);
    CHECK(pace.of_a_launch() >= 0.25 * work);
  }
  CHECK(pace.of_a_launch() * seconds_a_unit == Approx(launch_seconds));
}

TEST_CASE("nonsense times and work teach a pace nothing, or little") {
  const double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  for (const double seconds : {0.0, -1.0, infinity, nan}) {
    Pace pace(1000.0);
    pace.learn(1000.0, seconds);
    CHECK(pace.of_a_launch() == 1000.0);
  }
  for (const double work : {0.0, -5.0, infinity, nan}) {
    Pace pace(1000.0);
    pace.learn(work, 0.05);
    CHECK(pace.of_a_launch() == 1000.0);
  }
  Pace small(1000.0), large(1000.0);
  for (int launch = 0; launch < 2000; ++launch) {
    small.learn(small.of_a_launch(), 1.8e10);
    large.learn(large.of_a_launch(), 1e-320);
  }
  CHECK(small.of_a_launch() == 1.0); // never 0, from which nothing could grow
  CHECK(std::isfinite(large.of_a_launch()));
  CHECK(large.of_a_launch() < 9e18); // what a size holds
  large.learn(large.of_a_launch(), 1.0);
  CHECK(large.of_a_launch() < 1e15); // and it shrinks again
}

TEST_CASE("a small rest that is mostly the launch itself does not shrink the next launch") {
  Pace pace(1e5);
  pace.learn(10.0, 2e-4); // at this rate 0.1 s were 5000
  CHECK(pace.of_a_launch() == 1e5);
}

TEST_CASE("no launch has fewer items than keep the compute units busy") {
  CHECK(busy_work_items(device_of(false, 132)) > 50 * busy_work_items(device_of(false, 2)));
  CHECK(busy_work_items(device_of(false, 8)) > busy_work_items(device_of(true, 8)));
  CHECK(busy_work_items(device_of(false, 0)) > 0); // a driver that knows no number
  Pace pace(1.0, busy_work_items(device_of(false, 16)));
  const auto sizes = sizes_of(EqualItems{100'000}, pace, 1e-2); // 10 items would be 0.1 s
  REQUIRE(sizes.size() > 1);
  for (std::size_t i = 0; i + 1 < sizes.size(); ++i)
    CHECK(sizes[i] == busy_work_items(device_of(false, 16)));
}

TEST_CASE("batches cover all items once, whatever their work is") {
  Pace equal(16.0, 4, 4096);
  const auto sizes = sizes_of(EqualItems{20'000}, equal, 1e-6);
  CHECK(*std::max_element(sizes.begin(), sizes.end()) == 4096);
  CHECK(sizes.front() == 16);
  std::vector<double> before{0.0};
  for (int i = 0; i < 5000; ++i)
    before.push_back(before.back() + (i % 7 == 0 ? 1e5 : 1.0)); // one item may be more than a launch
  Pace weighed(1e5);
  sizes_of(WeighedItems{before}, weighed, 1e-5);
  Pace none(100.0);
  CHECK(sizes_of(EqualItems{0}, none, 1e-6).empty());
}

TEST_CASE("a loop of launches stops when it is told to, and says how far it is") {
  Pace pace(100.0, 100, 100);
  std::vector<double> shares;
  const LaunchControl control{[&] { return shares.size() == 3; }, [&](double share) { shares.push_back(share); }};
  CHECK(for_each_batch(EqualItems{1000}, pace, control, [](std::size_t, std::size_t) { return 0.1; }) == 300);
  CHECK(shares == std::vector<double>{0.1, 0.2, 0.3});
}

TEST_CASE("a launch that is refused for want of resources is halved, and no later one is as large") {
  Pace pace(1000.0, 10);
  std::vector<std::size_t> sizes;
  std::vector<int> times(5000);
  for_each_batch(EqualItems{times.size()}, pace, {}, [&](std::size_t first, std::size_t count) {
    if (count > 300) throw ResourceError(ErrorKind::memory, "too much");
    for (std::size_t i = first; i < first + count; ++i)
      ++times[i];
    sizes.push_back(count);
    return 1e-3; // far shorter than a launch may be: it would grow
  });
  CHECK(std::count(times.begin(), times.end(), 1) == 5000);
  CHECK(sizes.front() == 250);
  CHECK(*std::max_element(sizes.begin(), sizes.end()) == 250);
}

TEST_CASE("where the smallest launch is refused, the error says so and keeps its kind") {
  Pace pace(1000.0, 64);
  std::size_t tries = 0;
  try {
    for_each_batch(EqualItems{5000}, pace, {}, [&](std::size_t, std::size_t) -> double {
      ++tries;
      throw ResourceError(ErrorKind::memory, "dev: 7 bytes are needed; use another --device");
    });
    FAIL("not refused");
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::memory);
    CHECK_THAT(error.what(), Catch::Contains("64 items") && Catch::Contains("7 bytes"));
    CHECK(error.remedy() == "use another --device");
  }
  CHECK(tries == 5); // 1000, 500, 250, 125, 64
}
