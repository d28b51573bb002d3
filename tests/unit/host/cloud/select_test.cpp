#include "host/cloud/select.h"
#include "host/cloud/voxel_grid.h"
#include "host/error.h"
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <random>

using namespace pointgi;
using Catch::Contains;
using Eigen::Vector3d;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Points (i, 0, 0) of classes 0 1 2 0 1 2 … and intensities 10 i.
PointCloud classed(std::size_t count) {
  PointCloud cloud;
  cloud.fields = {{{"Classification", FieldType::u8}, {}}, {{"scalar_Intensity", FieldType::u16}, {}}};
  for (std::size_t i = 0; i < count; ++i) {
    cloud.position.emplace_back(i, 0, 0);
    cloud.fields[0].values.push_back(static_cast<double>(i % 3));
    cloud.fields[1].values.push_back(10.0 * static_cast<double>(i));
  }
  return cloud;
}

std::vector<double> xs(const PointCloud& cloud) {
  std::vector<double> values;
  for (const Vector3d& p : cloud.position)
    values.push_back(p.x());
  return values;
}

std::vector<double> selected(PointCloud cloud, const Selection& selection) {
  CloudReport report;
  select_points(cloud, selection, report);
  return xs(cloud);
}

std::string refusal(PointCloud cloud, const Selection& selection) {
  CloudReport report;
  report.fields = {"x", "Classification"};
  try {
    select_points(cloud, selection, report);
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::input);
    return error.what();
  }
  return "";
}

} // namespace

TEST_CASE("keep: values and ranges of fields, whatever the case of their names") {
  Selection selection;
  selection.keep = {{"classification", {0, 2}}};
  CHECK(selected(classed(6), selection) == std::vector<double>{0, 2, 3, 5});
  selection.keep = {{"CLASS", {1}}};
  CHECK(selected(classed(6), selection) == std::vector<double>{1, 4});
  selection.keep = {{"classification", {0, 2}}, {"intensity", {}, 20, 30}}; // all must hold; ends belong to the range
  CHECK(selected(classed(6), selection) == std::vector<double>{2, 3});
  selection.keep = {{"x", {}, 4}};
  CHECK(selected(classed(6), selection) == std::vector<double>{4, 5});
}

TEST_CASE("keep: what is no number is in no range") {
  PointCloud cloud = classed(4);
  cloud.fields[1].values[2] = not_a_number;
  Selection selection;
  selection.keep = {{"intensity", {}}}; // from minus infinity to infinity
  CHECK(selected(cloud, selection) == std::vector<double>{0, 1, 3});
}

TEST_CASE("keep: a cloud in memory is asked for what it has") {
  PointCloud cloud;
  for (int i = 0; i < 4; ++i) {
    cloud.position.emplace_back(i, 0, 0);
    cloud.normal.emplace_back(0.0f, 0.0f, i < 2 ? 1.0f : -1.0f);
    cloud.colour.emplace_back(0.25f * static_cast<float>(i), 0.0f, 0.0f);
  }
  Selection selection;
  selection.keep = {{"nz", {}, 0.0}, {"red", {}, 0.25}};
  CHECK(selected(cloud, selection) == std::vector<double>{1});
  selection.keep = {{"radius", {}, 0.0}};
  CHECK_THAT(refusal(cloud, selection), Contains("no field \"radius\""));
}

TEST_CASE("crop and clip: a box with its faces, and sides of planes") {
  Selection selection;
  selection.crop = CropBox{};
  selection.crop->min.x() = 1;
  selection.crop->max = {4, 0, 0};
  CHECK(selected(classed(7), selection) == std::vector<double>{1, 2, 3, 4});
  selection.clip = {{{2, 5, 5}, {3, 0, 0}}, {{3, 0, 0}, {-0.1, 0, 0}}};
  CHECK(selected(classed(7), selection) == std::vector<double>{2, 3});
  PointCloud cloud = classed(7);
  cloud.position[2].y() = not_a_number;
  CHECK(selected(cloud, selection) == std::vector<double>{3}); // in no box
}

TEST_CASE("voxel: one point a cube, the nearest to its middle, the same for any order but of equals the first") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-3.0, 3.0);
  std::vector<Vector3d> points;
  for (int i = 0; i < 20000; ++i)
    points.emplace_back(place(random), place(random), place(random));
  for (int i = 0; i < 500; ++i)
    points.push_back(points[static_cast<std::size_t>(i)]); // equals of earlier ones
  constexpr double edge = 0.25;
  using Cube = std::array<long, 3>;
  const auto cube = [&](const Vector3d& p) {
    return Cube{std::lround(std::floor(p.x() / edge)), std::lround(std::floor(p.y() / edge)),
                std::lround(std::floor(p.z() / edge))};
  };
  std::map<Cube, std::size_t> expected;
  const auto distance = [&](std::size_t i) {
    const Cube c = cube(points[i]);
    const Vector3d middle =
        edge * (Vector3d(static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2])) +
                Vector3d::Constant(0.5));
    return (points[i] - middle).norm();
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto [at, is_new] = expected.insert({cube(points[i]), i});
    if (!is_new && distance(i) < distance(at->second)) at->second = i;
  }
  const std::vector<bool> chosen = one_point_a_voxel(points, edge);
  CHECK(static_cast<std::size_t>(std::count(chosen.begin(), chosen.end(), true)) == expected.size());
  for (const auto& [where, point] : expected)
    CHECK(chosen[point]);
}

TEST_CASE("voxel: places that are not finite, of any size, or all in one cube") {
  const std::vector<Vector3d> odd{{not_a_number, 0, 0},
                                  {0, std::numeric_limits<double>::infinity(), 0},
                                  {1e18, -1e18, 1e18},
                                  {-0.0, 0, 0},
                                  {0.0, 0, 0}};
  // -0 and 0 are one place, hence one cube.
  CHECK(one_point_a_voxel(odd, 1e-18) == std::vector<bool>{false, false, true, true, false});
  const std::vector<Vector3d> one_place(100000, Vector3d(1, 2, 3));
  const std::vector<bool> chosen = one_point_a_voxel(one_place, 0.5);
  CHECK(chosen[0]);
  CHECK(std::count(chosen.begin(), chosen.end(), true) == 1);
  CHECK(one_point_a_voxel({}, 1.0).empty());
}

TEST_CASE("a selection counts what each filter took, and remembers which points of the file are left") {
  PointCloud cloud = classed(10);
  cloud.triangle = {{2, 5, 8}, {0, 2, 5}};
  Selection selection;
  selection.keep = {{"classification", {2}}};
  selection.crop = CropBox{};
  selection.crop->max.x() = 5;
  selection.voxel = 100.0;
  CloudReport report;
  select_points(cloud, selection, report);
  CHECK(cloud.record == std::vector<std::uint32_t>{5}); // 5 is nearer to (50, 50, 50) than 2 is
  CHECK(report.points_left_out == 9);
  REQUIRE(report.notes.size() == 1);
  CHECK(report.notes[0] == "1 of 10 points are kept: keep.classification took 7, crop took 1, voxel took 1");
  CHECK(cloud.triangle.empty());
}

TEST_CASE("a selection that leaves nothing, or asks for what is not there, says what there is") {
  Selection selection;
  selection.keep = {{"classification", {0, 1, 2}}, {"intensity", {7}}};
  CHECK_THAT(refusal(classed(4), selection),
             Contains("keep.intensity leaves none of 4 points") && Contains("intensity from 0 to 30"));
  selection = {};
  selection.crop = CropBox{};
  selection.crop->min.x() = 100;
  CHECK_THAT(refusal(classed(4), selection), Contains("crop leaves none of 4 points") && Contains("x from 0 to 3"));
  selection = {};
  selection.clip = {{{0, 0, 0}, {1, 0, 0}}, {{-1, 0, 0}, {-1, 0, 0}}};
  CHECK_THAT(refusal(classed(4), selection), Contains("clip.1 leaves none"));
  selection = {};
  selection.keep = {{"returns", {1}}};
  CHECK_THAT(refusal(classed(4), selection), Contains("no field \"returns\"; it has x, Classification"));
}

TEST_CASE("fields that a reader must keep: every name that means the same, and no coordinates") {
  Selection selection;
  selection.keep = {{"class", {1}}, {"X", {1}}, {"intensity", {1}}};
  CHECK(fields_of(selection) == std::vector<std::string>{"class", "classification", "intensity"});
}
