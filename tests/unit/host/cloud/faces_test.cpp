#include "host/cloud/faces.h"
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

using namespace pointgi;
using Eigen::Vector3d;

namespace {

constexpr double pi = 3.14159265358979323846;

/// A surface about the point at hand, on a jittered grid of spacing 1; the nearest 65 of its points, the own one first.
template <class Surface>
std::vector<NearPoint> sample(const Surface& surface, double noise, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> jitter(-0.3, 0.3);
  std::normal_distribution<double> off(0.0, noise);
  std::vector<NearPoint> points;
  for (int i = -8; i <= 8; ++i)
    for (int j = -8; j <= 8; ++j) {
      NearPoint p = surface(i + jitter(random), j + jitter(random));
      if (noise > 0) p.offset += off(random) * p.normal;
      points.push_back(p);
    }
  const auto nearer = [](const NearPoint& a, const NearPoint& b) {
    return a.offset.squaredNorm() < b.offset.squaredNorm();
  };
  std::sort(points.begin(), points.end(), nearer);
  const Vector3d own = points[0].offset;
  for (NearPoint& p : points)
    p.offset -= own;
  std::sort(points.begin(), points.end(), nearer);
  points.resize(face_neighbours + 1);
  return points;
}

/// Two planes that meet in the y axis, turned by `angle` from the one to the other; negative: an inner edge.
auto wedge(double angle) {
  return [angle](double along, double y) {
    const double tilt = (along < 0 ? 0.5 : -0.5) * angle; // of the plane against the horizontal
    return NearPoint{{along * std::cos(tilt), y, along * std::sin(tilt)}, {-std::sin(tilt), 0, std::cos(tilt)}};
  };
}

/// A cylinder about the y axis, its highest line through the origin.
auto cylinder(double radius) {
  return [radius](double along, double y) {
    const Vector3d normal(std::sin(along / radius), 0, std::cos(along / radius));
    return NearPoint{{radius * normal.x(), y, radius * (normal.z() - 1)}, normal};
  };
}

Faces find(const std::vector<NearPoint>& near, bool given = false) {
  return find_faces(near.data(), static_cast<unsigned>(near.size()), near[0].normal, given);
}

} // namespace

TEST_CASE("two planes are found beside an edge, exactly and through noise", "[cloud][faces]") {
  for (const double angle : {0.75, 1.0, pi / 2})
    for (const double noise : {0.0, 0.2})
      for (unsigned seed = 0; seed < 8; ++seed) {
        if (angle < 1.0 && noise > 0) continue; // 43 degrees may read as less than the 40 that an edge takes
        CAPTURE(angle, noise, seed);
        const Faces faces = find(sample(wedge(angle), noise, seed));
        REQUIRE(faces.count == 2);
        const double turned = std::acos(faces.plane[0].normal.dot(faces.plane[1].normal));
        // A plane through thirty points with noise of a fifth: 0.2 / sqrt(30) over an extent of 2 is a degree.
        CHECK(turned == Approx(angle).margin(noise > 0 ? 0.1 : 1e-6));
        CHECK(std::abs(faces.plane[0].height) < (noise > 0 ? 0.6 : 1e-6)); // the point's own noise, at three sigmas
        CHECK(faces.plane[1].sticks_out);
      }
}

TEST_CASE("an inner edge does not stick out", "[cloud][faces]") {
  const Faces faces = find(sample(wedge(-pi / 2), 0.0, 1));
  REQUIRE(faces.count == 2);
  CHECK_FALSE(faces.plane[1].sticks_out);
}

TEST_CASE("three planes are found at the corner of a box", "[cloud][faces]") {
  std::vector<NearPoint> near;
  for (int face = 0; face < 3; ++face)
    for (int i = 0; i < 5; ++i)
      for (int j = 0; j < 5; ++j) {
        Vector3d p = Vector3d::Zero(), n = Vector3d::Zero();
        p[(face + 1) % 3] = -0.5 - i;
        p[(face + 2) % 3] = -0.5 - j;
        n[face] = 1;
        near.push_back({p, n});
      }
  const Vector3d own = near[0].offset;
  for (NearPoint& p : near)
    p.offset -= own;
  const Faces faces = find(near, true);
  REQUIRE(faces.count == 3);
  CHECK(faces.plane[0].normal.x() == Approx(1)); // its own
  for (unsigned k = 1; k < 3; ++k) {
    CHECK(faces.plane[k].sticks_out);
    CHECK(faces.plane[k].height == Approx(0.5)); // half a spacing to either edge
  }
}

TEST_CASE("a smooth surface has no faces", "[cloud][faces]") {
  for (const bool given : {false, true})
    for (unsigned seed = 0; seed < 8; ++seed) {
      CAPTURE(given, seed);
      CHECK(find(sample(wedge(0.0), 0.0, seed), given).count == 0);
      CHECK(find(sample(wedge(0.0), 0.2, seed), given).count == 0);
      for (const double radius : {2.5, 4.0, 6.0, 8.0, 12.0}) {
        CAPTURE(radius);
        CHECK(find(sample(cylinder(radius), 0.0, seed), given).count == 0);
      }
    }
}
