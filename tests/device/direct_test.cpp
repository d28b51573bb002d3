/// The direct solver on the device: rays and sums of all pairs, against linear scans in double.
#include "fmm/ref/direct_sum.h"
#include "host/error.h"
#include "host/passes/build_pools.h"
#include "host/radiosity/direct.h"
#include "host/tune/variant_list.h"
#include "octree/ref/segment_blocked.h"
#include "tests/support/device.h"
#include "tests/support/exchange.h"
#include "tests/support/rooms.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;

namespace {

std::vector<std::uint32_t> all_of(std::size_t count) {
  std::vector<std::uint32_t> all(count);
  for (std::uint32_t i = 0; i < count; ++i)
    all[i] = i;
  return all;
}

/// Visibility of all pairs, from the lower index to the higher, by any oracle.
class AllPairs {
public:
  AllPairs(std::size_t points, VisibilityOracle& oracle) : points_(points) {
    std::vector<Segment> segments;
    for (std::uint32_t i = 0; i < points; ++i)
      for (std::uint32_t j = 0; j < i; ++j)
        segments.push_back({j, i});
    blocked_ = oracle.blocked(segments);
  }
  double operator()(std::uint32_t i, std::uint32_t j) const {
    const std::size_t high = std::max(i, j), low = std::min(i, j);
    return i == j || blocked_[high * (high - 1) / 2 + low] ? 0.0 : 1.0;
  }
  std::size_t blocked() const { return static_cast<std::size_t>(std::count(blocked_.begin(), blocked_.end(), 1)); }

private:
  std::size_t points_;
  std::vector<std::uint8_t> blocked_;
};

struct Traced {
  std::vector<Splat> splats;
  TraversalVariant variant = plain_variant(TraversalForm::wide);
  DevicePools pools;

  explicit Traced(std::vector<Splat> s, TraversalVariant v = plain_variant(TraversalForm::wide))
      : splats(std::move(s)), variant(v), pools(upload_pools(session(), build_pools(splats, v), v.storage)) {}

  std::vector<double> irradiance(View<double> radiosity, const DirectOptions& options = {}) const {
    DeviceDirect direct(session(), pools, variant, splats, options);
    std::vector<double> h;
    direct.apply(radiosity, LinearisationPoint::current, h);
    return h;
  }
};

} // namespace

TEST_CASE("direct on the device: every pair by a ray, as a linear scan and a sum in double") {
  // Walls that meet, seen across their edges from closer than a source is a point; then a body that hides.
  for (const auto& splats : {inside_cube(9), room_splats(700)}) {
    const Traced scene(splats);
    CAPTURE(splats.size());
    const auto b = varied_radiosity(splats);
    const auto h = scene.irradiance(b);
    LinearScan scan(splats, splats);
    const AllPairs visible(splats.size(), scan);
    const std::size_t pairs = splats.size() * (splats.size() - 1) / 2;
    if (splats.size() != 486) CHECK(visible.blocked() > pairs / 5);
    // A few roundings of 6e-8 a pair, and sums of 256 of them, make 2e-7. One pair that float and double do not see
    // alike would be 1e-4; none of these 200,000 is so near a rim.
    CHECK(relative_l2(h, direct_sum(splats, b, all_of(splats.size()), std::cref(visible))) < 1e-6);
  }
}

TEST_CASE("direct on the device: the same bits in every variant and in any pieces of memory") {
  const auto splats = room_splats(670); // no whole number of blocks
  REQUIRE(splats.size() % FMM_LANES != 0);
  const auto b = varied_radiosity(splats);
  const auto first = Traced(splats).irradiance(b);
  for (const TraversalForm form : traversal_forms()) {
    const Traced scene(splats, plain_variant(form));
    for (const bool keep : {true, false})
      for (const std::uint64_t bytes : {1u, 30000u, 1u << 30}) { // a row of squares a piece, two and one, all
        CAPTURE(name_of(scene.variant), keep, bytes);
        DirectOptions options;
        options.keep = keep;
        options.rays_a_pair = keep ? 1 : 2;
        options.allocation_bytes = bytes;
        double done = 0.0;
        options.progress = [&](double share) {
          CHECK(share >= done);
          done = share;
        };
        CHECK(scene.irradiance(b, options) == first);
        CHECK(done == Approx(1.0));
      }
  }
}

TEST_CASE("direct on the device: rays of facing pairs only, each once") {
  const Traced scene(inside_cube(12));
  DeviceDirect direct(session(), scene.pools, scene.variant, scene.splats, {});
  const std::uint64_t per_face = 144, pairs_of_faces = 15;
  CHECK(direct.points() == 6 * per_face);
  CHECK(direct.rays() == pairs_of_faces * per_face * per_face); // none within a wall, none twice
  CHECK(direct.trace_seconds() > 0.0);
}

TEST_CASE("direct on the device: linear, and the same bits again") {
  const Traced scene(room_splats(1500));
  DeviceDirect direct(session(), scene.pools, scene.variant, scene.splats, {});
  const auto b = varied_radiosity(scene.splats);
  std::vector<double> h, again, turned(b);
  direct.apply(b, LinearisationPoint::current, h);
  direct.apply(b, LinearisationPoint::kept, again);
  CHECK(h == again);
  for (double& value : turned)
    value = -value;
  direct.apply(turned, LinearisationPoint::kept, again);
  for (double& value : again)
    value = -value;
  CHECK(h == again);
  CHECK_THROWS_AS(direct.apply(View<double>(b.data(), b.size() - 1), LinearisationPoint::current, h),
                  std::invalid_argument);
}

TEST_CASE("direct on the device: what does not fit is refused with what is wanted, what there is, and what to do") {
  const Traced scene(room_splats(2500));
  DirectOptions options;
  options.memory_bytes = direct_bytes(scene.splats.size()) - 1;
  try {
    DeviceDirect(session(), scene.pools, scene.variant, scene.splats, options);
    FAIL("it took less than a bit a pair");
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::memory);
    CHECK_THAT(error.what(),
               Catch::Contains(std::to_string(scene.splats.size()) + " points takes a bit a pair, 1 MiB") &&
                   Catch::Contains("1 MiB left") && Catch::Contains("\"fmm\""));
  }
  DeviceDirect none(session(), scene.pools, scene.variant, View<Splat>(), {});
  std::vector<double> h{1.0};
  none.apply(View<double>(), LinearisationPoint::current, h);
  CHECK(h.empty());
}
