#include "host/cloud/geographic.h"
#include <catch2/catch.hpp>
#include <limits>

using namespace pointgi;
using Eigen::Vector3d;

namespace {

/// A field of 11 x 11 points, `step` apart, that rises by `height` over all.
std::vector<Vector3d> field_at(const Vector3d& corner, double step, double height) {
  std::vector<Vector3d> points;
  for (int i = 0; i < 121; ++i)
    points.push_back(corner + Vector3d(i % 11 * step, i / 11 * step, i * height / 120.0));
  return points;
}

} // namespace

TEST_CASE("geographic: metres a degree are those of WGS 84") {
  struct Known {
    double latitude, longitude_m, latitude_m; // Wikipedia, "Geographic coordinate system": lengths of a degree
  };
  for (const Known& known :
       {Known{0, 111320, 110574}, {30, 96486, 110852}, {60, 55800, 111412}, {-45, 78847, 111132}}) {
    const auto placement = degrees_to_metres(field_at({10, known.latitude - 0.005, 100}, 0.001, 20), true);
    REQUIRE(placement.has_value());
    CHECK(placement->scale.x() == Approx(known.longitude_m).margin(1.0)); // whole metres
    CHECK(placement->scale.y() == Approx(known.latitude_m).margin(1.0));
    CHECK(placement->scale.z() == 1.0);
    CHECK(((*placement)(placement->middle()) - placement->middle()).norm() == 0.0);
  }
}

TEST_CASE("geographic: without a word in the file only the shape of a needle is one of degrees") {
  const std::vector<Vector3d> terrain = field_at({8.5, 47.3, 400}, 0.001, 30); // a kilometre, 30 m high
  CHECK(degrees_to_metres(terrain, false).has_value());
  CHECK_FALSE(degrees_to_metres(field_at({-0.15, -0.15, 0}, 0.03, 25), false).has_value()); // a mast, 25 m high
  CHECK_FALSE(degrees_to_metres(field_at({0, 0, 0}, 0.1, 0.5), false).has_value());         // a table
  CHECK_FALSE(degrees_to_metres(field_at({6e5, 4e6, 300}, 0.001, 30), false).has_value());  // of a map
  CHECK_FALSE(degrees_to_metres(field_at({6e5, 4e6, 300}, 0.001, 30), true).has_value());   // whatever it says
  CHECK_FALSE(degrees_to_metres(std::vector<Vector3d>(9, {1, 1, 1}), false).has_value());   // one place
  std::vector<Vector3d> with_gaps = terrain;
  with_gaps.push_back(Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
  CHECK(degrees_to_metres(with_gaps, false).has_value());
}
