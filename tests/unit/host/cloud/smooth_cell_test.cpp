#include "host/cloud/cell_polygon.h"
#include "host/cloud/smooth_cell.h"
#include "tests/unit/host/cloud/sampled_surfaces.h"
#include <algorithm>
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;
using Eigen::Vector3d;

namespace {

struct Neighbourhood {
  std::array<Vector3d, SmoothCell::neighbours> e, normal; ///< in spacings, nearest first
  double known() const { return e.back().norm(); }
};

/// Places about the origin of a bowl of this curvature; `noise` turns normals by about as many radians.
Neighbourhood bowl(std::mt19937_64& random, double curvature, double noise) {
  std::vector<Vector3d> places;
  while (places.size() < SmoothCell::neighbours) {
    const Vector3d p(uniform(random, -2.6, 2.6), uniform(random, -2.6, 2.6), 0);
    const bool crowded =
        std::any_of(places.begin(), places.end(), [&](const Vector3d& q) { return (p - q).norm() < 0.6; });
    if (p.norm() > 0.6 && p.norm() < 2.6 && !crowded) places.push_back(p);
  }
  std::sort(places.begin(), places.end(), [](const auto& a, const auto& b) { return a.norm() < b.norm(); });
  Neighbourhood result;
  for (unsigned j = 0; j < SmoothCell::neighbours; ++j) {
    result.e[j] = places[j] + Vector3d(0, 0, 0.5 * curvature * places[j].squaredNorm());
    Vector3d normal(-curvature * places[j].x(), -curvature * places[j].y(), 1);
    for (int a = 0; a < 3; ++a)
      normal[a] += uniform(random, -noise, noise);
    result.normal[j] = normal.normalized();
  }
  return result;
}

std::optional<SmoothCell::Cell> by_lanes(const TangentFrame& frame, const Neighbourhood& of, SmoothCell& cell) {
  for (unsigned j = 0; j < SmoothCell::neighbours; ++j)
    cell.set(j, of.e[j].cast<float>(), of.normal[j].cast<float>());
  return cell.find(frame, of.known());
}

CellPolygon by_polygon(const TangentFrame& frame, const Neighbourhood& of) {
  CellPolygon polygon(of.known());
  for (unsigned j = 0; j < SmoothCell::neighbours; ++j)
    if (Eigen::Vector2d offset; unfold(frame, of.normal[j], of.e[j], 1.0, offset)) polygon.cut(offset);
  return polygon;
}

} // namespace

TEST_CASE("cells by arithmetic are those cut by one neighbour after the other", "[cloud]") {
  std::mt19937_64 random(21);
  const double curvature = GENERATE(0.0, 0.05, -0.1), noise = GENERATE(0.0, 0.1);
  SmoothCell cell;
  int found = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const Neighbourhood of = bowl(random, curvature, noise);
    const TangentFrame frame(Vector3d(uniform(random, -0.1, 0.1), uniform(random, -0.1, 0.1), 1).normalized());
    const CellPolygon truth = by_polygon(frame, of);
    const auto by = by_lanes(frame, of, cell);
    const double reach = std::sqrt(truth.reach2());
    // A cell that ends just where `known` does may be seen either way.
    if (!by) {
      CHECK((truth.open() || 2.0 * reach > 0.9999 * of.known()));
      continue;
    }
    ++found;
    REQUIRE_FALSE(truth.open());
    // Floats of order 1, some ten roundings of 6e-8 and a division by the sine between two bisectors.
    CHECK(by->area == Approx(truth.area()).epsilon(1e-4));
    CHECK(by->reach == Approx(reach).epsilon(1e-4));
  }
  CHECK(found > 100);
}

TEST_CASE("cells on a grid, whose bisectors are parallel or meet in one point", "[cloud]") {
  Neighbourhood of;
  std::vector<Vector3d> places;
  for (int x = -2; x <= 2; ++x)
    for (int y = -2; y <= 2; ++y)
      if ((x != 0 || y != 0) && !(std::abs(x) == 2 && std::abs(y) == 2)) places.emplace_back(x, y, 0);
  REQUIRE(places.size() == SmoothCell::neighbours);
  std::stable_sort(places.begin(), places.end(), [](const auto& a, const auto& b) { return a.norm() < b.norm(); });
  std::copy(places.begin(), places.end(), of.e.begin());
  of.normal.fill(Vector3d::UnitZ());
  SmoothCell cell;
  const auto by = by_lanes(TangentFrame(Vector3d::UnitZ()), of, cell);
  REQUIRE(by);
  CHECK(by->area == Approx(1.0).epsilon(1e-6));
  CHECK(by->reach == Approx(std::sqrt(0.5)).epsilon(1e-6));
  CHECK(cell.cosine() == 1.0);
}

TEST_CASE("an edge that the cell meets is left to who looks at neighbours one by one, one farther off is not",
          "[cloud]") {
  std::mt19937_64 random(22);
  Neighbourhood of = bowl(random, 0.0, 0.0);
  SmoothCell cell;
  const TangentFrame frame(Vector3d::UnitZ());
  const auto whole = by_lanes(frame, of, cell);
  REQUIRE(whole);
  of.normal.back() = Vector3d::UnitX();
  const auto with_far_edge = by_lanes(frame, of, cell);
  REQUIRE(with_far_edge);
  CHECK(with_far_edge->area == whole->area);
  of.normal.front() = Vector3d::UnitX();
  CHECK_FALSE(by_lanes(frame, of, cell));
}
