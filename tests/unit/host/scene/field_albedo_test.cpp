/// Albedos from other numbers of a file than its colours.
#include "host/image/srgb.h"
#include "host/scene/field_albedo.h"
#include "host/scene/splats.h"
#include "tests/unit/host/scene/scene_files.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;
using Catch::Contains;

namespace {

/// A level grid of 20 x 20 points; `values` makes the last words of each line from its number.
template <class Values>
std::string grid_ply(const std::string& properties, const Values& values) {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 400\nproperty float x\nproperty float y\nproperty float z\n" + properties +
      "end_header\n";
  for (int i = 0; i < 400; ++i)
    text += std::to_string(i % 20) + " 0 " + std::to_string(i / 20) + " " + values(i) + "\n";
  return text;
}

std::string scene_with(const std::string& material) {
  return "version = 1\n[[material]]\nname = \"stone\"\ntype = \"diffuse\"\n" + material +
         "\n[[cloud]]\nfile = \"cloud.ply\"\nmaterial = \"stone\"\n[[light]]\ntype = \"point\"\nposition = [0, 9, "
         "0]\npower_w = [1, 1, 1]\n";
}

const std::string intensity = "property ushort scalar_Intensity\n";

std::string hundreds(int i) {
  return std::to_string(100 * i);
}

WorldSplats splats_of(const SceneFolder& folder, const std::string& material) {
  return load_splats(folder.load(scene_with(material)));
}

const float rounding = 1e-5f; // of the curve of sRGB in float

} // namespace

TEST_CASE("field albedo: a field between low and high, in the space of the material's colours", "[fields]") {
  const SceneFolder folder;
  folder.write("cloud.ply", grid_ply(intensity, hundreds));
  const WorldSplats linear =
      splats_of(folder, "colour_space = \"linear\"\nalbedo = { field = \"intensity\", low = 1000, high = 2000.0 }");
  CHECK(linear.cloud.colour[5] == Eigen::Vector3f::Zero()); // 500, below low
  CHECK((linear.cloud.colour[15] - Eigen::Vector3f::Constant(0.5f)).norm() < rounding);
  CHECK(linear.cloud.colour[399] == Eigen::Vector3f::Ones());
  REQUIRE(linear.reports[0].notes.size() == 1);
  CHECK_THAT(linear.reports[0].notes[0], Contains("scalar_Intensity (1000 is black, 2000 is white)"));
  const WorldSplats encoded = splats_of(folder, "albedo = { field = \"Intensity\", low = 1000, high = 2000 }");
  CHECK((encoded.cloud.colour[15] - Eigen::Vector3f::Constant(srgb_to_linear(0.5f))).norm() < rounding);
  CHECK(encoded.cloud.fields.empty());
}

TEST_CASE("field albedo: without low and high the range is that of nearly all values", "[fields]") {
  const SceneFolder folder;
  folder.write("cloud.ply", grid_ply("property float depth\n", [](int i) {
                 return i == 7 ? std::string("1e30") : i == 9 ? "nan" : std::to_string(i);
               }));
  const WorldSplats splats = splats_of(folder, "colour_space = \"linear\"\nalbedo = { field = \"depth\" }");
  // 399 values, nearly 0 to 399: 1 % of them lie below 4 or 5 and above 395.
  CHECK(splats.cloud.colour[200].x() == Approx(0.5).margin(0.01));
  CHECK(splats.cloud.colour[7].x() == 1.0f);
  CHECK(splats.cloud.colour[9].x() == 0.5f);
  CHECK(splats.cloud.colour[0].x() == 0.0f);
  // One value has no contrast: middle grey.
  folder.write("cloud.ply", grid_ply("property float depth\n", [](int) { return "3"; }));
  CHECK(splats_of(folder, "colour_space = \"linear\"\nalbedo = { field = \"depth\" }").cloud.colour[0].x() == 0.5f);
}

TEST_CASE("field albedo: three fields are red, green and blue in one range", "[fields]") {
  const SceneFolder folder;
  folder.write("cloud.ply",
               grid_ply("property float a\nproperty float b\nproperty float c\n", [](int) { return "10 20 15"; }));
  const WorldSplats splats =
      splats_of(folder, "colour_space = \"linear\"\nalbedo = { fields = [\"a\", \"b\", \"c\"], low = 10, high = 20 }");
  CHECK((splats.cloud.colour[0] - Eigen::Vector3f(0, 1, 0.5f)).norm() < rounding);
}

TEST_CASE("field albedo: intensity stands in where a file has no colours", "[fields]") {
  const SceneFolder folder;
  folder.write("cloud.ply", grid_ply(intensity, hundreds));
  const WorldSplats grey = splats_of(folder, "");
  CHECK(grey.cloud.colour[0].x() == Approx(srgb_to_linear(0.3f / 1.3f)).margin(0.01));   // as black as asphalt
  CHECK(grey.cloud.colour[200].x() == Approx(srgb_to_linear(0.8f / 1.3f)).margin(0.01)); // 1 % of contrast
  CHECK(grey.cloud.colour[399].x() == 1.0f);
  REQUIRE(grey.reports[0].notes.size() == 1);
  CHECK_THAT(grey.reports[0].notes[0],
             Contains("the file has no colours: they are grey by its field scalar_Intensity"));
  // Half of the points are middle grey or lighter, however bright a few are; one value for all tells nothing.
  folder.write("cloud.ply", grid_ply(intensity, [](int i) { return std::to_string(i < 360 ? i : 2000); }));
  CHECK(splats_of(folder, "").cloud.colour[200].x() == Approx(srgb_to_linear(0.8f / 1.3f)).margin(0.01));
  folder.write("cloud.ply", grid_ply(intensity, [](int) { return "0"; }));
  CHECK(splats_of(folder, "").reports[0].notes.empty());
  folder.write("cloud.ply", grid_ply(intensity, hundreds));
  // A material that says its albedo, and a file that has colours, want none.
  CHECK(splats_of(folder, "albedo = [0.5, 0.5, 0.5]").cloud.colour[0].x() == 0.5f);
  folder.write("cloud.ply", grid_ply(intensity + "property uchar red\nproperty uchar green\nproperty uchar blue\n",
                                     [](int i) { return hundreds(i) + " 255 255 255"; }));
  CHECK(splats_of(folder, "").cloud.colour[0].x() == 1.0f);
}

TEST_CASE("field albedo: points that are dropped take their values with them", "[fields]") {
  const SceneFolder folder;
  std::string text = grid_ply(intensity, hundreds);
  text.replace(text.find("\n5 0 0 500"), 3, "\nnan ");
  folder.write("cloud.ply", text);
  const WorldSplats splats =
      splats_of(folder, "colour_space = \"linear\"\nalbedo = { field = \"intensity\", low = 0, high = 1000 }");
  REQUIRE(splats.cloud.size() == 399);
  CHECK(splats.cloud.colour[4].x() == Approx(0.4));
  CHECK(splats.cloud.colour[5].x() == Approx(0.6));
}

TEST_CASE("field albedo: what is wrong is named", "[fields]") {
  const SceneFolder folder;
  folder.write("cloud.ply", grid_ply(intensity, hundreds));
  CHECK_THROWS_WITH(splats_of(folder, "albedo = { field = \"height\" }"),
                    Contains("has no field \"height\"") && Contains("material \"stone\"") &&
                        Contains("its fields are x, y, z, scalar_Intensity"));
  CHECK_THAT(folder.error(scene_with("albedo = \"intensity\"")),
             Contains("scene.toml:5") && Contains("{ field = \"intensity\" }"));
  CHECK_THAT(folder.error(scene_with("albedo = { low = 1 }")), Contains("material.stone.albedo.field"));
  CHECK_THAT(folder.error(scene_with("albedo = { field = \"a\", hight = 1 }")), Contains("hight") && Contains("high"));
  CHECK_THAT(folder.error(scene_with("albedo = { field = \"a\", low = 2, high = 2 }")), Contains("above low"));
  CHECK_THAT(folder.error(scene_with("albedo = { fields = [\"a\", \"b\"] }")), Contains("3 texts"));
  CHECK_THAT(folder.error(scene_with("albedo = { field = \"a\", fields = [\"a\", \"b\", \"c\"] }")),
             Contains("remove one of the two"));
  const std::string shape = "[[shape]]\ntype = \"sphere\"\ncentre = [0, 0, 0]\nradius = 1\nspacing = 0.5\nmaterial = "
                            "\"stone\"\n";
  CHECK_THROWS_WITH(load_splats(folder.load(scene_with("albedo = { field = \"intensity\" }") + shape)),
                    Contains("shapes have none"));
}
