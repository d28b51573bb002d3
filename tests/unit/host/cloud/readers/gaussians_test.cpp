#include "host/cloud/complete.h"
#include "host/cloud/drop_points.h"
#include "host/cloud/readers/gaussians.h"
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <limits>

using namespace pointgi;
using Catch::Matchers::Contains;
using Eigen::Vector3d;
using Eigen::Vector3f;
using Eigen::Vector4f;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

/// One Gaussian after the other along x.
struct Gaussians {
  PointCloud cloud;
  GaussianValues values;
  CloudReport report;

  void add(const Vector3f& scale, const Vector4f& rotation, float opacity = 0.9f,
           const Vector3f& harmonic = Vector3f::Zero()) {
    cloud.position.push_back(Vector3d(static_cast<double>(cloud.size()), 0, 0));
    values.log_scale.push_back(scale.array().log());
    values.rotation.push_back(rotation);
    values.opacity.push_back(std::log(opacity / (1 - opacity)));
    values.harmonic.push_back(harmonic);
  }
  void read() { discs_from_gaussians(values, cloud, report); }
};

const Vector4f unturned(1, 0, 0, 0);

} // namespace

TEST_CASE("gaussians: a flat one is a disc across its shortest axis") {
  Gaussians g;
  g.add({0.2f, 0.01f, 0.8f}, unturned);
  // A quarter turn about x takes y to z; the quaternion need not be of length 1.
  g.add({0.2f, 0.01f, 0.8f}, 3.0f * Vector4f(std::sqrt(0.5f), std::sqrt(0.5f), 0, 0));
  g.read();
  // Rounding of a few products of floats.
  CHECK(std::abs(g.cloud.normal[0].dot(Vector3f::UnitY())) == Approx(1.0f).epsilon(1e-6));
  CHECK(std::abs(g.cloud.normal[1].dot(Vector3f::UnitZ())) == Approx(1.0f).epsilon(1e-6));
  CHECK(g.cloud.normals_unsigned);
  // The disc has the area 2 pi s t that the profile exp(-r^2/2) over both axes integrates to.
  for (const float radius : g.cloud.radius)
    CHECK(radius * radius == Approx(2.0f * 0.2f * 0.8f).epsilon(1e-5));
}

TEST_CASE("gaussians: balls and needles have no normal") {
  Gaussians g;
  g.add({0.1f, 0.1f, 0.1f}, unturned);
  g.add({0.09f, 0.1f, 0.1f}, unturned); // nearly a ball
  g.add({0.1f, 0.1f, 2.0f}, unturned);  // flat towards no side
  g.add({0.05f, 0.1f, 2.0f}, unturned);
  g.add({0.1f, 0.01f, 0.1f}, Vector4f::Zero()); // no rotation
  g.read();
  for (const std::size_t i : {0, 1, 2, 4})
    CHECK(g.cloud.normal[i] == Vector3f::Zero());
  CHECK(std::abs(g.cloud.normal[3].x()) == Approx(1.0f));
  CHECK_THAT(g.report.notes.at(0), Contains("4 are not flat"));
}

TEST_CASE("gaussians: two axes mean a disc across the third") {
  Gaussians g;
  g.add({0.1f, 0.3f, 1.0f}, Vector4f(std::sqrt(0.5f), 0, std::sqrt(0.5f), 0));
  g.values.log_scale[0].z() = -infinity;
  g.read();
  CHECK(std::abs(g.cloud.normal[0].x()) == Approx(1.0f).epsilon(1e-6)); // a quarter turn about y takes z to x
  CHECK(g.cloud.radius[0] == Approx(std::sqrt(2.0f * 0.1f * 0.3f)).epsilon(1e-5));
}

TEST_CASE("gaussians: colours are the constant term, opacities the logistic function") {
  Gaussians g;
  g.add({0.1f, 0.1f, 0.01f}, unturned, 0.25f, {0.0f, 1.0f, -1.0f});
  g.add({0.1f, 0.1f, 0.01f}, unturned, 0.75f, {5.0f, -5.0f, 0.5f});
  g.read();
  CHECK((g.cloud.colour[0] - Vector3f(0.5f, 0.78209479f, 0.21790521f)).norm() < 1e-6f);
  CHECK((g.cloud.colour[1] - Vector3f(1.0f, 0.0f, 0.641047395f)).norm() < 1e-6f);
  CHECK(g.cloud.opacity[0] == Approx(0.25f).epsilon(1e-5));
  CHECK(g.cloud.opacity[1] == Approx(0.75f).epsilon(1e-5));
}

TEST_CASE("gaussians: the file's own normals and radii are kept") {
  Gaussians g;
  g.add({0.1f, 0.01f, 0.1f}, unturned);
  g.add({0.1f, 0.01f, 0.1f}, unturned);
  g.cloud.normal = {Vector3f(0, 0, -2), Vector3f::Zero()};
  g.cloud.radius = {5.0f, 6.0f};
  g.read();
  CHECK(g.cloud.normal[0] == Vector3f(0, 0, -2));
  CHECK(std::abs(g.cloud.normal[1].y()) == Approx(1.0f));
  CHECK(g.cloud.radius == std::vector<float>{5.0f, 6.0f});
}

TEST_CASE("gaussians: the faintest are dropped with what belongs to them, and counted") {
  Gaussians g;
  for (int i = 0; i < 6; ++i)
    g.add({0.1f, 0.1f, 0.01f}, unturned, i % 3 == 0 ? 0.05f : 0.5f);
  g.values.opacity[5] = std::numeric_limits<float>::quiet_NaN();
  g.read();
  CHECK(g.cloud.size() == 6); // the reader tells of all that the file has
  CHECK_THAT(g.report.notes.at(0), Contains("6 Gaussians") && Contains("2 are nearly transparent"));
  CHECK(drop_unusable_points(g.cloud, {}) == 3);
  REQUIRE(g.cloud.opacity.size() == 3);
  CHECK(g.cloud.position[2].x() == 4.0);
  for (const float opacity : g.cloud.opacity)
    CHECK(opacity == Approx(0.5f).epsilon(1e-5));
}
