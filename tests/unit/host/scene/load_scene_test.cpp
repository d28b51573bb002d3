#include "host/scene/limits.h"
#include "host/scene/load_scene.h"
#include "tests/support/promises.h"
#include "tests/unit/host/scene/scene_files.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using pointgi::test::SceneFolder;
using pointgi::test::small_scene;

namespace {

/// Every key of every section, each with another value than its default.
const char* const full_scene = R"(version = 1
up = "z"
[render]
size = [320, 200]
spp = 64
seed = 4294967295
exposure = -1.5
max_depth = 12
jitter = false
[camera]
position = [1, 2.5, 3e0]
look_at = [0, 0, 0]
fov_deg = 55
[[material]]
name = "points"
type = "diffuse"
colour_space = "linear"
emission = [0, 0.5, 1]
[[material]]
name = "mirror"
type = "mirror"
reflectance = [0.9, 0.8, 0.7]
[[material]]
name = "glass"
type = "glass"
ior = 1.33
absorption = [0.1, 0.2, 0.3]
[[material]]
name = "gloss"
type = "phong"
albedo = [0.7, 0.7, 0.7]
specular = [0.3, 0.2, 0.1]
exponent = 40
[[cloud]]
file = "sub/points.ply"
material = "points"
scale = 10
rotate_deg = [90, 0, -45]
translate = [1, 2, 3]
radius = 0.01
normals = "flip"
viewpoint = [0, 0, 5]
spacing = 0.02
[[cloud]]
file = "sub/points.ply"
material = "glass"
radius = "file"
normals = "estimate"
[[shape]]
type = "quad"
corner = [-1, 0, -1]
edge_u = [0, 0, 2]
edge_v = [2, 0, 0]
spacing = 0.02
material = "gloss"
[[shape]]
type = "sphere"
centre = [0, 1, 0]
radius = 0.5
inward = true
spacing = 0.05
material = "mirror"
[[shape]]
type = "box"
min = [-1, -1, -1]
max = [1, 2, 3]
inward = true
spacing = 0.1
material = "gloss"
[[shape]]
type = "disc"
centre = [0, 2, 0]
normal = [0, -2, 0]
radius = 0.25
spacing = 0.01
material = "gloss"
[[shape]]
type = "cylinder"
base = [0, 0, 0]
top = [0, 0, 2]
radius = 0.75
inward = true
spacing = 0.1
material = "gloss"
[[light]]
type = "point"
position = [0, 1.9, 0]
power_w = [40, 30, 20]
[[light]]
type = "directional"
direction = [0, -3, 4]
irradiance = [1, 2, 3]
[environment]
radiance = [0.1, 0.2, 0.3]
[radiosity]
method = "direct"
order = 4
vmap_samples = 16
vmap_rays = 123456789012
epsilon = 2e-2
tolerance = 1e-4
vmap = "thesis"
direct_light = "radiosity"
[caustics]
photons = 100000000
gather_k = 80
power = "equal"
feedback = true
indirect = true
[octree]
branching = 4
order = "hilbert"
leaf_capacity = 12
max_depth = 9
[traversal]
form = "wide"
grouping = "packet"
group = "16x4"
lanes = 16
storage = "image2d"
stepping = "absolute_delta"
step_delta = 0.25
fast_math = true
)";

std::string with_line(std::string text, const std::string& section, const std::string& line) {
  const auto at = text.find(section);
  REQUIRE(at != std::string::npos);
  return text.insert(at + section.size(), "\n" + line);
}

} // namespace

TEST_CASE("every key of the settings arrives", "[scene]") {
  const SceneFolder folder;
  std::filesystem::create_directory(folder.file("sub"));
  folder.write("sub/points.ply", "ply\n");
  const Scene scene = folder.load(full_scene);
  CHECK(scene.file == folder.file("scene.toml"));
  CHECK(scene.warnings.empty());
  CHECK(scene.up == UpAxis::z);
  CHECK(scene.render.width == 320);
  CHECK(scene.render.height == 200);
  CHECK(scene.render.spp == 64);
  CHECK(scene.render.seed == 4294967295u);
  CHECK(scene.render.exposure == -1.5);
  CHECK(scene.render.max_depth == 12);
  CHECK_FALSE(scene.render.jitter);
  CHECK(scene.camera.position == Vector3d(1, 2.5, 3));
  CHECK(scene.camera.look_at == Vector3d(0, 0, 0));
  CHECK(scene.camera.fov_deg == 55);
  CHECK(folder.without_folder(scene.camera.place.text()) == "scene.toml:10:1");
  CHECK(scene.environment == Vector3d(0.1, 0.2, 0.3));
  CHECK(scene.radiosity.method == "direct");
  CHECK(scene.radiosity.order == 4);
  CHECK(scene.radiosity.vmap_samples == 16);
  CHECK(scene.radiosity.vmap_rays == 123'456'789'012);
  CHECK(scene.radiosity.epsilon == 2e-2);
  CHECK(scene.radiosity.tolerance == 1e-4);
  CHECK(scene.radiosity.vmap == "thesis");
  CHECK(scene.radiosity.direct_light == "radiosity");
  CHECK(scene.radiosity.place.has_value());
  CHECK(scene.caustics.photons == 100'000'000);
  CHECK(scene.caustics.gather_k == 80);
  CHECK(scene.caustics.power == "equal");
  CHECK(scene.caustics.feedback);
  CHECK(scene.caustics.indirect);
  CHECK(scene.caustics.place.has_value());
  CHECK(scene.octree.branching == 4u);
  CHECK(scene.octree.order == PointOrder::hilbert);
  CHECK(scene.octree.leaf_capacity == 12u);
  CHECK(scene.octree.max_depth == 9);
  CHECK(scene.traversal.form == TraversalForm::wide);
  CHECK(scene.traversal.grouping == RayGrouping::packet);
  CHECK(scene.traversal.group == WorkGroup{16, 4});
  CHECK(scene.traversal.lanes == 16u);
  CHECK(scene.traversal.storage == PoolStorage::image2d);
  CHECK(scene.traversal.stepping == Stepping::absolute_delta);
  CHECK(scene.traversal.step_delta == 0.25);
  CHECK(scene.traversal.fast_math);
}

TEST_CASE("what is called auto is left open, as what is left out", "[scene]") {
  const SceneFolder folder;
  const std::string autos = "[octree]\norder = \"auto\"\n[traversal]\nform = \"auto\"\ngrouping = \"auto\"\n"
                            "group = \"auto\"\nstorage = \"auto\"\n";
  for (const std::string& more : {std::string(), autos}) {
    const Scene scene = folder.load(small_scene + more);
    CHECK_FALSE((scene.octree.branching || scene.octree.order || scene.octree.leaf_capacity));
    const TraversalSettings& t = scene.traversal;
    CHECK_FALSE((t.form || t.grouping || t.group || t.lanes || t.storage || t.fast_math));
  }
}

TEST_CASE("every key of the materials arrives", "[scene]") {
  const SceneFolder folder;
  std::filesystem::create_directory(folder.file("sub"));
  folder.write("sub/points.ply", "ply\n");
  const Scene scene = folder.load(full_scene);
  REQUIRE(scene.materials.size() == 4);
  const auto& points = scene.materials[0];
  CHECK(points.name == "points");
  CHECK(points.type == MaterialType::diffuse);
  CHECK_FALSE(points.albedo.has_value());
  CHECK(points.colour_space == ColourSpace::linear);
  CHECK(points.emission == Vector3d(0, 0.5, 1));
  CHECK(folder.without_folder(points.place.text()) == "scene.toml:14:1");
  CHECK(scene.materials[1].type == MaterialType::mirror);
  CHECK(scene.materials[1].specular == Vector3d(0.9, 0.8, 0.7));
  CHECK(scene.materials[2].type == MaterialType::glass);
  CHECK(scene.materials[2].ior == 1.33);
  CHECK(scene.materials[2].absorption == Vector3d(0.1, 0.2, 0.3));
  CHECK(scene.materials[3].type == MaterialType::phong);
  CHECK(scene.materials[3].albedo.value() == Vector3d(0.7, 0.7, 0.7));
  CHECK(scene.materials[3].specular == Vector3d(0.3, 0.2, 0.1));
  CHECK(scene.materials[3].exponent == 40);
}

TEST_CASE("every key of the clouds arrives", "[scene]") {
  const SceneFolder folder;
  std::filesystem::create_directory(folder.file("sub"));
  folder.write("sub/points.ply", "ply\n");
  const Scene scene = folder.load(full_scene);
  REQUIRE(scene.clouds.size() == 2);
  const auto& cloud = scene.clouds[0];
  CHECK(std::filesystem::equivalent(cloud.file, folder.file("sub/points.ply")));
  CHECK(cloud.material == "points");
  CHECK(cloud.scale == 10);
  CHECK(cloud.rotate_deg == Vector3d(90, 0, -45));
  CHECK(cloud.translate == Vector3d(1, 2, 3));
  CHECK(cloud.radius == 0.01);
  CHECK(cloud.normals == NormalSource::flip);
  CHECK(cloud.viewpoint.value() == Vector3d(0, 0, 5));
  CHECK(cloud.spacing == 0.02);
  CHECK(scene.clouds[1].radii == RadiusSource::file);
  CHECK(scene.clouds[1].normals == NormalSource::estimate);
  CHECK_FALSE(scene.clouds[1].radius.has_value());
  CHECK_FALSE(scene.clouds[1].viewpoint.has_value());
}

TEST_CASE("every key of the shapes and lights arrives", "[scene]") {
  const SceneFolder folder;
  std::filesystem::create_directory(folder.file("sub"));
  folder.write("sub/points.ply", "ply\n");
  const Scene scene = folder.load(full_scene);
  REQUIRE(scene.shapes.size() == 5);
  const auto& quad = std::get<QuadShape>(scene.shapes[0].geometry);
  CHECK(quad.corner == Vector3d(-1, 0, -1));
  CHECK(quad.edge_u == Vector3d(0, 0, 2));
  CHECK(quad.edge_v == Vector3d(2, 0, 0));
  CHECK(scene.shapes[0].spacing == 0.02);
  CHECK(scene.shapes[0].material == "gloss");
  const auto& sphere = std::get<SphereShape>(scene.shapes[1].geometry);
  CHECK(sphere.centre == Vector3d(0, 1, 0));
  CHECK(sphere.radius == 0.5);
  CHECK(sphere.inward);
  const auto& box = std::get<BoxShape>(scene.shapes[2].geometry);
  CHECK(box.min == Vector3d(-1, -1, -1));
  CHECK(box.max == Vector3d(1, 2, 3));
  CHECK(box.inward);
  const auto& disc = std::get<DiscShape>(scene.shapes[3].geometry);
  CHECK(disc.centre == Vector3d(0, 2, 0));
  CHECK(disc.normal == Vector3d(0, -2, 0));
  CHECK(disc.radius == 0.25);
  const auto& cylinder = std::get<CylinderShape>(scene.shapes[4].geometry);
  CHECK(cylinder.base == Vector3d(0, 0, 0));
  CHECK(cylinder.top == Vector3d(0, 0, 2));
  CHECK(cylinder.radius == 0.75);
  CHECK(cylinder.inward);

  REQUIRE(scene.lights.size() == 2);
  CHECK(scene.lights[0].vector == Vector3d(0, 1.9, 0));
  CHECK(scene.lights[0].strength == Vector3d(40, 30, 20) / (4.0 * 3.14159265358979323846));
  const LightSettings& sun = scene.lights[1];
  CHECK((sun.type == LightType::directional && sun.is_far));
  // A division and a square root: some units in the last place of a double.
  CHECK((sun.vector - Vector3d(0, 0.6, -0.8)).norm() < 1e-15);
  CHECK(sun.strength == Vector3d(1, 2, 3));
}

TEST_CASE("what a scene leaves out has the documented default", "[scene]") {
  const Scene scene = SceneFolder().load(small_scene);
  CHECK(scene.up == UpAxis::y);
  CHECK(scene.render.width == 640);
  CHECK(scene.render.height == 480);
  CHECK(scene.render.spp == 32);
  CHECK(scene.render.jitter);
  CHECK(scene.camera.place.text() == "(default)");
  CHECK(scene.camera.fov_deg == 40);
  CHECK(scene.environment == Vector3d(0, 0, 0));
  CHECK(scene.radiosity.method == "auto");
  CHECK(scene.radiosity.epsilon == 5e-3);
  CHECK_FALSE(scene.radiosity.vmap_rays.has_value());
  CHECK(scene.radiosity.vmap == "fractions");
  CHECK(scene.radiosity.direct_light == "auto");
  CHECK_FALSE(scene.radiosity.place.has_value());
  CHECK(scene.caustics.photons == 400000);
  CHECK_FALSE(scene.caustics.feedback);
  CHECK_FALSE(scene.caustics.indirect);
  CHECK_FALSE(scene.caustics.place.has_value());
  CHECK(scene.warnings.empty());
}

TEST_CASE("a bare cloud has the coarser epsilon of a first picture, unless told otherwise", "[scene]") {
  const SceneFolder folder;
  const std::string cloud = folder.write("cloud.xyz", "0 0 0\n1 0 0\n0 1 0\n");
  CHECK(load_bare_cloud(cloud).radiosity.epsilon == limits::bare_epsilon);
  CHECK(load_bare_cloud(cloud, {"radiosity.epsilon=5e-3"}).radiosity.epsilon == 5e-3);
}

TEST_CASE("the ends of every range are allowed", "[scene]") {
  const SceneFolder folder;
  const auto render = [&](const std::string& line) {
    return folder.load(std::string(small_scene) + "[render]\n" + line + "\n").render;
  };
  CHECK(render("size = [16384, 16384]").height == 16384);
  CHECK(render("size = [1, 16384]").width == 1);
  CHECK(render("size = [1, 1]").width == 1);
  CHECK(render("size = [65536, 32768]").width == 65536); // exactly 2^31 pixels
  CHECK(render("spp = 1").spp == 1);
  CHECK(render("spp = 65536").spp == 65536);
  CHECK(render("seed = 0").seed == 0);

  const auto ior = [&](const std::string& value) {
    return folder.load(std::string(small_scene) + "[[material]]\nname = \"g\"\ntype = \"glass\"\nior = " + value)
        .materials.back()
        .ior;
  };
  CHECK(ior("1") == 1.0);
  CHECK(ior("1000") == 1000.0);
  CHECK(ior("0.75") == 0.75);

  const auto albedo = [&](const std::string& value) {
    return folder.load(std::string(small_scene) + "[[material]]\nname = \"a\"\ntype = \"diffuse\"\nalbedo = " + value)
        .materials.back()
        .albedo.value();
  };
  CHECK(albedo("[0, 0.0, 1]") == Vector3d(0, 0, 1));
  const auto photons = [&](const std::string& value) {
    return folder.load(std::string(small_scene) + "[caustics]\nphotons = " + value).caustics.photons;
  };
  CHECK(photons("0") == 0);
  CHECK(photons("100_000_000") == 100'000'000);
}

TEST_CASE("powers and lengths of the extremes load", "[scene]") {
  const SceneFolder folder;
  for (const char* power : {"1e-20", "1e20"}) {
    const Scene scene = folder.load(with_line(small_scene, "power_w = [1, 2, 3]",
                                              "[[light]]\ntype = \"point\"\nposition = [1e6, -1e6, 0]\npower_w = [" +
                                                  std::string(power) + ", 0, 0]"));
    CHECK(scene.lights[1].strength.x() == std::stod(power) / (4.0 * 3.14159265358979323846));
  }
}

TEST_CASE("a scene without light loads with a warning", "[scene]") {
  const SceneFolder folder;
  std::string dark = small_scene;
  dark.erase(dark.find("[[light]]"));
  REQUIRE(folder.load(dark).warnings.size() == 1);
  CHECK(folder.without_folder(folder.load(dark).warnings[0]) ==
        "scene.toml: nothing gives light, the picture will be black; add a [[light]], an [environment] or a material "
        "with emission.");
  CHECK(folder.load(dark + "[environment]\nradiance = [0, 0, 1e-20]").warnings.empty());
  CHECK(folder.load(dark + "[environment]\nradiance = [0, 0, 0]").warnings.size() == 1);
  CHECK(folder.load(with_line(dark, "type = \"diffuse\"", "emission = [1, 0, 0]")).warnings.empty());
  // A lamp that no shape is made of does not shine.
  CHECK(
      folder.load(dark + "[[material]]\nname = \"lamp\"\ntype = \"diffuse\"\nemission = [1, 1, 1]\n").warnings.size() ==
      1);
  CHECK(
      folder.load(dark + "[[light]]\ntype = \"point\"\nposition = [0, 1, 0]\npower_w = [0, 0, 0]\n").warnings.size() ==
      1);
}

TEST_CASE("a colour space beside an albedo is warned of", "[scene]") {
  const SceneFolder folder;
  const Scene scene = folder.load(with_line(small_scene, "type = \"diffuse\"", "colour_space = \"srgb\""));
  REQUIRE(scene.warnings.size() == 1);
  CHECK_THAT(scene.warnings[0], Catch::Contains("scene.toml:5:16: material \"white\": colour_space has no effect"));
  CHECK(scene.materials[0].albedo.value() == Vector3d(0.73, 0.73, 0.73)); // linear all the same
}

TEST_CASE("cloud files are found from the scene's folder, wherever the program runs", "[scene]") {
  const SceneFolder folder;
  folder.write("points.ply", "ply\n");
  const std::string scene = "version = 1\n[[material]]\nname = \"m\"\ntype = \"diffuse\"\n[[cloud]]\nmaterial = "
                            "\"m\"\nfile = ";
  CHECK(std::filesystem::equivalent(folder.load(scene + "\"points.ply\"").clouds[0].file, folder.file("points.ply")));
  CHECK(folder.load(scene + "\"" + folder.file("points.ply") + "\"").clouds[0].file == folder.file("points.ply"));
}

TEST_CASE("line ends and a byte order mark of other systems are read", "[scene]") {
  std::string text = small_scene;
  for (auto at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 2))
    text.insert(at, "\r");
  const SceneFolder folder;
  CHECK(folder.load("\xef\xbb\xbf" + text).shapes.size() == 1);
  CHECK(folder.error(text + "[render]\r\nspp = 0\r\n") ==
        "scene.toml:18:7: render.spp: expected an integer from 1 to 65536, found 0");
}

TEST_CASE("names of materials are names of the type", "[scene]") {
  CHECK(std::string(name_of(MaterialType::diffuse)) == "diffuse");
  CHECK(std::string(name_of(MaterialType::mirror)) == "mirror");
  CHECK(std::string(name_of(MaterialType::glass)) == "glass");
  CHECK(std::string(name_of(MaterialType::phong)) == "phong");
}

TEST_CASE("errors show the control characters of a scene and of --set, and do not send them to the terminal") {
  const SceneFolder folder;
  const std::string names = "version = 1\n[[material]]\nname = \"\\u001b[31m\"\n[[material]]\nname = \"b\"\n";
  const std::string of_material = folder.error(names + "[[shape]]\ntype = \"sphere\"\nmaterial = \"other\"\n");
  for (const std::string& error :
       {folder.error("version = 1\n\"\\u001b[31m\" = 1\n"), folder.error("version = 1\n\x1b[31m = 1\n"),
        folder.error("version = 1\nup = \"\x7f\"\n"), of_material,
        folder.error(names, {"material.other.type=mirror"})}) {
    INFO(error);
    CHECK_FALSE(error.empty());
    CHECK(test::is_harmless(error));
  }
  CHECK_THAT(folder.error("version = 1\n\"\\u001b[31m\" = 1\n"), Catch::Contains("\\x1b[31m: unknown key"));
}
