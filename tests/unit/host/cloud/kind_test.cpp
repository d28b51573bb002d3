#include "host/cloud/kind.h"
#include "host/cloud/site_spacing.h"
#include <catch2/catch.hpp>
#include <random>

using namespace pointgi;
using Eigen::Vector3d;
using Eigen::Vector3f;

namespace {

/// Points of a rolling surface, or of it and a ceiling over it, a fifth of a side above.
RecognisedKind kind_of_hills(int side, bool ceiling) {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> within(0.0, 1.0);
  std::vector<Vector3d> places;
  for (int i = 0; i < side * side; ++i) {
    const double x = within(random), y = within(random);
    places.emplace_back(x, y, 0.05 * std::sin(9.0 * x) * std::cos(7.0 * y) + (ceiling && i % 2 == 0 ? 0.2 : 0.0));
  }
  const Sites sites(places);
  const std::vector<float> spacing = spacings_of(sites);
  const std::vector<Vector3f> normals(sites.size(), Vector3f::UnitZ());
  return recognise_kind(sites, spacing, normals, {}, FreeSpace(sites, spacing, 128), {false, {}, nullptr, {}, true});
}

} // namespace

TEST_CASE("a height field is terrain, one of two layers is none, however many points there are", "[cloud]") {
  const int side = GENERATE(100, 1100); // of over a million points only some columns are looked at
  const RecognisedKind hills = kind_of_hills(side, false);
  CHECK(hills.kind == CloudKind::terrain);
  REQUIRE(hills.up);
  CHECK(*hills.up == Vector3d::UnitZ());
  CHECK(kind_of_hills(side, true).kind != CloudKind::terrain);
}
