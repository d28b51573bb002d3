/// The normal field against surfaces whose normals are known everywhere.
#include "host/cloud/normal_field.h"
#include "tests/support/clouds.h"
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;

namespace {

Eigen::Vector3d vector(const float v[3]) {
  return {v[0], v[1], v[2]};
}

std::vector<NormalSlopes> field_of_all(const std::vector<Splat>& splats) {
  return fit_normal_field(splats, [](const Splat&) { return true; });
}

/// The field's normal at u a + v b from the middle of a splat, and the point there.
Eigen::Vector3d field_normal(const Splat& splat, const NormalSlopes& f, double u, double v, Eigen::Vector3d* at) {
  float a_of[3], b_of[3];
  splat_tangents(splat.normal, a_of, b_of);
  const Eigen::Vector3d a = vector(a_of), b = vector(b_of), n = vector(splat.normal);
  *at = vector(splat.position) + u * a + v * b;
  return (n + u * (f.slope[0] * a + f.slope[1] * b) + v * (f.slope[2] * a + f.slope[3] * b)).normalized();
}

struct FieldError {
  double field = 0.0, constant = 0.0; ///< largest angles, radians
};

/// At half the discs' radius, in eight directions; `truth(p)` is the surface's normal nearest to p.
template <typename Truth>
FieldError error_of(const std::vector<Splat>& splats, const Truth& truth) {
  const auto field = field_of_all(splats);
  FieldError error;
  for (std::size_t i = 0; i < splats.size(); ++i)
    for (int k = 0; k < 8; ++k) {
      const double r = 0.5 * splats[i].radius, angle = 0.785398 * k;
      Eigen::Vector3d at;
      const Eigen::Vector3d n = field_normal(splats[i], field[i], r * std::cos(angle), r * std::sin(angle), &at);
      const Eigen::Vector3d m = truth(at);
      error.field = std::max(error.field, n.cross(m).norm());
      error.constant = std::max(error.constant, vector(splats[i].normal).cross(m).norm());
    }
  return error;
}

/// An ellipsoid of half axes 0.3, 0.2, 0.15: curved unequally, so that slopes change from splat to splat.
const Eigen::Vector3d half_axes(0.3, 0.2, 0.15);

Eigen::Vector3d ellipsoid_normal(const Eigen::Vector3d& p) {
  return (p - Eigen::Vector3d::Constant(0.5)).cwiseQuotient(half_axes.cwiseAbs2()).normalized();
}

std::vector<Splat> ellipsoid_splats(std::size_t count) {
  std::vector<Splat> splats = sphere_splats(count, 1.0f);
  for (Splat& s : splats) {
    const Eigen::Vector3d p = Eigen::Vector3d::Constant(0.5) + vector(s.normal).cwiseProduct(half_axes);
    const Eigen::Vector3d n = ellipsoid_normal(p);
    for (int k = 0; k < 3; ++k) {
      s.position[k] = static_cast<float>(p[k]);
      s.normal[k] = static_cast<float>(n[k]);
    }
    s.radius *= 0.25f;
  }
  return splats;
}

} // namespace

TEST_CASE("normal field: the normals of a sphere") {
  for (const std::size_t count : {1000u, 4000u, 16000u}) {
    CAPTURE(count);
    const FieldError error = error_of(sphere_splats(count), [](const Eigen::Vector3d& p) {
      return (p - Eigen::Vector3d::Constant(0.5)).normalized();
    });
    // Normals of a sphere change evenly, so the field has them at all spacings, to the rounding of float.
    CHECK(error.field < 1e-6);
    CHECK(error.constant > 0.5 * 1.2 / std::sqrt(static_cast<double>(count))); // r / 2 over R, nearly
  }
}

TEST_CASE("normal field: the normals of an ellipsoid, whose curvatures differ and change") {
  double before = 0.0;
  for (const std::size_t count : {2000u, 8000u, 32000u}) {
    CAPTURE(count);
    const FieldError error = error_of(ellipsoid_splats(count), ellipsoid_normal);
    CHECK(error.field < 0.3 * error.constant); // the sharp ends of the coarsest
    // A quarter for half the spacing, if all splats were curved alike; the worst are at the sharp ends.
    if (before > 0.0) CHECK(error.field < before / 2.5);
    before = error.field;
  }
}

TEST_CASE("normal field: planes have none, creases keep theirs apart, lone splats are left alone") {
  // Two half planes at a right angle, of one material.
  std::vector<Splat> corner;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j) {
      const float u = 0.2f + 0.02f * static_cast<float>(i), v = 0.21f + 0.02f * static_cast<float>(j);
      corner.push_back(make_splat(v, u, 0.2f, 0.0f, 0.0f, 1.0f, 0.015f));
      corner.push_back(make_splat(0.2f, u, v, 1.0f, 0.0f, 0.0f, 0.015f));
    }
  for (const NormalSlopes& f : field_of_all(corner))
    for (const float slope : f.slope)
      REQUIRE(slope == Approx(0.0).margin(1e-4));
  for (const std::size_t few : {1u, 2u, 3u}) {
    const auto field = field_of_all({corner.begin(), corner.begin() + static_cast<std::ptrdiff_t>(few)});
    REQUIRE(field.size() == few);
    for (const NormalSlopes& f : field)
      for (const float slope : f.slope)
        CHECK(std::isfinite(slope));
  }
  const std::vector<Splat> stacked(100, corner.front());
  for (const NormalSlopes& f : field_of_all(stacked))
    CHECK(f.slope[0] == 0.0f);
}

TEST_CASE("normal field: only splats that are wanted, and neighbours of their own material") {
  std::vector<Splat> splats = sphere_splats(2000);
  for (std::size_t i = 0; i < splats.size(); i += 2) {
    splats[i].material = 1.0f; // every other one, its normals all alike
    splats[i].normal[0] = splats[i].normal[1] = 0.0f;
    splats[i].normal[2] = 1.0f;
  }
  const auto field = fit_normal_field(splats, [](const Splat& s) { return s.material == 0.0f; });
  for (std::size_t i = 0; i < splats.size(); ++i) {
    if (i % 2 == 0)
      REQUIRE(field[i].slope[0] == 0.0f);
    else // curvature 1 / R = 1 / 0.3; 10 %: neighbours a seventh of R away
      REQUIRE(field[i].slope[0] == Approx(1.0 / 0.3).epsilon(0.1));
  }
}
