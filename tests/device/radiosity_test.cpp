/// Who takes part in the exchange of light, at the level of the passes.
#include "host/error.h"
#include "host/passes/build_pools.h"
#include "host/tune/variant_list.h"
#include "tests/support/cache_folder.h"
#include "tests/support/device.h"
#include "tests/support/radiosity.h"
#include "tests/support/rooms.h"
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace pointgi;
using namespace pointgi::test;

namespace {

/// A square of discs at this height, looking up or down (towards = 1 or -1), of a material.
void add_plate(std::vector<Splat>& splats, float height, float towards, float half_side, float material) {
  const int side = static_cast<int>(half_side / 0.0125f);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const auto at = [&](int i) { return 0.5f - half_side + 0.025f * (static_cast<float>(i) + 0.5f); };
      splats.push_back(make_splat(at(x), at(y), height, 0, 0, towards, 0.02f));
      splats.back().area = 0.025f * 0.025f;
      splats.back().material = material;
    }
}

/// Splats on the device, and what they exchange.
struct Stage {
  CacheFolder empty;
  std::string method;
  TraversalVariant variant = plain_variant(TraversalForm::wide);
  OctreePools pools;
  DevicePools on_device;

  explicit Stage(const std::vector<Splat>& splats, const std::string& by = "fmm")
      : method(by), pools(build_pools(splats, variant)), on_device(upload_pools(session(), pools, variant.storage)) {}

  View<Splat> points() const { return points_of(pools); }
  RadiosityMap map(const std::vector<std::uint8_t>& exchanges) const {
    return map_visibility(session(), {on_device, variant, points(), exchanges}, {}, quiet);
  }
  std::unique_ptr<PreparedRadiosity> prepared(const std::vector<std::uint8_t>& exchanges) const {
    RadiositySettings settings;
    settings.method = method;
    return prepare_radiosity(session(), {on_device, variant, points(), exchanges}, settings);
  }
  static void quiet(const std::string&) {}
  /// `direct` is 1 on the points of this material and 0 on others.
  std::vector<float> irradiance(const std::vector<std::uint8_t>& exchanges, float lit_material) const {
    std::vector<float> direct(3 * points().size, 0.0f);
    for (std::size_t p = 0; p < points().size; ++p)
      if (points()[p].material == lit_material) std::fill_n(&direct[3 * p], 3, 1.0f);
    return prepared(exchanges)->solve({direct, {}}, 1e-3, quiet).irradiance;
  }
};

/// Largest irradiance of the points of a material.
float most_of(const Stage& stage, const std::vector<float>& irradiance, float material) {
  float most = 0.0f;
  for (std::size_t p = 0; p < stage.points().size; ++p)
    if (stage.points()[p].material == material)
      most = std::max({most, irradiance[3 * p], irradiance[3 * p + 1], irradiance[3 * p + 2]});
  return most;
}

} // namespace

TEST_CASE("a wall that does not exchange light gets none and sends none") {
  const std::string method = GENERATE("fmm", "direct");
  std::vector<Splat> splats = room_splats(3000);
  for (Splat& s : splats)
    s.material = s.position[0] > 0.89f ? 1.0f : 0.0f; // the wall at x = 0.9
  const Stage room(splats, method);
  const auto all_take_part = room.irradiance({1, 1}, 1.0f), none_sent = room.irradiance({1, 0}, 1.0f),
             none_received = room.irradiance({1, 0}, 0.0f);
  CHECK(most_of(room, all_take_part, 0.0f) > 0.05f);
  CHECK(most_of(room, none_sent, 0.0f) == 0.0f); // the only light falls on it
  CHECK(most_of(room, none_received, 1.0f) == 0.0f);
  CHECK(most_of(room, none_received, 0.0f) > 0.3f);
}

TEST_CASE("what does not exchange light still blocks it") {
  const std::string method = GENERATE("fmm", "direct");
  std::vector<Splat> plates;
  add_plate(plates, 0.25f, 1.0f, 0.1f, 0.0f);
  add_plate(plates, 0.75f, -1.0f, 0.1f, 1.0f);
  const Stage open(plates, method);
  // Between two squares of side 0.2 at distance 0.5, albedo 0.5: about 0.5 A / (pi d^2) = 0.025 in the middle.
  CHECK(most_of(open, open.irradiance({1, 1}, 0.0f), 1.0f) == Approx(0.025f).epsilon(0.15));
  add_plate(plates, 0.5f, 1.0f, 0.3f, 2.0f);
  const Stage blocked(plates, method);
  const auto found = blocked.irradiance({1, 1, 0}, 0.0f);
  CHECK(most_of(blocked, found, 1.0f) == 0.0f);
  CHECK(most_of(blocked, found, 2.0f) == 0.0f);
}

TEST_CASE("where nothing exchanges light nothing is asked and all is dark") {
  const Stage room(room_splats(500), GENERATE("fmm", "direct"));
  CHECK(room.prepared({0})->rays() == 0);
  const auto irradiance = room.irradiance({0}, 0.0f);
  REQUIRE(irradiance.size() == 3 * room.points().size);
  CHECK(*std::max_element(irradiance.begin(), irradiance.end()) == 0.0f);
}

TEST_CASE("V-map and FMM end between two launches when they are told to, and can be made again") {
  const CacheFolder no_kept_map; // one that an earlier run left would ask the device nothing
  const Stage room(room_splats(2000));
  const std::vector<float> direct(3 * room.points().size, 1.0f);
  const auto stops_after = [](int launches, const auto& work) {
    session().before_launches([&launches] {
      if (launches-- == 0) throw Error(ErrorKind::interrupted, "stop");
    });
    CHECK_THROWS_AS(work(), Error);
    session().before_launches({});
  };
  stops_after(2, [&] { room.map({1}); });
  const RadiosityMap map = room.map({1});
  CHECK_FALSE(map.kept); // what was not finished was not kept
  CHECK(room.prepared({1})->rays() == map.vmap.statistics.rays);
  const auto prepared = room.prepared({1});
  stops_after(7, [&] { prepared->solve({direct, {}}, 1e-3, Stage::quiet); });
  const auto once = prepared->solve({direct, {}}, 1e-3, Stage::quiet).irradiance;
  CHECK(room.prepared({1})->solve({direct, {}}, 1e-3, Stage::quiet).irradiance == once);
}

TEST_CASE("a prepared method solves for light after light: rays of one, bits of one made anew, sums of lights") {
  const CacheFolder no_kept_map;
  const std::string method = GENERATE("fmm", "direct");
  const Stage room(room_splats(2000), method);
  // Light from the left and from above, and both.
  std::vector<float> left(3 * room.points().size), above(left.size()), both(left.size());
  for (std::size_t i = 0; i < left.size(); ++i) {
    left[i] = 1.0f - room.points()[i / 3].position[0];
    above[i] = room.points()[i / 3].position[2];
    both[i] = left[i] + above[i];
  }
  const double tolerance = 1e-5;
  const auto solve = [&](PreparedRadiosity& prepared, const std::vector<float>& light) {
    return prepared.solve({light, {}}, tolerance, Stage::quiet).irradiance;
  };
  const auto kept = room.prepared({1});
  const std::uint64_t rays = kept->rays();
  CHECK(rays > 1000);
  const std::vector<std::string> tracers{"segments_blocked", "pairs_visible"};
  const auto launches = [&] {
    std::size_t count = 0;
    for (const std::string& kernel : tracers)
      if (const auto at = session().kernel_times().find(kernel); at != session().kernel_times().end())
        count += at->second.launches;
    return count;
  };
  const std::size_t before = launches();
  CHECK(before > 0);
  const auto of_left = solve(*kept, left), of_above = solve(*kept, above), of_both = solve(*kept, both);
  CHECK(launches() == before); // nothing is traced again
  CHECK(kept->rays() == rays);
  CHECK(solve(*room.prepared({1}), above) == of_above);
  CHECK(radiosity_method(method)->is_linear);
  double difference = 0.0, norm = 0.0;
  for (std::size_t i = 0; i < left.size(); ++i) {
    difference += std::pow(double{of_left[i]} + of_above[i] - of_both[i], 2);
    norm += std::pow(double{of_both[i]}, 2);
  }
  CAPTURE(std::sqrt(difference / norm));
  // The solver's residual, of power and not of squares; fmm's mid links judge each light by itself, which is 1e-4.
  CHECK(std::sqrt(difference / norm) < (method == "direct" ? 5.0 * tolerance : 1e-3));
}
