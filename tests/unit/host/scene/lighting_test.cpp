#include "host/scene/lighting.h"
#include <catch2/catch.hpp>

using namespace pointgi;

namespace {

constexpr double pi = 3.14159265358979323846;

Scene lit_scene() {
  Scene scene;
  scene.camera.position = Vector3d(0, 0, 5);
  scene.camera.look_at = Vector3d(0, 0, 0);
  scene.materials.resize(2);
  scene.materials[1].emission = Vector3d(3, 2, 1);
  return scene;
}

std::vector<Splat> two_splats() {
  std::vector<Splat> splats(2);
  splats[0].material = 0.0f;
  splats[1].material = 1.0f;
  splats[0].area = splats[1].area = 0.01f;
  return splats;
}

/// A point through a row-vector matrix, divided by w.
Vector3d project(const std::array<float, 16>& m, const Vector3d& p) {
  double out[4];
  for (int c = 0; c < 4; ++c)
    out[c] = m[c] * p.x() + m[4 + c] * p.y() + m[8 + c] * p.z() + m[12 + c];
  return Vector3d(out[0], out[1], out[2]) / out[3];
}

} // namespace

TEST_CASE("only emitting splats are emitters, only lights with power are lights") {
  Scene scene = lit_scene();
  scene.lights.push_back({LightType::point, false, Vector3d(0, 0, 0), Vector3d(0, 0, 0) / (4.0 * pi), 0.0, {}});
  scene.lights.push_back({LightType::point, false, Vector3d(0, 0, 0), Vector3d(4, 4, 4) / (4.0 * pi), 0.0, {}});
  const auto splats = two_splats();
  const DeviceLighting lighting = device_lighting(scene, {}, splats);
  REQUIRE(lighting.emitters.size() == 1);
  CHECK(lighting.emitters[0].point == 1);
  CHECK(lighting.emitters[0].cumulative == 1.0f);
  CHECK(lighting.light_sources.size() == 1);
  CHECK_FALSE(lighting.has_environment);
}

TEST_CASE("materials reach the device in its unit of length, and which of them splats have") {
  Scene scene = lit_scene();
  scene.materials.resize(4);
  scene.materials[1].type = MaterialType::glass;
  scene.materials[1].flags = MATERIAL_SPECULAR | MATERIAL_TRANSMITS;
  scene.materials[1].ior = 1.33;
  scene.materials[1].absorption = Vector3d(1.0, 2.0, 3.0);
  scene.materials[2].type = MaterialType::mirror;
  scene.materials[2].flags = MATERIAL_SPECULAR;
  scene.materials[2].specular = Vector3d(0.9, 0.8, 0.7);
  scene.materials[3].type = MaterialType::phong;
  scene.materials[3].flags = MATERIAL_REFLECTS_DIFFUSELY | MATERIAL_SPECULAR | MATERIAL_HAS_LOBE;
  scene.materials[3].specular = Vector3d(0.3, 0.2, 0.1);
  scene.materials[3].exponent = 40.0;
  Frame frame;
  frame.side = 5.0;
  const auto splats = two_splats();
  const DeviceLighting lighting = device_lighting(scene, frame, splats);
  REQUIRE(lighting.materials.size() == 4);
  CHECK(lighting.materials[0].type == MATERIAL_DIFFUSE);
  CHECK(lighting.materials[1].type == MATERIAL_GLASS);
  CHECK(lighting.materials[1].ior == 1.33f);
  CHECK(lighting.materials[1].absorption[2] == 15.0f); // over a cube's side, five units
  CHECK(lighting.materials[2].type == MATERIAL_MIRROR);
  CHECK(lighting.materials[2].specular[1] == 0.8f);
  CHECK(lighting.materials[3].type == MATERIAL_PHONG);
  CHECK(lighting.materials[3].specular[0] == 0.3f);
  CHECK(lighting.materials[3].exponent == 40.0f);
  CHECK(lighting.has_specular());
  CHECK(lighting.has_flag(MATERIAL_TRANSMITS));
  CHECK((lighting.material_types >> MATERIAL_MIRROR & 1u) == 0); // of a material that no splat has
  CHECK_FALSE(device_lighting(lit_scene(), {}, splats).has_specular());
}

TEST_CASE("the radiance scale is a power of two near the brightest source, whatever its size") {
  for (const double power : {1e-20, 1.0, 1e20}) {
    Scene scene = lit_scene();
    scene.materials[1].emission = Vector3d(0, 0, 0);
    scene.lights.push_back(
        {LightType::point, false, Vector3d(0, 0, 0), Vector3d(power, power, power) / (4.0 * pi), 0.0, {}});
    const DeviceLighting lighting = device_lighting(scene, {}, two_splats());
    CHECK(std::log2(lighting.radiance.scale) == std::round(std::log2(lighting.radiance.scale)));
    CHECK(lighting.light_sources[0].strength[0] > 0.5f);
    CHECK(lighting.light_sources[0].strength[0] < 2.0f);
  }
}

TEST_CASE("the matrices of the EXR file put the view's middle and corner where they belong") {
  Scene scene = lit_scene();
  scene.render.width = 200;
  scene.render.height = 100;
  scene.camera.fov_deg = 90.0; // half the height at distance 1 is 1
  CHECK(project(world_to_camera(scene), Vector3d(0, 0, 0)).isApprox(Vector3d(0, 0, -5), 1e-6));
  const Vector3d middle = project(world_to_ndc(scene), Vector3d(0, 0, 0));
  CHECK(middle.x() == Approx(0.5));
  CHECK(middle.y() == Approx(0.5));
  const Vector3d top_right = project(world_to_ndc(scene), Vector3d(10, 5, 0));
  CHECK(top_right.x() == Approx(1.0));
  CHECK(top_right.y() == Approx(1.0));
  const Camera camera = device_camera(scene, {});
  CHECK(camera.corner[0] == Approx(-2.0)); // top left
  CHECK(camera.corner[1] == Approx(1.0));
  CHECK(camera.step_y[1] < 0.0f); // rows run downwards
}
