#include "host/api/parts.h"
#include "host/error.h"
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;
using Catch::Contains;

namespace {

const char* const text = "version = 1\nup = \"z\"\n"
                         "[render]\nsize = [40, 30]\nexposure = 0.5\n"
                         "[camera]\nposition = [0, -3, 1]\nlook_at = [0, 0, 0.25]\nfov_deg = 30\n"
                         "[[material]]\nname = \"white\"\ntype = \"diffuse\"\nalbedo = [0.7, 0.6, 0.5]\n"
                         "[[shape]]\ntype = \"sphere\"\ncentre = [0, 0, 0]\nradius = 1\nspacing = 0.1\ninward = true\n"
                         "material = \"white\"\n"
                         "[[light]]\ntype = \"point\"\nposition = [0, 0, 0.5]\npower_w = [4, 5, 6]\n";

api::Scene built() {
  api::Scene scene;
  scene.set("up=z");
  scene.set("render", {{"size", {40, 30}}, {"exposure", 0.5}});
  scene.set("camera", {{"position", {0, -3, 1}}, {"look_at", {0, 0, 0.25}}, {"fov_deg", 30}});
  scene.add("material", {{"name", "white"}, {"type", "diffuse"}, {"albedo", {0.7, 0.6, 0.5}}});
  scene.add("shape", {{"type", "sphere"},
                      {"centre", {0, 0, 0}},
                      {"radius", 1.0},
                      {"spacing", 0.1},
                      {"inward", true},
                      {"material", "white"}});
  scene.add("light", {{"type", "point"}, {"position", {0, 0, 0.5}}, {"power_w", {4, 5, 6}}});
  return scene;
}

void check_same(const Scene& a, const Scene& b) {
  CHECK(a.up == b.up);
  CHECK(a.render.width == b.render.width);
  CHECK(a.render.height == b.render.height);
  CHECK(a.render.spp == b.render.spp);
  CHECK(a.render.exposure == b.render.exposure);
  CHECK(a.camera.position == b.camera.position);
  CHECK(a.camera.look_at == b.camera.look_at);
  CHECK(a.camera.fov_deg == b.camera.fov_deg);
  REQUIRE(a.materials.size() == b.materials.size());
  CHECK(a.materials[0].albedo == b.materials[0].albedo);
  REQUIRE(a.shapes.size() == b.shapes.size());
  const auto &x = std::get<SphereShape>(a.shapes[0].geometry), &y = std::get<SphereShape>(b.shapes[0].geometry);
  CHECK(x.radius == y.radius);
  CHECK(x.inward == y.inward);
  CHECK(a.shapes[0].spacing == b.shapes[0].spacing);
  REQUIRE(a.lights.size() == b.lights.size());
  CHECK(a.lights[0].strength == b.lights[0].strength);
}

} // namespace

TEST_CASE("a scene is the same from a file, from a text and from code", "[api]") {
  const TemporaryFolder folder;
  const Scene file = api::Scene::from_file(folder.write("scene.toml", text)).parts()->description();
  check_same(file, api::Scene::from_text(text).parts()->description());
  check_same(file, built().parts()->description());
}

TEST_CASE("a scene built in code is checked as a file is", "[api]") {
  api::Scene scene = built();
  scene.set("material.white.albdo=[1, 1, 1]");
  CHECK_THROWS_WITH(scene.check(), Contains("material.white.albdo") && Contains("did you mean \"albedo\"?"));
  scene = built();
  scene.add("light", {{"type", "point"}, {"position", {0, 0, 0}}, {"power_w", "bright"}});
  CHECK_THROWS_WITH(scene.check(), Contains("light.1.power_w: expected") && Contains("\"bright\""));
  CHECK_THROWS_WITH(api::Scene().check(), Contains("the scene is empty"));
  CHECK_THROWS_WITH(api::Scene::from_text("version = 1\n[camera"), Contains("scene:2:") && Contains("not valid TOML"));
  CHECK_THROWS_WITH(built().set("camera.fov_deg"), Contains("="));
  CHECK_THROWS_WITH(built().set_quality("best"), Contains("\"high\"") && Contains("\"best\""));
  CHECK_THROWS_WITH(built().add("camera", {{"fov_deg", 30}}), Contains("camera") && Contains("use set"));
  CHECK_THROWS_WITH(built().set("light", {{"type", "point"}}), Contains("light") && Contains("use add"));
}

TEST_CASE("a copy of a scene keeps what it was", "[api]") {
  const api::Scene first = built();
  api::Scene second = first;
  second.set("camera.fov_deg=50");
  second.set_quality("draft");
  CHECK(first.parts()->description().camera.fov_deg == 30.0);
  CHECK(first.parts()->description().render.spp == 32);
  CHECK(second.parts()->description().camera.fov_deg == 50.0);
  CHECK(second.parts()->description().render.spp == 8);
}

TEST_CASE("a cloud of arrays is placed and completed as one of a file", "[api]") {
  const std::vector<double> positions{1e6, 0, 0, 1e6 + 0.125, 0, 0, 1e6, 0.125, 0, 1e6 + 0.125, 0.125, 0};
  const std::vector<float> normals{0, 0, 2, 0, 0, 2, 0, 0, 2, 0, 0, 2}, colours(12, 0.5f), radii{1, 2, 3, 4};
  api::Scene scene = built();
  scene.add({4, positions.data(), normals.data(), colours.data(), radii.data()},
            {{"material", "white"}, {"scale", 2}, {"translate", {-2e6, 0, 0}}});
  const Scene description = scene.parts()->description();
  const WorldSplats splats = load_splats(description);
  REQUIRE(splats.first == std::vector<std::uint32_t>{0, 4});
  CHECK(splats.cloud.position[1] == Vector3d(0.25, 0, 0));
  CHECK(splats.cloud.normal[3] == Eigen::Vector3f(0, 0, 1));
  CHECK(splats.cloud.radius[2] == 6.0f);
  CHECK(splats.reports[0].normals_from == "file");
  CHECK_THROWS_WITH(scene.add(api::Points{}, {{"material", "white"}}), Contains("without points"));
  scene.add({4, positions.data()}, {{"material", "wite"}});
  CHECK_THROWS_WITH(scene.check(), Contains("cloud.1.material") && Contains("did you mean \"white\"?"));
}
