#include "host/image/srgb.h"
#include "host/passes/variant.h"
#include "host/stages/lit_cloud.h"
#include "tests/support/clouds.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;

TEST_CASE("a lit cloud whose exposure is open shows its points neither burnt nor black, whatever their light") {
  const std::vector<Splat> splats = random_splats(200, 3);
  Scene scene;
  scene.materials.resize(1);
  scene.materials[0].flags = MATERIAL_REFLECTS_DIFFUSELY;
  const TraversalVariant variant;
  const Frame frame;
  DeviceLighting lighting;
  lighting.materials.resize(1);
  const IndirectRequest request{variant, scene, frame, lighting, splats};
  std::vector<float> shown;
  for (const float strength : {1e-3f, 1.0f, 1e5f}) {
    IndirectLight light;
    light.direct.assign(3 * splats.size(), strength);
    const LitCloud open = lit_cloud(request, light, {});
    REQUIRE(open.cloud.colour.size() == splats.size());
    shown.push_back(open.cloud.colour[0].x());
    // Of a reflectance of a half, between the greys that black and white surfaces are to have.
    CHECK(shown.back() > 0.2f);
    CHECK(shown.back() < 0.8f);
    // Radiosity = 0.5 H whatever the exposure is; at 0 stops its colour is that of B / pi.
    CHECK(open.columns[0].values[0] == Approx(0.5f * strength));
    const LitCloud given = lit_cloud(request, light, 0.0);
    CHECK(given.cloud.colour[0].x() ==
          Approx(linear_to_srgb(std::min(1.0f, 0.5f * strength / 3.14159265f))).epsilon(1e-5));
    CHECK(given.columns[0].values == open.columns[0].values);
  }
  CHECK(shown[0] == Approx(shown[2]).epsilon(0.05)); // steps of the meter
}
