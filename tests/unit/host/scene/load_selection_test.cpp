#include "host/error.h"
#include "host/scene/splats.h"
#include "tests/unit/host/scene/scene_files.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;
using Catch::Contains;

namespace {

/// A scene around a ply of four points with a class each, the [[cloud]] having these lines besides.
std::string scene_with(const SceneFolder& folder, const std::string& lines) {
  folder.write("four.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\n"
                           "property double z\nproperty uchar Classification\nend_header\n"
                           "0 0 0 2\n1 0 0 2\n1 1 0 6\n0 1 0 7\n");
  return "version = 1\n[[material]]\nname = \"stone\"\ntype = \"diffuse\"\n[[cloud]]\nfile = \"four.ply\"\n"
         "material = \"stone\"\n" +
         lines + "\n";
}

} // namespace

TEST_CASE("keep, crop, clip and voxel arrive", "[scene]") {
  const SceneFolder folder;
  const Scene scene = folder.load(scene_with(folder, R"(
keep = { classification = [2, 6], return_number = 1, intensity = { min = 10, max = 20.5 }, z = { max = 3 } }
crop = { min = [0, -1, -2], max = [1, 2, 3] }
clip = [{ point = [0, 0, 5], normal = [0, 0, -2] }, { point = [1, 1, 1], normal = [1, 0, 0] }]
voxel = 0.25)"));
  const Selection& s = scene.clouds[0].selection;
  REQUIRE(s.keep.size() == 4);
  CHECK(s.keep[0].field == "classification");
  CHECK(s.keep[0].values == std::vector<double>{2, 6});
  CHECK(s.keep[1].field == "intensity");
  CHECK(s.keep[1].values.empty());
  CHECK(s.keep[1].min == 10.0);
  CHECK(s.keep[1].max == 20.5);
  CHECK(s.keep[2].values == std::vector<double>{1});
  CHECK(s.keep[3].min == -std::numeric_limits<double>::infinity());
  CHECK(s.keep[3].max == 3.0);
  REQUIRE(s.crop);
  CHECK(s.crop->min == Vector3d(0, -1, -2));
  CHECK(s.crop->max == Vector3d(1, 2, 3));
  REQUIRE(s.clip.size() == 2);
  CHECK(s.clip[0].normal == Vector3d(0, 0, -2));
  CHECK(s.clip[1].point == Vector3d(1, 1, 1));
  CHECK(s.voxel == 0.25);
  CHECK(folder.load(scene_with(folder, "")).clouds[0].selection.empty());
}

TEST_CASE("mistakes in a selection are refused with their place", "[scene]") {
  const SceneFolder folder;
  const auto error = [&](const std::string& line) { return folder.error(scene_with(folder, line)); };
  CHECK_THAT(error("keep = 2"), Contains("scene.toml:8:8: cloud.0.keep: expected a table"));
  CHECK_THAT(error("keep = { class = \"ground\" }"), Contains("cloud.0.keep.class: expected a number, a list"));
  CHECK_THAT(error("keep = { class = [] }"), Contains("one number or more"));
  CHECK_THAT(error("keep = { class = [2, \"b\"] }"), Contains("one number or more"));
  CHECK_THAT(error("keep = { class = { min = 3, max = 2 } }"), Contains("cloud.0.keep.class.min: is above max"));
  CHECK_THAT(error("keep = { class = { low = 3 } }"), Contains("low: unknown key"));
  CHECK_THAT(error("keep = { class = {} }"), Contains("expected min, max or both"));
  CHECK_THAT(error("crop = [0, 1]"), Contains("cloud.0.crop: expected a table"));
  CHECK_THAT(error("crop = { min = [0, 0, 1], max = [1, 1, 0] }"), Contains("the box has no inside"));
  CHECK_THAT(error("clip = { point = [0, 0, 0], normal = [0, 0, 1] }"), Contains("expected a list of planes"));
  CHECK_THAT(error("clip = [{ point = [0, 0, 0] }]"), Contains("cloud.0.clip.0.normal: missing"));
  CHECK_THAT(error("clip = [{ point = [0, 0, 0], normal = [0, 0, 0] }]"), Contains("has no length"));
  CHECK_THAT(error("voxel = 0"), Contains("cloud.0.voxel: expected a number > 0"));
}

TEST_CASE("a cloud is selected from before anything is estimated from it", "[scene]") {
  const SceneFolder folder;
  CloudReport report;
  const Scene scene = folder.load(scene_with(folder, "keep = { class = [2, 6] }"));
  const PointCloud cloud = load_cloud(scene.clouds[0], scene, report);
  CHECK(cloud.record == std::vector<std::uint32_t>{0, 1, 2});
  CHECK(cloud.radius.size() == 3);
  CHECK(report.points_in_file == 4);
  CHECK(report.points_left_out == 1);
  CHECK(report.points_dropped == 0);
  const Scene none = folder.load(scene_with(folder, "keep = { class = 9 }"));
  try {
    CloudReport ignored;
    load_cloud(none.clouds[0], none, ignored);
    FAIL("nothing was left");
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::input);
    CHECK_THAT(error.what(), Contains("four.ply: keep.class leaves none of 4 points, which have class from 2 to 7"));
  }
}
