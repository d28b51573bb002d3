#include "tests/unit/host/scene/scene_files.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using pointgi::test::SceneFolder;
using pointgi::test::small_scene;

TEST_CASE("overrides set keys that are there and keys that are not", "[scene]") {
  const SceneFolder folder;
  const Scene scene =
      folder.load(small_scene, {"render.spp=64", "render.size=[10, 20]", "camera.position=[0,3,1]",
                                " camera . look_at = [0, 1, 0] ", "environment.radiance=[1,1,1]", "up=\"z\""});
  CHECK(scene.render.spp == 64);
  CHECK(scene.render.width == 10);
  CHECK(scene.render.height == 20);
  CHECK(scene.camera.position == Vector3d(0, 3, 1));
  CHECK(scene.camera.look_at == Vector3d(0, 1, 0));
  CHECK(scene.environment == Vector3d(1, 1, 1));
  CHECK(scene.up == UpAxis::z);
}

TEST_CASE("overrides find elements by name and by index", "[scene]") {
  const SceneFolder folder;
  const std::string text = std::string(small_scene) + "[[material]]\nname = \"old.glass\"\ntype = \"glass\"\n";
  const Scene scene = folder.load(text, {"material.white.albedo=[0.1, 0.2, 0.3]", "material.\"old.glass\".ior=1.3",
                                         "light.0.power_w=[4, 5, 6]", "light.0.position.1=7", "shape.0.spacing=0.5"});
  CHECK(scene.materials[0].albedo.value() == Vector3d(0.1, 0.2, 0.3));
  CHECK(scene.materials[1].ior == 1.3);
  CHECK(scene.lights[0].strength == Vector3d(4, 5, 6) / (4.0 * 3.14159265358979323846));
  CHECK(scene.lights[0].vector == Vector3d(0, 7, 0));
  CHECK(scene.shapes[0].spacing == 0.5);
}

TEST_CASE("overrides take a word without quotes as a text", "[scene]") {
  const SceneFolder folder;
  CHECK(folder.load(small_scene, {"radiosity.method=direct"}).radiosity.method == "direct");
  CHECK(folder.load(small_scene, {"radiosity.method='direct'"}).radiosity.method == "direct");
  CHECK(folder.load(small_scene, {"material.white.name=a=b", "shape.0.material=a=b"}).materials[0].name == "a=b");
}

TEST_CASE("of two overrides the later one wins", "[scene]") {
  CHECK(SceneFolder().load(small_scene, {"render.spp=2", "render.spp=3"}).render.spp == 3);
  CHECK(SceneFolder().load(small_scene, {"render.spp=2", "render={spp = 4}"}).render.spp == 4);
}

TEST_CASE("overrides replace whole tables and elements", "[scene]") {
  const SceneFolder folder;
  const Scene scene =
      folder.load(small_scene,
                  {"light=[{type = \"directional\", direction = [0, -1, 0], irradiance = [1, 1, 1]}]",
                   "shape.0={type = \"sphere\", centre = [0, 0, 0], radius = 1, spacing = 0.1, material = \"white\"}"});
  CHECK(scene.lights.at(0).type == LightType::directional);
  CHECK(std::get<SphereShape>(scene.shapes.at(0).geometry).radius == 1);
}

TEST_CASE("wrong overrides are reported under their own text", "[scene]") {
  const SceneFolder folder;
  const auto error = [&](const std::string& set) { return folder.error(small_scene, {set}); };
  CHECK(error("render.spp=many") ==
        "--set render.spp=many: render.spp: expected an integer from 1 to 65536, found \"many\"");
  CHECK(error("render.ssp=4") == "--set render.ssp=4: render.ssp: unknown key; did you mean \"spp\"?");
  CHECK(error("rendr.spp=4") == "--set rendr.spp=4: rendr: unknown key; did you mean \"render\"?");
  CHECK(error("camera.look_at=[0, 0, 0]") ==
        "--set camera.look_at=[0, 0, 0]: camera.position: missing, expected three numbers from -1e18 to 1e18");
  CHECK(error("material.white.albedo=[1.2, 0, 0]") ==
        "--set material.white.albedo=[1.2, 0, 0]: material.white.albedo: expected three numbers from 0 to 1 (above 1 "
        "it would create energy), found [1.2, 0, 0]");
  CHECK(error("material.whit.albedo=1") == "--set material.whit.albedo=1: material has no element \"whit\": expected "
                                           "an index from 0 to 0 or a name; did you mean \"white\"?");
  CHECK(error("light.1.power_w=[1,1,1]") ==
        "--set light.1.power_w=[1,1,1]: light has no element \"1\": expected an index from 0 to 0");
  CHECK(error("version.x=1") == "--set version.x=1: version is 1 and holds no key \"x\"");
  CHECK(error("version.x.y=1") == "--set version.x.y=1: version is 1 and holds no key \"x\"");
}

TEST_CASE("overrides that cannot be read are mistakes of the command line", "[scene]") {
  const SceneFolder folder;
  const std::string deep(100000, '[');
  for (const std::string& set :
       {std::string("render.spp"), std::string(""), std::string("=3"), std::string("render..spp=3"),
        std::string("render.spp="), std::string("render.size=[1, 2"), std::string("render.spp=1\nrender.seed=2"),
        std::string("material.\"white=1"), std::string(200, '.') + "=1"}) {
    INFO(set);
    try {
      folder.load(small_scene, {set});
      FAIL("loaded");
    } catch (const Error& error) {
      CHECK(error.kind() == ErrorKind::usage);
      CHECK_THAT(error.what(), Catch::StartsWith("--set " + set.substr(0, 20)));
    }
  }
  CHECK_THAT(folder.error(small_scene, {"render.spp=" + deep}), Catch::Contains("nest deeper than 32"));
  CHECK_THAT(folder.error(small_scene, {"render.spp={a." + std::string(80, '.') + "b = 1}"}),
             Catch::Contains("nest deeper than 32"));
}
