/// Light between surfaces stays on its side of thin things, and none is lost beside them: two sheets a spacing apart, a
/// lamp close below a ceiling. What is visible is known from the geometry alone.
#include "fmm/ref/direct_sum.h"
#include "host/passes/build_pools.h"
#include "host/passes/visibility.h"
#include "host/radiosity/fmm.h"
#include "host/radiosity/parts_of_faces.h"
#include "octree/vmap/pair_samples.h"
#include "tests/support/photon_scene.h"
#include "tests/support/render.h"
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

using namespace pointgi;
using namespace pointgi::test;

namespace {

const std::string head = "version = 1\n[camera]\nposition = [0.0, 0.0, 0.9]\nlook_at = [0.0, 0.0, "
                         "0.0]\n[environment]\nradiance = [1.0, 1.0, "
                         "1.0]\n[[material]]\nname = \"white\"\ntype = \"diffuse\"\nalbedo = [0.8, 0.8, 0.8]\n";

std::string inward_box(const std::string& low, const std::string& high, double spacing) {
  return "[[shape]]\ntype = \"box\"\nmaterial = \"white\"\nmin = " + low + "\nmax = " + high +
         "\ninward = true\nspacing = " + std::to_string(spacing) + "\n";
}

std::string quad(const std::string& corner, const std::string& u, const std::string& v, double spacing) {
  return "[[shape]]\ntype = \"quad\"\nmaterial = \"white\"\ncorner = " + corner + "\nedge_u = " + u +
         "\nedge_v = " + v + "\nspacing = " + std::to_string(spacing) + "\n";
}

/// A scene's points and what the device says of the segments between them.
struct Room {
  Scene scene;
  PlacedSplats placed;
  TraversalVariant variant;
  DevicePools pools;

  Room(const std::string& shapes, TraversalForm form)
      : scene(read(head + shapes)), placed(load_and_place(scene, false)), variant(plain_variant(form)),
        pools(upload_pools(session(), build_pools(placed.splats, variant, placed.clips), variant.storage)) {
    variant.clips = !placed.clips.empty();
  }
  std::vector<std::uint8_t> blocked(View<Splat> ends, View<Segment> segments) const {
    return DeviceVisibility(session(), pools, variant, ends).blocked(segments);
  }
  std::vector<std::uint32_t> parts(View<Splat> points) const {
    return parts_of_faces(points, [&](View<Splat> e, View<Segment> s) { return blocked(e, s); });
  }
  Vector3d world(const Splat& s) const { return placed.frame.to_world({s.position[0], s.position[1], s.position[2]}); }

private:
  static Scene read(const std::string& toml) {
    const TemporaryFolder folder;
    std::ofstream(folder.file("scene.toml")) << toml;
    return load_scene(folder.file("scene.toml"));
  }
};

/// A cube from -1 to 1 cut in two by two sheets that face away from each other, at z = 0.2 and `gap` behind.
std::string cut_cube(double spacing, double gap) {
  return inward_box("[-1.0, -1.0, -1.0]", "[1.0, 1.0, 1.0]", spacing) +
         quad("[1.0, -1.0, 0.2]", "[-2.0, 0.0, 0.0]", "[0.0, 2.0, 0.0]", spacing) +
         quad("[-1.0, -1.0, " + std::to_string(0.2 + gap) + "]", "[2.0, 0.0, 0.0]", "[0.0, 2.0, 0.0]", spacing);
}

/// -1: a point before the first sheet, 1: behind the second, 0: between them.
int side_of(const Room& room, const Splat& s, double gap) {
  const double z = room.world(s).z();
  if (std::abs(s.normal[2]) > 0.5f) return z < 0.2 + 0.5 * gap ? -1 : 1;
  return z < 0.2 ? -1 : z > 0.2 + gap ? 1 : 0;
}

/// Irradiance of the points from `radiosity`, one colour, over the V-map's links.
struct Exchange {
  ClusterTree tree;
  std::vector<double> irradiance, truth; ///< truth: of all pairs that `visible` lets through

  template <class Radiosity, class Visible>
  Exchange(const Room& room, View<Splat> points, const Radiosity& radiosity, const Visible& visible)
      : tree(build_clusters(points, {}, room.parts(points))) {
    DeviceVisibility oracle(session(), room.pools, room.variant, tree.points);
    LinkOptions options;
    options.epsilon = 5e-3f; // a scene's own
    const VMap map = make_links(tree, oracle, options, room.placed.splats);
    std::vector<double> b, h;
    std::vector<std::uint32_t> all;
    for (std::uint32_t i = 0; i < tree.points.size(); ++i) {
      b.insert(b.end(), 3, radiosity(tree.points[i]));
      all.push_back(i);
    }
    DeviceFmm(session(), tree, map.links, {}, map.point_shares).apply(b, LinearisationPoint::current, h);
    const auto sum = direct_sum(tree.points, b, all, [&](std::uint32_t i, std::uint32_t j) {
      return visible(tree.points[i], tree.points[j]) ? 1.0 : 0.0;
    });
    for (std::size_t i = 0; i < tree.points.size(); ++i) {
      irradiance.push_back(h[3 * i]);
      truth.push_back(sum[3 * i]);
    }
  }
};

} // namespace

TEST_CASE("points on one side of two sheets see each other, and none of the other side") {
  const double spacing = GENERATE(0.2, 0.1), gap = GENERATE(0.4, 1.0, 2.0) * spacing;
  const Room room(cut_cube(spacing, gap), GENERATE(TraversalForm::wide, TraversalForm::step));
  const std::vector<Splat>& points = room.placed.splats;
  std::vector<Segment> segments;
  for (std::uint32_t i = 0; i < points.size(); i += 3)
    for (std::uint32_t j = i + 1; j < points.size(); j += 5)
      if (face_each_other(points[i], points[j])) segments.push_back({i, j});
  const auto blocked = room.blocked(points, segments);
  std::size_t open = 0, leaks = 0, lost = 0;
  for (std::size_t k = 0; k < segments.size(); ++k) {
    const bool same = side_of(room, points[segments[k].from], gap) == side_of(room, points[segments[k].to], gap);
    open += same;
    leaks += !same && blocked[k] == 0;
    lost += same && blocked[k] != 0;
  }
  CHECK(open > 1000);
  CHECK(leaks == 0);
  CHECK(lost == 0);
}

TEST_CASE("a wall of two sheets cuts the faces that it stands on in parts") {
  const Room room(cut_cube(0.1, 0.1), TraversalForm::wide);
  const std::vector<Splat>& points = room.placed.splats;
  const auto part = room.parts(points);
  REQUIRE(part.size() == points.size());
  std::set<std::uint32_t> parts(part.begin(), part.end());
  // Four walls in three parts each, two ends and two sheets.
  CHECK(parts.size() == 16);
  std::map<std::uint32_t, std::set<int>> sides;
  for (std::size_t i = 0; i < points.size(); ++i)
    sides[part[i]].insert(side_of(room, points[i], 0.1));
  for (const auto& of_part : sides)
    CHECK(of_part.second.size() == 1);
}

TEST_CASE("light between points stays on its side of two sheets, and none is lost there") {
  const double spacing = GENERATE(0.2, 0.1), gap = GENERATE(1.0, 2.0, 4.0) * spacing;
  const Room room(cut_cube(spacing, gap), TraversalForm::wide);
  const auto side = [&](const Splat& s) { return side_of(room, s, gap); };
  // Dark behind: what clusters of both sides would mix in is seen as light lost before.
  const Exchange e(
      room, room.placed.splats, [&](const Splat& s) { return side(s) == -1 ? 1.0 : 0.0; },
      [&](const Splat& a, const Splat& b) { return side(a) == side(b); });
  double lit = 0.0, truth = 0.0, dark = 0.0;
  for (std::size_t i = 0; i < e.irradiance.size(); ++i) {
    (side(e.tree.points[i]) == -1 ? lit : dark) += e.irradiance[i];
    truth += e.truth[i];
  }
  CHECK(lit == Approx(truth).epsilon(1e-3)); // of expansions of order 3, measured 3e-4
  CHECK(dark <= 1e-6 * lit);
}

TEST_CASE("a lamp closer than a spacing below a ceiling hides what is behind it, and nothing else") {
  const double spacing = GENERATE(0.2, 0.1), gap = GENERATE(0.02, 0.1);
  const Room room(
      inward_box("[-1.0, 0.0, -1.0]", "[1.0, 2.0, 1.0]", spacing) +
          quad("[-0.5, " + std::to_string(2.0 - gap) + ", -0.5]", "[1.0, 0.0, 0.0]", "[0.0, 0.0, 1.0]", spacing),
      TraversalForm::wide);
  std::vector<Splat> walls; // the lamp reflects nothing
  const auto is_above = [&](const Splat& s) {
    const Vector3d p = room.world(s);
    return p.y() > 2.0 - 1e-4 && std::abs(p.x()) < 0.5 && std::abs(p.z()) < 0.5;
  };
  for (const Splat& s : room.placed.splats)
    if (std::abs(room.world(s).y() - (2.0 - gap)) > 1e-4) walls.push_back(s);
  const auto visible = [&](const Splat& a, const Splat& b) {
    const Vector3d p = room.world(a), q = room.world(b);
    const double t = (2.0 - gap - p.y()) / (q.y() - p.y());
    const Vector3d at = p + t * (q - p);
    return !(t > 0.0 && t < 1.0 && std::abs(at.x()) < 0.5 && std::abs(at.z()) < 0.5);
  };
  const Exchange e(
      room, walls, [&](const Splat& s) { return is_above(s) ? 0.0 : 1.0; }, visible);
  double all = 0.0, truth = 0.0, above = 0.0, truth_above = 0.0;
  for (std::size_t i = 0; i < e.irradiance.size(); ++i) {
    all += e.irradiance[i];
    truth += e.truth[i];
    if (!is_above(e.tree.points[i])) continue;
    above += e.irradiance[i];
    truth_above += e.truth[i];
  }
  // Pairs of leaves of which 16 segments are all blocked are taken as hidden: 0.6 % where a leaf is a third of the
  // lamp.
  CHECK(all == Approx(truth).epsilon(spacing == 0.2 ? 1e-2 : 2e-3));
  // A few points at the lamp's edge are what is lit there: one segment of each decides on a cluster.
  CHECK(above == Approx(truth_above).margin(2e-3 * truth));
}
