/// `bake --sky`: the share of the sky that a point sees, against form factors in closed form.
#include "host/app/commands.h"
#include "host/cloud/readers/ply.h"
#include "tests/support/scene_parts.h"
#include "tests/support/temporary_folder.h"
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <functional>

using namespace pointgi;
using namespace pointgi::test;
using Eigen::Vector3d;

namespace {

constexpr double pi = 3.14159265358979323846;

/// Each point with its normal and its share of the sky; the scene has no light.
struct SeenSky {
  PointCloud cloud;
  std::vector<double> share;
};

SeenSky sky_of(const std::string& objects) {
  const TemporaryFolder folder;
  BakeOptions options;
  options.input = folder.write("scene.toml", "version = 1\n" + material("own", "diffuse") + objects);
  options.output = folder.file("sky.ply");
  options.overrides = {"radiosity.light_samples=256"};
  options.quiet = true;
  options.sky = true;
  if (run_bake(options) != ExitCode::done) throw std::runtime_error("the cloud was not finished");
  CloudReport report;
  SeenSky sky;
  sky.cloud = read_ply(options.output, {0.0, {"scalar_sky"}, false}, report);
  REQUIRE(sky.cloud.colour.empty()); // without light nothing is coloured
  REQUIRE(sky.cloud.fields.size() == 1);
  sky.share = sky.cloud.fields[0].values;
  return sky;
}

/// Share of the cosine-weighted directions that a polygon takes, which lies on the normal's side (Lambert 1760).
/// Corners counterclockwise as seen from the point.
double form_factor(const Vector3d& point, const Vector3d& normal, const std::vector<Vector3d>& corners) {
  double sum = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector3d a = (corners[i] - point).normalized(), b = (corners[(i + 1) % corners.size()] - point).normalized();
    sum += std::acos(std::clamp(a.dot(b), -1.0, 1.0)) * a.cross(b).normalized().dot(normal);
  }
  return std::abs(sum) / (2.0 * pi);
}

/// Worst and mean difference over the points where `truth` is not negative.
struct Errors {
  double worst = 0.0, mean = 0.0;
  std::size_t points = 0;
};

Errors compared(const SeenSky& sky, const std::function<double(const Vector3d&, const Vector3d&)>& truth) {
  Errors errors;
  for (std::size_t i = 0; i < sky.cloud.size(); ++i) {
    const double expected = truth(sky.cloud.position[i], sky.cloud.normal[i].cast<double>());
    if (expected < 0.0) continue;
    errors.worst = std::max(errors.worst, std::abs(sky.share[i] - expected));
    errors.mean += sky.share[i] - expected;
    ++errors.points;
  }
  errors.mean /= static_cast<double>(errors.points);
  return errors;
}

// 1024 rays a point: a share of a half scatters by 0.016 at most, less as they are stratified; of a few thousand points
// four such steps are the worst.
constexpr double scatter = 0.06;
// The scatter averages out. What is left is that discs reach over the edges of what they cover, by about half of the
// spacing of 0.02 in walls of 1: a hundredth.
constexpr double bias = 0.01;

} // namespace

TEST_CASE("a plane sees all of the sky") {
  const SeenSky sky = sky_of(quad("0, 0, 0", "0, 0, 1", "1, 0, 0", "own", 0.05));
  for (const double share : sky.share)
    REQUIRE(share == 1.0);
}

TEST_CASE("in the corner of two walls each hides part of the other's sky") {
  // The floor z = 0, 0 <= x <= 1, and the wall x = 0, 0 <= z <= 1, both from y = -1 to 1.
  const SeenSky sky =
      sky_of(quad("0, -1, 0", "1, 0, 0", "0, 2, 0", "own", 0.02) + quad("0, -1, 0", "0, 2, 0", "0, 0, 1", "own", 0.02));
  const Errors errors = compared(sky, [](const Vector3d& p, const Vector3d& n) {
    if (p.x() < 0.1 && p.z() < 0.1) return -1.0; // within a few discs of the edge
    const bool floor = n.z() > 0.5;
    const Vector3d out = floor ? Vector3d::UnitZ() : Vector3d::UnitX();
    return 1.0 - form_factor(p, n, {{0, -1, 0}, {0, 1, 0}, Vector3d(0, 1, 0) + out, Vector3d(0, -1, 0) + out});
  });
  CHECK(errors.points > 5000);
  CHECK(errors.worst < scatter);
  CHECK(std::abs(errors.mean) < bias);
}

TEST_CASE("from the bottom of a pit the sky is its opening") {
  const SeenSky sky =
      sky_of(quad("0, 0, 0", "1, 0, 0", "0, 1, 0", "own", 0.02) + quad("0, 0, 0", "0, 1, 0", "0, 0, 1", "own", 0.02) +
             quad("1, 0, 0", "0, 0, 1", "0, 1, 0", "own", 0.02) + quad("0, 0, 0", "0, 0, 1", "1, 0, 0", "own", 0.02) +
             quad("0, 1, 0", "1, 0, 0", "0, 0, 1", "own", 0.02));
  const Errors errors = compared(sky, [](const Vector3d& p, const Vector3d& n) {
    if (n.z() < 0.5 || std::min({p.x(), p.y(), 1.0 - p.x(), 1.0 - p.y()}) < 0.05) return -1.0; // the bottom's middle
    return form_factor(p, n, {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}});
  });
  CHECK(errors.points > 1000);
  CHECK(errors.worst < scatter);
  CHECK(std::abs(errors.mean) < bias);
}

TEST_CASE("a ball on a plane hides (R / D)^3 of the sky of a point at the distance D from its centre") {
  const SeenSky sky =
      sky_of(quad("-3, -3, 0", "6, 0, 0", "0, 6, 0", "own", 0.06) + sphere("0, 0, 0.5", 0.5, "own", 0.03));
  const Errors errors = compared(sky, [](const Vector3d& p, const Vector3d& n) {
    if (p.z() > 1e-3 || n.z() < 0.99 || p.norm() < 0.25) return -1.0; // under the ball discs touch each other
    return 1.0 - std::pow(0.5 / (p - Vector3d(0, 0, 0.5)).norm(), 3.0);
  });
  CHECK(errors.points > 5000);
  CHECK(errors.worst < scatter);
  CHECK(std::abs(errors.mean) < bias);
}
