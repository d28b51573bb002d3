#include "host/scene/splats.h"
#include <catch2/catch.hpp>

using namespace pointgi;

namespace {

PointCloud square(bool with_structure) {
  PointCloud cloud;
  for (int i = 0; i < 4; ++i) {
    cloud.position.emplace_back(i % 2, i / 2, 0.0);
    cloud.normal.emplace_back(0.0f, 0.0f, 1.0f);
    cloud.radius.push_back(0.6f);
    cloud.area.push_back(1.0f);
  }
  if (with_structure) cloud.structure.assign(4, Structure::stray);
  return cloud;
}

} // namespace

TEST_CASE("one more object has its material's albedo, and a structure where the others have one") {
  MaterialSettings material;
  material.flags = MATERIAL_REFLECTS_DIFFUSELY;
  material.albedo = Vector3d(0.25, 0.5, 0.75);
  for (const bool first : {false, true})
    for (const bool second : {false, true}) {
      WorldSplats splats;
      append_cloud(splats, square(first), material, 0);
      append_cloud(splats, square(second), material, 7);
      CHECK(splats.cloud.size() == 8);
      CHECK(splats.first == std::vector<std::uint32_t>{0, 4});
      CHECK((splats.material.front() == 0 && splats.material.back() == 7));
      CHECK(splats.cloud.colour[5] == Eigen::Vector3f(0.25f, 0.5f, 0.75f));
      REQUIRE(splats.cloud.structure.size() == (first || second ? 8 : 0));
      if (first || second) CHECK(splats.cloud.structure[0] == (first ? Structure::stray : Structure::surface));
      if (first || second) CHECK(splats.cloud.structure[7] == (second ? Structure::stray : Structure::surface));
    }
}
