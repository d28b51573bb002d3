#include "host/cloud/readers/mesh.h"
#include "host/cloud/readers/mesh_checks.h"
#include "host/cloud/readers/mesh_sample.h"
#include "host/error.h"
#include "tests/support/mesh_bytes.h"
#include "tests/support/temporary_folder.h"
#include <algorithm>
#include <assimp/mesh.h>
#include <catch2/catch.hpp>
#include <numeric>

using namespace pointgi;
using Catch::Matchers::Contains;
using Eigen::Vector3d;
using Eigen::Vector3f;
using pointgi::test::TemporaryFolder;

namespace {

const std::string cube_vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n";
/// Quads wound so that their normals face out.
const std::string cube_faces = "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

/// The outward normal of the unit cube's side that `p` lies on.
Vector3f side_of_cube(const Vector3d& p) {
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(p[axis]) < 1e-9) return -Vector3f::Unit(axis);
    if (std::abs(p[axis] - 1.0) < 1e-9) return Vector3f::Unit(axis);
  }
  return Vector3f::Zero();
}

double sum_of_areas(const PointCloud& cloud) {
  return std::accumulate(cloud.area.begin(), cloud.area.end(), 0.0,
                         [](double sum, float area) { return sum + static_cast<double>(area); });
}

} // namespace

TEST_CASE("mesh: a cube becomes splats on its sides") {
  TemporaryFolder folder;
  const std::string path = folder.write("cube.obj", cube_vertices + cube_faces);
  CloudReport report;
  const double spacing = 0.05;
  const PointCloud cloud = sample_mesh(path, spacing, report);
  REQUIRE(cloud.size() > 0);
  REQUIRE(cloud.normal.size() == cloud.size());
  REQUIRE(cloud.area.size() == cloud.size());
  CHECK(cloud.radius.empty());
  CHECK(cloud.triangle.empty());
  CHECK(cloud.colour.empty()); // the file has none, and assimp's stand-in material is not taken for one
  CHECK(report.triangles == 12);
  CHECK(report.points_in_file == cloud.size());

  // 2400 wanted; the sampler promises the number to about 10 %, the edges add a little.
  CHECK(static_cast<double>(cloud.size()) == Approx(6 / (spacing * spacing)).epsilon(0.15));
  // Each area is rounded to float: 6e-8 relative.
  CHECK(sum_of_areas(cloud) == Approx(6.0).epsilon(1e-6));
  std::array<int, 6> on_side{};
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vector3f side = side_of_cube(cloud.position[i]);
    CHECK((cloud.normal[i] - side).norm() < 1e-6f); // exact but for float rounding
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (side[static_cast<int>(axis)] != 0.0f) ++on_side[2 * axis + (side[static_cast<int>(axis)] > 0.0f)];
  }
  // Every side has its share to 15 %: the sampler is even, but each side is filled on its own.
  for (const int count : on_side)
    CHECK(count == Approx(static_cast<double>(cloud.size()) / 6).epsilon(0.15));
}

TEST_CASE("mesh: points keep their distance and leave no gap") {
  // A unit square of two triangles, compared point by point (brute force).
  std::vector<MeshTriangle> square(2);
  square[0].position = {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(1, 1, 0)};
  square[1].position = {Vector3d(0, 0, 0), Vector3d(1, 1, 0), Vector3d(0, 1, 0)};
  for (MeshTriangle& t : square)
    for (std::size_t k = 0; k < 3; ++k) {
      t.normal[k].setZero();
      t.colour[k].setOnes();
    }
  const double wanted = 1000;
  const double spacing = 1.0 / std::sqrt(wanted);
  const PointCloud cloud = sample_triangles(square, wanted, true);
  CHECK(cloud.colour.size() == cloud.size());
  const auto nearest = [&cloud](const Vector3d& p, std::size_t except) {
    double best = 1e9;
    for (std::size_t j = 0; j < cloud.size(); ++j)
      if (j != except) best = std::min(best, (cloud.position[j] - p).norm());
    return best;
  };
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    CHECK(nearest(cloud.position[i], i) >= 0.78 * spacing); // what mesh.h promises
    CHECK(cloud.normal[i] == Vector3f::UnitZ());
  }
  // The covering radius of a perfect square grid is 0.71 spacings; random placing that refuses neighbours, stopped
  // after 16 tries a point, measures 0.9. Beyond 1.2 there would be a hole.
  for (int i = 0; i < 50; ++i)
    for (int j = 0; j < 50; ++j)
      CHECK(nearest(Vector3d((i + 0.5) / 50, (j + 0.5) / 50, 0), cloud.size()) < 1.2 * spacing);
}

TEST_CASE("mesh: both sides of a thin sheet get their points") {
  // Two squares 1e-6 apart that face away from each other: neither may take the other's room.
  std::vector<MeshTriangle> sheet(4);
  for (std::size_t s = 0; s < 2; ++s) {
    const double z = s == 0 ? 0.0 : -1e-6;
    const Vector3d a(0, 0, z), b(1, 0, z), c(1, 1, z), d(0, 1, z);
    sheet[2 * s].position = s == 0 ? std::array<Vector3d, 3>{a, b, c} : std::array<Vector3d, 3>{a, c, b};
    sheet[2 * s + 1].position = s == 0 ? std::array<Vector3d, 3>{a, c, d} : std::array<Vector3d, 3>{a, d, c};
  }
  for (MeshTriangle& t : sheet)
    t.normal.fill(Vector3f::Zero());
  const PointCloud cloud = sample_triangles(sheet, 1000, false);
  const auto up = std::count_if(cloud.normal.begin(), cloud.normal.end(), [](const Vector3f& n) { return n.z() > 0; });
  CHECK(static_cast<double>(up) == Approx(static_cast<double>(cloud.size()) / 2).epsilon(0.1));
  CHECK(static_cast<double>(cloud.size()) == Approx(1000).epsilon(0.15));
}

TEST_CASE("mesh: the chosen spacing gives about two hundred thousand splats") {
  TemporaryFolder folder;
  const std::string path = folder.write("cube.obj", cube_vertices + cube_faces);
  CloudReport report;
  const PointCloud cloud = sample_mesh(path, 0.0, report);
  CHECK(static_cast<double>(cloud.size()) == Approx(200e3).epsilon(0.15)); // as above
  CHECK(sum_of_areas(cloud) == Approx(6.0).epsilon(1e-6));
}

TEST_CASE("mesh: the same splats each time") {
  TemporaryFolder folder;
  const std::string path = folder.write("cube.obj", cube_vertices + cube_faces);
  CloudReport first, second;
  CHECK(sample_mesh(path, 0.05, first).position == sample_mesh(path, 0.05, second).position);
}

TEST_CASE("mesh: normals of the file are interpolated on the side of the winding") {
  TemporaryFolder folder;
  // One triangle in the plane z = 0 wound towards +z; its normals lean outwards, the last one points to the back.
  const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn -0.6 0 0.8\nvn 0.6 0 0.8\nvn 0 0 -1\nf 1//1 2//2 3//3\n";
  CloudReport report;
  const PointCloud cloud = sample_mesh(folder.write("t.obj", text), 0.02, report);
  bool leans_left = false, leans_right = false;
  for (const Vector3f& n : cloud.normal) {
    CHECK(n.norm() == Approx(1.0f).margin(1e-5)); // float rounding of a normalisation
    CHECK(n.z() >= 0.0f);
    leans_left = leans_left || n.x() < -0.4f;
    leans_right = leans_right || n.x() > 0.4f;
  }
  CHECK(leans_left);
  CHECK(leans_right);
}

TEST_CASE("mesh: colours come from vertices or from materials") {
  TemporaryFolder folder;
  CloudReport report;
  folder.write("m.mtl", "newmtl red\nKd 0.8 0.1 0.2\n");
  const std::string with_material = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n";
  const PointCloud red = sample_mesh(folder.write("a.obj", with_material), 0.1, report);
  REQUIRE(red.colour.size() == red.size());
  for (const Vector3f& c : red.colour)
    CHECK((c - Vector3f(0.8f, 0.1f, 0.2f)).norm() < 1e-6f); // barycentric weights sum to 1 but for rounding

  // Red grows along x and green along y, so that the colour tells the place.
  const std::string with_colours = "v 0 0 0 0 0 0\nv 1 0 0 1 0 0\nv 0 1 0 0 1 0\nf 1 2 3\n";
  const PointCloud blend = sample_mesh(folder.write("b.obj", with_colours), 0.1, report);
  REQUIRE(blend.colour.size() == blend.size());
  for (std::size_t i = 0; i < blend.size(); ++i) {
    CHECK(static_cast<double>(blend.colour[i].x()) == Approx(blend.position[i].x()).margin(1e-6));
    CHECK(static_cast<double>(blend.colour[i].y()) == Approx(blend.position[i].y()).margin(1e-6));
  }
}

TEST_CASE("mesh: other formats and a triangle without area") {
  TemporaryFolder folder;
  CloudReport report;
  const std::string off = "OFF\n4 2 0\n0 0 0\n2 0 0\n0 2 0\n4 0 0\n3 0 1 2\n3 0 1 3\n";
  const PointCloud cloud = sample_mesh(folder.write("a.off", off), 0.1, report);
  CHECK(sum_of_areas(cloud) == Approx(2.0).epsilon(1e-6)); // the second triangle is a line
  CHECK_THAT(report.format, Contains("OFF"));
  REQUIRE(report.warnings.size() == 1);
  CHECK_THAT(report.warnings[0], Contains("1 triangles have no area"));
}

TEST_CASE("mesh: a spacing larger than the mesh still gives a splat that stands for all of it") {
  TemporaryFolder folder;
  CloudReport report;
  const PointCloud cloud = sample_mesh(folder.write("cube.obj", cube_vertices + cube_faces), 100.0, report);
  CHECK(cloud.size() >= 1);
  CHECK(sum_of_areas(cloud) == Approx(6.0).epsilon(1e-6));
}

TEST_CASE("mesh: what cannot be sampled is an input error that names the file") {
  TemporaryFolder folder;
  const std::string cube = folder.write("cube.obj", cube_vertices + cube_faces);
  struct Case {
    std::string path;
    double spacing;
    std::string says;
  };
  const std::vector<Case> cases{
      {folder.file("missing.obj"), 0.1, "No such file"},
      {folder.file(""), 0.1, "folder"},
      {folder.write("points.obj", cube_vertices), 0.1, ""},
      {folder.write("lines.obj", cube_vertices + "l 1 2\nl 2 3\n"), 0.1, "no triangles"},
      {folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"), 0.1, "degenerate"},
      {folder.write("empty.obj", ""), 0.1, "cannot be read as a mesh"},
      {folder.write("what.xyzzy", "hello"), 0.1, "cannot be read as a mesh"},
      {cube, -1.0, "spacing"},
      {cube, std::nan(""), "spacing"},
      {cube, 1e-9, "100 million"},
  };
  for (const Case& c : cases) {
    CloudReport report;
    try {
      sample_mesh(c.path, c.spacing, report);
      FAIL("accepted: " << c.path);
    } catch (const Error& error) {
      CHECK(error.kind() == ErrorKind::input);
      CHECK_THAT(error.what(), Contains(c.path) && Contains(c.says));
    }
  }
}

TEST_CASE("mesh: nodes place and mirror their meshes without turning them inside out") {
  // glTF: the triangle (0,0,0) (1,0,0) (0,1,0) facing +z, mirrored in x, doubled in y and moved to z = 5.
  const std::string gltf = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
    "nodes":[{"mesh":0,"scale":[-1,2,1],"translation":[0,0,5]}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
    "bufferViews":[{"buffer":0,"byteLength":36}],
    "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
  TemporaryFolder folder;
  CloudReport report;
  const PointCloud cloud = sample_mesh(folder.write("t.gltf", gltf), 0.1, report);
  CHECK(sum_of_areas(cloud) == Approx(1.0).epsilon(1e-6));
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    CHECK(cloud.normal[i] == Vector3f::UnitZ());
    CHECK(cloud.position[i].z() == 5.0);
    CHECK(cloud.position[i].x() <= 0.0);
  }
}

TEST_CASE("mesh: faces that a damaged file gets wrong do not end the program") {
  const TemporaryFolder folder;
  CloudReport report;
  const auto refused = [&](const std::string& name, const std::string& bytes, const std::string& why) {
    CHECK_THROWS_WITH(sample_mesh(folder.write(name, bytes), 0.1, report), Contains(name) && Contains(why));
  };
  const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
  CHECK(
      sample_mesh(folder.write("sound.off", "OFF # a\n#b\n4 2 6\n# c\n" + vertices + "\n3 0 2 1\n4 0 1 2 3 255 0 0\n"),
                  0.1, report)
          .size() > 0);
  refused("none.off", "OFF\n4 2 6\n" + vertices + "3 0 2 1\n0\n", "face 2 has 0 corners");
  refused("many.off", "OFF\n4 2 6\n" + vertices + "3 0 2 1\n30 0 0\n", "face 2 has 30 corners");
  refused("beyond.off", "OFF\n4 2 6\n" + vertices + "3 0 2 1\n3 0 1 4\n", "face 2 names a vertex beyond the 4");
  refused("cut.off", "OFF\n4 2 6\n" + vertices + "3 0 2 1\n3 0 1", "face 2's vertex, found \"\"");
  refused("short.off", "OFF\n4 4000000000 6\n" + vertices + "3 0 2 1\n", "1 of 4000000000 faces");
  refused("feed.off", "OFF\n4 1 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\f*\f0\n3 0 2 1\n", "control characters");
  refused("nameless.off", "1\n3 0\n4 4 1\n0\n0\n0\n0", "expected OFF");
}

TEST_CASE("mesh: a glTF whose lines or fans name no vertex does not end the program, sound ones are read") {
  const TemporaryFolder folder;
  CloudReport report;
  // Four vertices, the corners of a tetrahedron, and the indices 0 2 1 0 1 3.
  const auto gltf = [](const std::string& attribute, int mode) {
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
      "meshes":[{"primitives":[{"attributes":{")" +
           attribute + R"(":0},"indices":1,"mode": )" + std::to_string(mode) + R"(},
        {"attributes":{"POSITION":0},"indices":1,"mode":4}]}],
      "accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,1]},
        {"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"}],
      "bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":12}],
      "buffers":[{"byteLength":60,"uri":"data:application/octet-stream;base64,)" +
           "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAACAAEAAAABAAMA" + R"("}]})";
  };
  for (const int mode : {2, 3, 4, 6}) {
    CAPTURE(mode);
    CHECK(sample_mesh(folder.write("sound.gltf", gltf("POSITION", mode)), 0.1, report).size() > 0);
    if (mode == 4) continue;
    CHECK_THROWS_WITH(sample_mesh(folder.write("x.gltf", gltf("YOSITION", mode)), 0.1, report),
                      Contains("x.gltf: cannot be read as a mesh"));
  }
}

TEST_CASE("mesh: faces whose corners do not exist are refused before they are cut up, faces without corners are none") {
  aiMesh mesh;
  mesh.mNumVertices = 4;
  mesh.mNumFaces = 2;
  mesh.mFaces = new aiFace[2];
  mesh.mFaces[0].mNumIndices = 3;
  mesh.mFaces[0].mIndices = new unsigned[3]{0, 1, 3};
  mesh.mPrimitiveTypes = aiPrimitiveType_TRIANGLE | aiPrimitiveType_POLYGON;
  prepare_to_cut(mesh, "a.obj");
  CHECK(mesh.mPrimitiveTypes == aiPrimitiveType_TRIANGLE); // Assimp ends the program where no polygon is among polygons
  mesh.mFaces[0].mIndices[2] = 4;
  CHECK_THROWS_WITH(prepare_to_cut(mesh, "a.obj"), Contains("a.obj") && Contains("face 1 names vertex 4 of 4"));
}

TEST_CASE("mesh: a binary glTF whose chunk is longer than the file asks for no memory") {
  const TemporaryFolder folder;
  CloudReport report;
  const std::string glb = test::glb_seed();
  CHECK(sample_mesh(folder.write("sound.glb", glb), 0.1, report).size() > 0);
  std::string damaged = glb;
  damaged.replace(12, 4, "\xf5\xff\xfb\xff");
  CHECK_THROWS_WITH(sample_mesh(folder.write("damaged.glb", damaged), 0.1, report),
                    Contains("damaged.glb") && Contains("byte 12 promises a chunk of 4294705141 bytes"));
  for (const std::string& bytes : {std::string(), std::string("g"), "g\x02" + glb.substr(2)})
    CHECK_THROWS_WITH(sample_mesh(folder.write("no.glb", bytes), 0.1, report),
                      Contains("no.glb") && Contains("expected glTF"));
}

TEST_CASE("mesh: parts whose distance is no number of spacings that fits into an integer get their points") {
  MeshTriangle near_one, far_one;
  near_one.position = {Vector3d(0, 0, 0), Vector3d(0, 1, 0), Vector3d(0, 0, 1)};
  far_one.position = {Vector3d(1e30, 0, 0), Vector3d(1e30, 1, 0), Vector3d(1e30, 0, 1)};
  for (MeshTriangle* triangle : {&near_one, &far_one})
    triangle->normal.fill(Vector3f::Zero());
  const PointCloud cloud = sample_triangles({near_one, far_one}, 200.0, false);
  const auto far_points =
      std::count_if(cloud.position.begin(), cloud.position.end(), [](const Vector3d& p) { return p.x() > 0.0; });
  CHECK(far_points > 50);
  CHECK(static_cast<std::ptrdiff_t>(cloud.size()) - far_points > 50);
}
