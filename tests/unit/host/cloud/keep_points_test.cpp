#include "host/cloud/keep_points.h"
#include <catch2/catch.hpp>

using namespace pointgi;

namespace {

/// Every attribute of point i tells i.
PointCloud numbered(std::uint32_t count) {
  PointCloud cloud;
  cloud.fields.push_back({{"intensity", FieldType::u16}, {}});
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto value = static_cast<float>(i);
    cloud.position.emplace_back(i, 0, 0);
    cloud.normal.emplace_back(value, 0.0f, 0.0f);
    cloud.colour.emplace_back(value, 0.0f, 0.0f);
    cloud.radius.push_back(value);
    cloud.area.push_back(value);
    cloud.structure.push_back(i % 2 == 0 ? Structure::surface : Structure::line);
    cloud.station.push_back(static_cast<std::uint16_t>(i));
    cloud.fields[0].values.push_back(i);
    if (i % 2 == 1) cloud.clipped.push_back({i, {{{{{1, 0, 0}, -1.0, value}, {}}}}});
  }
  return cloud;
}

} // namespace

TEST_CASE("points that are kept keep all their attributes, their order and their numbers in the file") {
  PointCloud cloud = numbered(9);
  REQUIRE(keep_points(cloud, [](std::size_t i) { return i % 3 == 1; }) == 6);
  REQUIRE(cloud.record == std::vector<std::uint32_t>{1, 4, 7});
  // Once more: the numbers are those of the file, not of what the first removal left.
  REQUIRE(keep_points(cloud, [](std::size_t i) { return i != 1; }) == 1);
  const std::vector<std::uint32_t> left{1, 7};
  CHECK(cloud.record == left);
  REQUIRE(cloud.size() == 2);
  REQUIRE(cloud.clipped.size() == 2);
  for (std::uint32_t k = 0; k < 2; ++k) {
    CHECK(cloud.clipped[k].point == k);
    CHECK(cloud.clipped[k].clip.strip[0].high == left[k]);
  }
  for (std::size_t k = 0; k < left.size(); ++k) {
    const std::uint32_t i = left[k];
    const auto value = static_cast<float>(i);
    CHECK(cloud.position[k].x() == i);
    CHECK(cloud.normal[k].x() == value);
    CHECK(cloud.colour[k].x() == value);
    CHECK(cloud.radius[k] == value);
    CHECK(cloud.area[k] == value);
    CHECK(cloud.structure[k] == Structure::line);
    CHECK(cloud.station[k] == i);
    CHECK(cloud.fields[0].values[k] == i);
  }
  CHECK(cloud.fields[0].values.size() == 2);
}

TEST_CASE("a cloud that loses nothing keeps no numbers; triangles go with their corners") {
  PointCloud cloud = numbered(5);
  cloud.triangle = {{0, 1, 2}, {2, 3, 4}, {1, 2, 9}};
  REQUIRE(keep_points(cloud, [](std::size_t) { return true; }) == 0);
  CHECK(cloud.record.empty());
  CHECK(cloud.triangle.size() == 2); // one named a point that does not exist
  keep_points(cloud, [](std::size_t i) { return i != 0; });
  REQUIRE(cloud.triangle.size() == 1);
  CHECK(cloud.triangle[0] == std::array<std::uint32_t, 3>{1, 2, 3});
}
