#include "host/scene/lighting.h"
#include "host/scene/sample_shape.h"
#include "host/view/default_view.h"
#include <catch2/catch.hpp>

using namespace pointgi;

namespace {

WorldSplats splats_of(const ShapeGeometry& geometry, double spacing) {
  ShapeSettings shape;
  shape.geometry = geometry;
  shape.spacing = spacing;
  WorldSplats splats;
  splats.cloud = sample_shape(shape);
  return splats;
}

/// Largest distance from the middle of the frame, 1 at its border.
double fill(const Scene& scene, const PointCloud& cloud) {
  const auto m = world_to_ndc(scene);
  double most = 0.0;
  for (const Vector3d& p : cloud.position) {
    double out[4];
    for (int c = 0; c < 4; ++c)
      out[c] = m[c] * p.x() + m[4 + c] * p.y() + m[8 + c] * p.z() + m[12 + c];
    most = std::max({most, std::fabs(2.0 * out[0] / out[3] - 1.0), std::fabs(2.0 * out[1] / out[3] - 1.0)});
  }
  return most;
}

} // namespace

TEST_CASE("the whole object is in the frame and fills it, at any size and place") {
  for (const double s : {1e-6, 1.0, 1e6})
    for (const double at : {0.0, 1e6}) {
      const WorldSplats splats =
          splats_of(BoxShape{Vector3d(at, at, at) * s, Vector3d(at + 1, at + 2, at + 0.5) * s, false}, 0.05 * s);
      Scene scene;
      choose_camera(scene, splats);
      CHECK(fill(scene, splats.cloud) < 1.0);
      CHECK(fill(scene, splats.cloud) > 0.8);
    }
}

TEST_CASE("a wide flat surface is terrain, seen from the side it faces") {
  for (const double side : {1.0, -1.0}) {
    const WorldSplats splats =
        splats_of(QuadShape{Vector3d(0, 0, 0), Vector3d(10, 0, 0), Vector3d(0, side * 8, 0)}, 0.2);
    Scene scene;
    const std::string said = choose_camera(scene, splats);
    CHECK_THAT(said, Catch::Contains("terrain"));
    CHECK(side * scene.camera.position.z() > 0.0);
  }
}

TEST_CASE("what stands on the floor stands upright in the picture") {
  // A tall box: it stands on its small face along y and along z alike; y is the custom. Lying along z it stands on a
  // broad face either way.
  Scene scene;
  choose_camera(scene, splats_of(BoxShape{Vector3d(0, 0, 0), Vector3d(1, 3, 1), false}, 0.1));
  CHECK(up_of(scene).y() > 0.9);
}
