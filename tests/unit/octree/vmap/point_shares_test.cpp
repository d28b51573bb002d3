#include "octree/vmap/pair_samples.h"
#include "octree/vmap/point_shares.h"
#include "tests/support/rooms.h"
#include <algorithm>
#include <catch2/catch.hpp>
#include <omp.h>

using namespace pointgi;
using namespace pointgi::test;

namespace {

/// A wall without thickness at x = 0.5, with a gap at y > 0.6.
class Wall : public VisibilityOracle {
public:
  explicit Wall(const ClusterTree& tree) : tree_(tree) {}
  static bool hides(const Splat& a, const Splat& b) {
    const float da = a.position[0] - 0.5f, db = b.position[0] - 0.5f;
    if (da * db >= 0.0f) return false;
    return a.position[1] + (b.position[1] - a.position[1]) * da / (da - db) < 0.6f;
  }
  std::vector<std::uint8_t> blocked(View<Segment> segments) override {
    largest = std::max(largest, segments.size);
    std::vector<std::uint8_t> answers;
    for (const Segment& s : segments)
      answers.push_back(hides(tree_.points[s.from], tree_.points[s.to]) ? 1 : 0);
    return answers;
  }
  std::size_t largest = 0;

private:
  const ClusterTree& tree_;
};

struct Scene {
  ClusterTree tree = build_clusters(room_splats(1500), {});
  Wall oracle{tree};
  std::vector<Link> links;

  Scene() {
    LinkOptions options;
    options.point_samples = 0;
    links = make_links(tree, oracle, options).links;
  }
  std::uint64_t rays = 0; ///< of the last shares
  std::vector<std::uint8_t> shares(const PointShareOptions& options) {
    rays = 0;
    return make_point_shares(tree, links, oracle, options, rays);
  }
  /// cos cos A / d^4 from j to i; 0 where they do not face each other.
  double weight(std::uint32_t i, std::uint32_t j) const {
    const Splat &x = tree.points[i], &y = tree.points[j];
    if (!face_each_other(x, y)) return 0.0;
    double at = 0.0, from = 0.0, d2 = 0.0;
    for (int k = 0; k < 3; ++k) {
      const double d = double{y.position[k]} - x.position[k];
      at += double{x.normal[k]} * d;
      from -= double{y.normal[k]} * d;
      d2 += d * d;
    }
    return at * from * double{y.area} / (d2 * d2);
  }
  /// What part of the light from all points of cluster b reaches point i; -1 where there is none.
  double exact(std::uint32_t i, std::uint32_t b) const {
    const Cluster& from = tree.nodes[b];
    double open = 0.0, all = 0.0;
    for (std::uint32_t j = from.first_point; j < from.first_point + from.count; ++j) {
      all += weight(i, j);
      if (!Wall::hides(tree.points[i], tree.points[j])) open += weight(i, j);
    }
    return all > 0.0 ? open / all : -1.0;
  }
};

} // namespace

TEST_CASE("shares of points follow what each sees, in the mean exactly") {
  Scene scene;
  PointShareOptions options;
  options.samples = GENERATE(1000u, 1u);
  const auto shares = scene.shares(options);
  double by_shares = 0.0, exact = 0.0, difference2 = 0.0, of_links2 = 0.0, points = 0.0;
  for (const Link& link : scene.links) {
    if (link.point_shares == no_point_shares) {
      REQUIRE((link.visible == 1.0f || link.a == link.b));
      continue;
    }
    const std::uint8_t* share = shares.data() + link.point_shares;
    for (const auto& [receiver, source] : {std::pair{link.a, link.b}, std::pair{link.b, link.a}}) {
      const Cluster& c = scene.tree.nodes[receiver];
      for (std::uint32_t i = c.first_point; i < c.first_point + c.count; ++i, ++share) {
        const double truth = scene.exact(i, source);
        if (truth < 0.0) continue;
        by_shares += *share / 255.0;
        exact += truth;
        difference2 += std::pow(*share / 255.0 - truth, 2);
        of_links2 += std::pow(double{link.visible} - truth, 2);
        ++points;
      }
    }
  }
  REQUIRE(points > 10000.0);
  // 1 / sqrt(n) of shares that are 0 or 1 is 1 %; of more points than 64 in a cluster only some are looked at.
  CHECK(by_shares == Approx(exact).epsilon(0.015));
  // A segment is as uncertain as visibility is, v (1 - v); near leaves, most of them here, know it of every pair.
  CHECK(difference2 / points < 0.08);
  if (options.samples == 1000) CHECK(difference2 < of_links2);
}

TEST_CASE("where a point has more links than it may ask, neighbours share answers") {
  Scene scene;
  PointShareOptions options;
  std::uint64_t near_pairs = 0, alone = 0;
  for (const Link& link : scene.links) {
    const Cluster &a = scene.tree.nodes[link.a], &b = scene.tree.nodes[link.b];
    if (link.visible == 1.0f || link.a == link.b) continue;
    if (link.kind != LinkKind::near_) alone += a.count + b.count;
    for (std::uint32_t i = a.first_point; link.kind == LinkKind::near_ && i < a.first_point + a.count; ++i)
      for (std::uint32_t j = b.first_point; j < b.first_point + b.count; ++j)
        near_pairs += face_each_other(scene.tree.points[i], scene.tree.points[j]);
  }
  options.samples = 1000;
  scene.shares(options);
  CHECK(scene.rays <= near_pairs + alone); // points that nothing faces ask nothing
  CHECK(scene.rays > near_pairs + alone / 2);
  const std::uint64_t all = scene.rays - near_pairs;
  options.samples = 1;
  scene.shares(options);
  CHECK(scene.rays - near_pairs < all / 2); // a quarter, and the ends of rows
  CHECK(scene.rays - near_pairs >= all / 5);
}

TEST_CASE("shares of points do not depend on threads or batches, but on the seed") {
  Scene scene;
  PointShareOptions options;
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const auto one = scene.shares(options);
  omp_set_num_threads(3);
  const auto three = scene.shares(options);
  options.batch = 1000;
  scene.oracle.largest = 0;
  const auto batches = scene.shares(options);
  omp_set_num_threads(threads);
  CHECK(one == three);
  CHECK(one == batches);
  CHECK(scene.oracle.largest <= 1000u + 2 * scene.tree.points.size()); // a link is asked as a whole
  options.seed = 2;
  CHECK(scene.shares(options) != one);
}

TEST_CASE("segments towards a cluster go where most light comes from, and only to points that face this one") {
  // A wall of two points, the one ten times as near, and one point before it.
  std::vector<Splat> splats{make_splat(0.5f, 0.5f, 0.10f, 0, 0, 1, 0.01f),
                            make_splat(0.5f, 0.5f, 0.12f, 0, 0, -1, 0.01f),
                            make_splat(0.7f, 0.5f, 0.12f, 0, 0, -1, 0.01f)};
  for (Splat& s : splats)
    s.area = 1e-4f;
  const ClusterTree tree = build_clusters(splats, {});
  REQUIRE(tree.nodes.size() == 1);
  const PairSamples samples(tree, 3, false);
  const auto place = [&](std::uint32_t input) {
    return static_cast<std::uint32_t>(std::find(tree.order.begin(), tree.order.end(), input) - tree.order.begin());
  };
  std::vector<Segment> segments;
  CHECK(samples.towards(place(0), 0, 32, 0, segments) == 32);
  for (const Segment& s : segments) {
    CHECK(s.from == place(0));
    CHECK(s.to == place(1)); // the other sends a hundred times less than a 32nd
  }
  segments.clear();
  CHECK(samples.towards(place(1), 0, 4, 0, segments) == 4);
  for (const Segment& s : segments)
    CHECK(s.to == place(0)); // its neighbour does not face it
}

TEST_CASE("shares of points: options that make no sense") {
  Scene scene;
  CHECK_THROWS_AS(scene.shares({0}), std::invalid_argument);
}
