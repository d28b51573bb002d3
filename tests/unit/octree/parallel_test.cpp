#include "octree/pack/pools.h"
#include "octree/parallel.h"
#include "tests/support/clouds.h"
#include <atomic>
#include <catch2/catch.hpp>
#include <cstring>
#include <omp.h>
#include <stdexcept>
#include <thread>

using namespace pointgi;
using namespace pointgi::test;

namespace {

struct Threads {
  explicit Threads(int count) { omp_set_num_threads(count); }
  ~Threads() { omp_set_num_threads(before); }
  int before = omp_get_max_threads();
};

template <class T>
bool same_bits(const Pool<T>& a, const Pool<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}
bool same_bits(const StepPools& a, const StepPools& b) {
  return same_bits(a.nodes, b.nodes) && same_bits(a.begin_end, b.begin_end) && same_bits(a.points, b.points) &&
         same_bits(a.source, b.source) && a.depth == b.depth && a.leaves == b.leaves;
}
bool same_bits(const WidePools& a, const WidePools& b) {
  return same_bits(a.nodes, b.nodes) && same_bits(a.blocks, b.blocks) && same_bits(a.points, b.points) &&
         same_bits(a.source, b.source) && a.depth == b.depth && a.leaves == b.leaves;
}

} // namespace

TEST_CASE("a parallel loop meets every item once, whatever the threads, in a loop inside it too") {
  const Threads threads(GENERATE(1, 2, 5));
  const std::size_t n = GENERATE(0u, 1u, 99u, 100u, 1001u);
  std::vector<std::atomic<int>> met(n);
  parallel_ranges(n, 100, [&](std::size_t begin, std::size_t end) {
    parallel_ranges(end - begin, 7, [&](std::size_t from, std::size_t to) {
      for (std::size_t i = begin + from; i < begin + to; ++i)
        ++met[i];
    });
  });
  CHECK(std::all_of(met.begin(), met.end(), [](const auto& count) { return count == 1; }));
}

TEST_CASE("a parallel loop hands its exception on, and the next loop is none the worse") {
  const Threads threads(GENERATE(1, 2, 5));
  for (int k = 0; k < 100; ++k) {
    CHECK_THROWS_AS(parallel_ranges(50, 1,
                                    [](std::size_t i, std::size_t) {
                                      if (i == 33) throw std::length_error("");
                                    }),
                    std::length_error);
    std::atomic<int> met{0};
    parallel_ranges(50, 1, [&](std::size_t, std::size_t) { ++met; });
    CHECK(met == 50);
  }
}

TEST_CASE("parallel loops of several threads at once all end") {
  const Threads threads(3);
  std::atomic<int> met{0};
  std::vector<std::thread> callers;
  for (int t = 0; t < 4; ++t)
    callers.emplace_back([&] {
      for (int k = 0; k < 200; ++k)
        parallel_ranges(20, 1, [&](std::size_t, std::size_t) { ++met; });
    });
  for (std::thread& caller : callers)
    caller.join();
  CHECK(met == 4 * 200 * 20);
}

TEST_CASE("the pools are the same bits for any number of threads") {
  std::vector<Splat> splats;
  SECTION("none") {}
  SECTION("one") {
    splats = random_splats(1, 5);
  }
  SECTION("anywhere, small") {
    splats = random_splats(40'000, 7);
    for (Splat& s : splats)
      s.radius *= 0.05f;
  }
  SECTION("hard ones") {
    splats = mixed_splats();
  }
  SECTION("in one place, and some around") {
    splats.assign(20'000, make_splat(0.3f, 0.3f, 0.3f, 0, 1, 1, 1e-7f));
    const auto around = sphere_splats(20'000);
    splats.insert(splats.end(), around.begin(), around.end());
  }
  for (const PointOrder order : {PointOrder::morton, PointOrder::hilbert}) {
    TreeOptions options;
    options.order = order;
    TreeOptions centres = options;
    centres.listing = Listing::centres;
    centres.leaf_capacity = 64;
    const auto step = [&] { return pack_step(splats, build_tree(splats, options)); };
    const auto wide = [&] { return pack_wide(splats, build_tree(splats, centres), 8); };
    const Threads one(1);
    const StepPools step_truth = step();
    const WidePools wide_truth = wide();
    for (const int count : {2, 5}) {
      const Threads several(count);
      CHECK(same_bits(step(), step_truth));
      CHECK(same_bits(wide(), wide_truth));
    }
  }
}

TEST_CASE("a parallel loop ends where its caller's question throws, and asks no other thread") {
  const Threads threads(GENERATE(1, 2, 5));
  static int left;
  static std::thread::id caller;
  left = 3;
  caller = std::this_thread::get_id();
  before_ranges([] {
    REQUIRE(std::this_thread::get_id() == caller);
    if (left-- == 0) throw std::runtime_error("enough");
  });
  std::atomic<std::size_t> ranges{0};
  const auto body = [&](std::size_t, std::size_t) {
    ++ranges;
    std::this_thread::yield();
  };
  CHECK_THROWS_WITH(parallel_ranges(10'000'000, 1, body), "enough");
  before_ranges(nullptr);
  CHECK(ranges < 10'000'000);
  ranges = 0;
  parallel_ranges(100, 1, body);
  CHECK(ranges == 100);
}

TEST_CASE("a parallel sum has the same bits for any number of threads, and meets every item") {
  const std::size_t n = GENERATE(0u, 1u, 100u, 1001u);
  const auto sum_of = [&](int count) {
    const Threads threads(count);
    return parallel_sum(n, 100, 0.0, [](double& sum, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        sum += 1.0 / static_cast<double>(i + 1);
    });
  };
  double serial = 0;
  for (std::size_t i = 0; i < n; ++i)
    serial += 1.0 / static_cast<double>(i + 1);
  const double alone = sum_of(1);
  CHECK(alone == Approx(serial).epsilon(1e-14)); // a thousand roundings
  CHECK(sum_of(2) == alone);
  CHECK(sum_of(5) == alone);
}
