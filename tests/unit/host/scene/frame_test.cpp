#include "host/scene/frame.h"
#include <catch2/catch.hpp>
#include <random>

using namespace pointgi;

TEST_CASE("the root cube holds every disc, at any size and place, and goes there and back") {
  for (const double size : {1e-6, 1.0, 1e6})
    for (const double offset : {0.0, 1e6}) {
      std::mt19937 g(1);
      std::uniform_real_distribution<double> unit(-1.0, 1.0);
      PointCloud cloud;
      for (int i = 0; i < 300; ++i) {
        cloud.position.push_back(
            size * (Eigen::Vector3d(unit(g), unit(g), 0.2 * unit(g)) + Eigen::Vector3d::Constant(offset)));
        cloud.normal.push_back(Eigen::Vector3d(unit(g), unit(g), unit(g)).normalized().cast<float>());
        cloud.radius.push_back(static_cast<float>(0.1 * size));
      }
      const Frame frame = frame_of(cloud);
      for (std::size_t i = 0; i < cloud.size(); ++i) {
        const Eigen::Vector3f cube = frame.to_cube(cloud.position[i]);
        const auto r = static_cast<float>(cloud.radius[i] / frame.side);
        const Eigen::Vector3f half = r * (1.0f - cloud.normal[i].array().square()).max(0.0f).sqrt().matrix();
        REQUIRE((cube - half).minCoeff() > 0.0f);
        REQUIRE((cube + half).maxCoeff() < 1.0f);
        // Half a float step of a coordinate below 1.
        REQUIRE((frame.to_world(cube) - cloud.position[i]).norm() < 1e-7 * frame.side);
      }
    }
}
