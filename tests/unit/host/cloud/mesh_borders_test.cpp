#include "host/cloud/complete.h"
#include "host/cloud/mesh_borders.h"
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <limits>
#include <map>
#include <set>

using namespace pointgi;
using Eigen::Vector3d;

namespace {

/// A grid of n x n cells, each two triangles, over the parallelogram from `corner`; vertices are shared within it.
void add_grid(PointCloud& mesh, const Vector3d& corner, const Vector3d& u, const Vector3d& v, int n) {
  const auto first = static_cast<std::uint32_t>(mesh.position.size());
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
      mesh.position.push_back(corner + u * i / n + v * j / n);
  const auto at = [&](int i, int j) { return first + static_cast<std::uint32_t>(j * (n + 1) + i); };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      mesh.triangle.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangle.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
}

/// Equal positions become one vertex.
PointCloud weld(const PointCloud& mesh) {
  PointCloud welded;
  std::map<std::array<double, 3>, std::uint32_t> number;
  const auto vertex = [&](std::uint32_t i) {
    const Vector3d& p = mesh.position[i];
    const auto [at, added] = number.insert({{p.x(), p.y(), p.z()}, static_cast<std::uint32_t>(welded.position.size())});
    if (added) welded.position.push_back(p);
    return at->second;
  };
  for (const auto& t : mesh.triangle)
    welded.triangle.push_back({vertex(t[0]), vertex(t[1]), vertex(t[2])});
  return welded;
}

/// The cube [0,1]^3, outwards, n cells an edge. Binary fractions: equal corners are equal.
PointCloud cube(int n) {
  PointCloud mesh;
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d u = Vector3d::Unit((axis + 1) % 3), v = Vector3d::Unit((axis + 2) % 3);
    add_grid(mesh, Vector3d::Unit(axis), u, v, n);
    add_grid(mesh, Vector3d::Zero(), v, u, n);
  }
  return weld(mesh);
}

std::size_t ends(const MeshBorders& borders, const PointCloud& mesh) {
  std::size_t count = 0;
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t)
    for (int k = 0; k < 3; ++k)
      count += borders.across(t, k) == MeshBorders::none;
  return count;
}

} // namespace

TEST_CASE("a cube's faces end at its edges, a plane's at its boundary", "[cloud][mesh_borders]") {
  const PointCloud box = cube(4);
  CHECK(ends(MeshBorders(box.position, box.triangle), box) == 2 * 12 * 4);
  PointCloud plane;
  add_grid(plane, Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitY(), 4);
  CHECK(ends(MeshBorders(plane.position, plane.triangle), plane) == 4 * 4);
}

TEST_CASE("corners in one place are one vertex, on either side of zero, too", "[cloud][mesh_borders]") {
  PointCloud plane;
  add_grid(plane, {-1, 0, 0}, Vector3d::UnitX(), Vector3d::UnitY(), 4);
  add_grid(plane, {0, 0, 0}, Vector3d::UnitX(), Vector3d::UnitY(), 4);
  for (Vector3d& p : plane.position)
    if (p.x() == 0) p.x() = &p < &plane.position[25] ? -0.0 : 0.0;
  CHECK(ends(MeshBorders(plane.position, plane.triangle), plane) == 6 * 4);
}

TEST_CASE("a face and its back are no edge of each other inside a sheet", "[cloud][mesh_borders]") {
  PointCloud sheet;
  add_grid(sheet, Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitY(), 4);
  const auto fronts = sheet.triangle;
  for (const auto& t : fronts)
    sheet.triangle.push_back({t[0], t[2], t[1]});
  const MeshBorders borders(sheet.position, sheet.triangle);
  CHECK(ends(borders, sheet) == 2 * 4 * 4);
  for (std::size_t t = 0; t < fronts.size(); ++t)
    for (int k = 0; k < 3; ++k)
      if (borders.across(t, k) != MeshBorders::none) CHECK(borders.across(t, k) < fronts.size());
}

TEST_CASE("a fold that stops in the middle of a surface is none", "[cloud][mesh_borders]") {
  PointCloud dented;
  add_grid(dented, Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitY(), 8);
  const std::size_t boundary = 4 * 8;
  dented.position[4 * 9 + 4].z() = 0.02; // 9 degrees: smooth
  CHECK(ends(MeshBorders(dented.position, dented.triangle), dented) == boundary);
  PointCloud bent; // a ridge of 77 degrees at the boundary that runs out in the middle; its sides rise by 39
  add_grid(bent, Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitY(), 8);
  for (int i = 5; i <= 8; ++i)
    bent.position[4 * 9 + i].z() = 0.025 * (i - 4);
  CHECK(ends(MeshBorders(bent.position, bent.triangle), bent) == boundary);
}

TEST_CASE("a mesh of flaps has no borders", "[cloud][mesh_borders]") {
  PointCloud box = cube(4);
  for (std::uint32_t t = 0; t < 8; ++t) { // faces that fold back on others
    box.position.push_back(box.position[box.triangle[t][2]] + Vector3d(0.01, 0.02, 0.03));
    box.triangle.push_back(
        {box.triangle[t][0], box.triangle[t][1], static_cast<std::uint32_t>(box.position.size() - 1)});
  }
  CHECK_FALSE(MeshBorders(box.position, box.triangle).any());
}

TEST_CASE("an edge's vertices become a point for each face, with its normal and the edge for a border",
          "[cloud][mesh_borders]") {
  PointCloud box = cube(8);
  const std::size_t vertices = box.size();
  box.colour.assign(vertices, Eigen::Vector3f(0.25f, 0.5f, 0.75f));
  CloudReport report;
  complete_cloud(box, {}, report);
  CHECK(vertices == 6 * 49 + 12 * 7 + 8);
  REQUIRE(box.size() == 6 * 81);
  REQUIRE(box.record.size() == box.size()); // which vertex each is
  CHECK(std::set<std::uint32_t>(box.record.begin(), box.record.end()).size() == vertices);
  CHECK(box.colour.size() == box.size());
  double area = 0;
  for (std::size_t i = 0; i < box.size(); ++i) {
    CHECK(box.normal[i].cwiseAbs().maxCoeff() == Approx(1)); // exactly a face's
    area += box.area[i];
  }
  CHECK(area == Approx(6).epsilon(1e-5)); // cells on the faces fill them
  // No disc reaches past the cube.
  std::vector<ClipStrips> clip(box.size());
  for (const ClippedPoint& clipped : box.clipped)
    clip[clipped.point] = clipped.clip;
  for (std::size_t i = 0; i < box.size(); ++i)
    for (int turn = 0; turn < 64; ++turn) {
      const Vector3d n = box.normal[i].cast<double>(), u = n.unitOrthogonal(), v = n.cross(u);
      const double angle = turn * 0.0981747704; // 2 pi / 64
      Vector3d off = box.radius[i] * (std::cos(angle) * u + std::sin(angle) * v);
      double share = 1; // of the way to the rim that is not clipped off
      for (const ClipStrips::Strip& strip : clip[i].strip) {
        const double along = off.dot(strip.axis);
        if (along > strip.high) share = std::min(share, strip.high / along);
        if (along < strip.low) share = std::min(share, strip.low / along);
      }
      const Vector3d end = box.position[i] + share * off;
      CHECK(end.minCoeff() > -1e-6);
      CHECK(end.maxCoeff() < 1 + 1e-6);
    }
}

TEST_CASE("where a boundary turns inwards, discs stay whole", "[cloud][mesh_borders]") {
  PointCloud plane; // an L
  add_grid(plane, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4);
  add_grid(plane, {1, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4);
  add_grid(plane, {0, 1, 0}, {1, 0, 0}, {0, 1, 0}, 4);
  plane = weld(plane);
  const MeshBorders borders(plane.position, plane.triangle);
  const auto around = [&](const Vector3d& place) {
    std::vector<std::uint32_t> from;
    for (std::uint32_t t = 0; t < plane.triangle.size(); ++t)
      for (const std::uint32_t corner : plane.triangle[t])
        if (plane.position[corner] == place) from.push_back(t);
    return borders.around(place, Vector3d::UnitZ(), from, 0.3);
  };
  CHECK(around({1, 1, 0}).strip[0].axis.isZero(0));     // the inner corner
  CHECK(around({0.5, 0.5, 0}).strip[0].axis.isZero(0)); // in the middle
  const ClipStrips side = around({2, 0.5, 0});
  CHECK(side.strip[0].axis.isApprox(Vector3d::UnitX()));
  CHECK(side.strip[0].high == Approx(0).margin(1e-12));
  CHECK(side.strip[1].axis.isZero(0));
  const ClipStrips corner = around({0, 0, 0});
  CHECK(corner.strip[0].axis.dot(corner.strip[1].axis) == Approx(0).margin(1e-12));
  CHECK(around({0.25, 0.5, 0}).strip[0].high == Approx(0.25)); // a row farther in
}

TEST_CASE("a border round a lip is another side's", "[cloud][mesh_borders]") {
  PointCloud lip; // up, over the top within 0.1, and down on the inside
  add_grid(lip, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}, 4);
  for (int i = 0; i < 4; ++i) {
    const double a = i * 0.7853981634, b = a + 0.7853981634; // pi / 4
    const Vector3d from(0, 0.05 - 0.05 * std::cos(a), 1 + 0.05 * std::sin(a)),
        to(0, 0.05 - 0.05 * std::cos(b), 1 + 0.05 * std::sin(b));
    add_grid(lip, i == 0 ? Vector3d(0, 0, 1) : from, {1, 0, 0}, (to - from).eval(), 4);
  }
  const MeshBorders borders(lip.position, lip.triangle);
  const std::uint32_t top = 4 * 5 + 2; // in the middle of the front's upper row
  std::vector<std::uint32_t> from;
  for (std::uint32_t t = 0; t < lip.triangle.size(); ++t)
    for (const std::uint32_t corner : lip.triangle[t])
      if (corner == top) from.push_back(t);
  REQUIRE_FALSE(from.empty());
  const ClipStrips clip = borders.around(lip.position[top], {0, -1, 0}, from, 0.2);
  for (const ClipStrips::Strip& strip : clip.strip)
    CHECK(strip.axis.z() > -0.5); // nothing ends downwards, where the front goes on
}

TEST_CASE("meshes with everything at one vertex or on one edge are read in time", "[cloud][mesh_borders]") {
  // Looking at each pair of so many would take minutes; a stuck test is a failed one.
  constexpr int many = 200'000;
  const auto fan = [](bool on_one_edge) {
    PointCloud mesh;
    mesh.position = {{0, 0, 0}, {0, 0, 1}};
    for (int i = 0; i < many; ++i) {
      const double angle = 6.283185307 * i / many;
      mesh.position.emplace_back(std::cos(angle), std::sin(angle), i % 2);
    }
    for (std::uint32_t i = 0; i + 1 < many; ++i)
      mesh.triangle.push_back({0, on_one_edge ? 1 : i + 3, i + 2});
    return mesh;
  };
  for (const bool on_one_edge : {false, true}) {
    PointCloud mesh = fan(on_one_edge);
    split_at_edges(mesh);
    CHECK(mesh.size() >= many + 2u);
    mesh.normal.assign(mesh.size(), Eigen::Vector3f::UnitZ());
    mesh.radius.assign(mesh.size(), 0.1f);
    borders_from_faces(mesh);
  }
}

TEST_CASE("triangles without an area neither split vertices nor end faces", "[cloud][mesh_borders]") {
  PointCloud plane;
  add_grid(plane, Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitY(), 4);
  const std::size_t boundary = ends(MeshBorders(plane.position, plane.triangle), plane);
  const auto nan = std::numeric_limits<double>::quiet_NaN();
  plane.position.emplace_back(nan, 0, 0);
  const auto last = static_cast<std::uint32_t>(plane.size() - 1);
  plane.triangle.push_back({6, 6, 7});    // twice one corner
  plane.triangle.push_back({6, 7, 8});    // on a line
  plane.triangle.push_back({6, 7, last}); // not a number
  plane.triangle.push_back({6, 7, 1000}); // not there
  const MeshBorders borders(plane.position, plane.triangle);
  CHECK(ends(borders, plane) == boundary + 4 * 3); // the odd ones go on nowhere
  CHECK_FALSE(borders.is_used(plane.triangle.size() - 1));
  const std::size_t before = plane.size();
  split_at_edges(plane);
  CHECK(plane.size() == before);
}

TEST_CASE("a mesh whose faces share no vertices has the area of one whose do", "[cloud][mesh_borders]") {
  const PointCloud welded = cube(4);
  PointCloud soup;
  for (const auto& t : welded.triangle) {
    const auto first = static_cast<std::uint32_t>(soup.size());
    for (const std::uint32_t corner : t)
      soup.position.push_back(welded.position[corner]);
    soup.triangle.push_back({first, first + 1, first + 2});
  }
  CloudReport report;
  complete_cloud(soup, {}, report);
  double area = 0;
  for (const float a : soup.area)
    area += a;
  CHECK(area == Approx(6).epsilon(0.01));
}
