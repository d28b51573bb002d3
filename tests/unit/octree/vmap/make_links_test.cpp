#include "octree/vmap/make_links.h"
#include "octree/vmap/pair_samples.h"
#include "tests/support/rooms.h"
#include <catch2/catch.hpp>
#include <limits>
#include <map>
#include <omp.h>
#include <tuple>

using namespace pointgi;
using namespace pointgi::test;

namespace {

/// A world whose visibility is a formula.
template <typename Formula>
class Formal : public VisibilityOracle {
public:
  Formal(const ClusterTree& tree, Formula formula) : tree_(tree), formula_(formula) {}
  std::vector<std::uint8_t> blocked(View<Segment> segments) override {
    std::vector<std::uint8_t> answers;
    for (const Segment& s : segments) {
      answers.push_back(formula_(tree_.points[s.from], tree_.points[s.to]) ? 1 : 0);
      asked.push_back(s);
    }
    largest = std::max(largest, segments.size);
    return answers;
  }
  std::vector<Segment> asked;
  std::size_t largest = 0;

private:
  const ClusterTree& tree_;
  Formula formula_;
};

bool nothing_blocks(const Splat&, const Splat&) {
  return false;
}
bool all_blocks(const Splat&, const Splat&) {
  return true;
}
/// A wall without thickness at x = 0.5, of all the room but a gap at y > 0.7.
bool wall_with_gap(const Splat& a, const Splat& b) {
  const float da = a.position[0] - 0.5f, db = b.position[0] - 0.5f;
  if (da * db >= 0.0f) return false;
  return a.position[1] + (b.position[1] - a.position[1]) * da / (da - db) < 0.7f;
}

using Key = std::tuple<std::uint32_t, std::uint32_t, float, LinkKind>;

std::vector<Key> keys_of(const VMap& map) {
  std::vector<Key> keys;
  for (const Link& l : map.links)
    keys.emplace_back(l.a, l.b, l.visible, l.kind);
  return keys;
}

/// How many links each pair of points lies under, and of which kind the last is.
struct Cover {
  std::vector<std::uint8_t> links;
  std::vector<LinkKind> kind;
  std::vector<float> visible;
};

Cover cover_of(const ClusterTree& tree, const VMap& map) {
  const std::size_t n = tree.points.size();
  Cover cover{std::vector<std::uint8_t>(n * n), std::vector<LinkKind>(n * n), std::vector<float>(n * n)};
  for (const Link& l : map.links) {
    const Cluster &a = tree.nodes[l.a], &b = tree.nodes[l.b];
    for (std::size_t i = a.first_point; i < a.first_point + a.count; ++i)
      for (std::size_t j = b.first_point; j < b.first_point + b.count; ++j)
        for (const std::size_t at : {i * n + j, j * n + i}) {
          if (l.a == l.b && at == j * n + i) continue; // both orders come by themselves
          ++cover.links[at];
          cover.kind[at] = l.kind;
          cover.visible[at] = l.visible;
        }
  }
  return cover;
}

} // namespace

TEST_CASE("in the open every two points that face each other lie under one link, far ones without clamps") {
  const auto splats = room_splats(900);
  const ClusterTree tree = build_clusters(splats, {});
  LinkOptions options;
  options.epsilon = GENERATE(0.0f, 1e-2f);
  Formal oracle(tree, nothing_blocks);
  const VMap map = make_links(tree, oracle, options);
  const Cover cover = cover_of(tree, map);
  const std::size_t n = tree.points.size();
  std::size_t missing = 0, facing = 0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      if (i == j) continue;
      const std::size_t at = i * n + j;
      const bool face = face_each_other(tree.points[i], tree.points[j]);
      REQUIRE(cover.links[at] <= 1);
      if (cover.links[at] == 1) REQUIRE(cover.visible[at] == 1.0f);
      if (cover.links[at] == 1 && cover.kind[at] == LinkKind::far) REQUIRE(face);
      facing += face;
      missing += face && cover.links[at] == 0;
    }
  CHECK(facing > n * n / 4);
  // Faint pairs of which few points face each other may show none in K segments. Above epsilon nothing is missed.
  CHECK(static_cast<double>(missing) <= (options.epsilon == 0.0f ? 0.0 : 0.01 * static_cast<double>(facing)));
}

TEST_CASE("no pair of clusters is linked twice, and the statistics count what is there") {
  const ClusterTree tree = build_clusters(room_splats(2000), {});
  Formal oracle(tree, wall_with_gap);
  const VMap map = make_links(tree, oracle, {});
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> seen;
  std::uint64_t kinds[3] = {};
  for (const Link& l : map.links) {
    REQUIRE(l.a <= l.b);
    REQUIRE(++seen[{l.a, l.b}] == 1);
    REQUIRE(l.visible > 0.0f);
    REQUIRE(l.visible <= 1.0f);
    ++kinds[static_cast<int>(l.kind)];
    const bool leaves = tree.nodes[l.a].first_child == 0 && tree.nodes[l.b].first_child == 0;
    if (l.kind == LinkKind::near_) REQUIRE(leaves);
    if (l.a == l.b) REQUIRE(l.kind == LinkKind::near_);
  }
  CHECK(kinds[0] == map.statistics.far);
  CHECK(kinds[1] == map.statistics.mid);
  CHECK(kinds[2] == map.statistics.near_);
  CHECK(kinds[0] > 0);
  CHECK(kinds[1] > 0);
  CHECK(kinds[2] > 0);
  CHECK(map.statistics.rays == oracle.asked.size());
  CHECK(map.statistics.pairs_tested > map.links.size());
}

TEST_CASE("every leaf is linked with itself, and where all is blocked with nothing else") {
  const ClusterTree tree = build_clusters(room_splats(900), {});
  Formal oracle(tree, all_blocks);
  const VMap map = make_links(tree, oracle, {});
  std::size_t leaves = 0;
  for (const Cluster& c : tree.nodes)
    leaves += c.first_child == 0;
  CHECK(map.links.size() == leaves);
  for (const Link& l : map.links) {
    REQUIRE(l.a == l.b);
    REQUIRE(l.visible == 1.0f);
  }
}

TEST_CASE("shares follow what is blocked") {
  const ClusterTree tree = build_clusters(room_splats(1500), {});
  LinkOptions options;
  options.samples = 16;
  Formal oracle(tree, wall_with_gap);
  const VMap map = make_links(tree, oracle, options);
  // Summed over all links, the share times the facing pairs is the number of pairs that see each other.
  double by_links = 0.0, open = 0.0, certain = 0.0, wrong = 0.0;
  for (const Link& l : map.links) {
    const Cluster &a = tree.nodes[l.a], &b = tree.nodes[l.b];
    for (std::size_t i = a.first_point; i < a.first_point + a.count; ++i)
      for (std::size_t j = b.first_point; j < b.first_point + b.count; ++j) {
        const Splat &x = tree.points[i], &y = tree.points[j];
        if (!face_each_other(x, y)) continue;
        by_links += static_cast<double>(l.visible);
        certain += l.visible == 1.0f;
        wrong += l.visible == 1.0f && wall_with_gap(x, y);
      }
  }
  const std::size_t n = tree.points.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i; j < n; ++j)
      open += face_each_other(tree.points[i], tree.points[j]) && !wall_with_gap(tree.points[i], tree.points[j]);
  // A leaf's pairs with itself count from both ends; they are few, for a leaf hardly sees itself. The rest is sampling.
  CHECK(by_links == Approx(open).epsilon(0.02));
  // A pair hidden by a share h shows none of it in 16 segments with (1 - h)^16: 5 % at h = 0.17.
  CHECK(wrong < 0.02 * certain);
}

TEST_CASE("after most_rays pairs far apart are taken as they are: fewer rays, and still all pairs under one link") {
  // Every second pair is hidden, at random: divided as long as rays are left, as in foliage.
  const ClusterTree tree = build_clusters(room_splats(4000), {});
  const auto leaves = [](const Splat& a, const Splat& b) {
    const float mixed = 1e4f * (a.position[0] * b.position[0] + a.position[1] * b.position[1]);
    return mixed - std::floor(mixed) < 0.5f;
  };
  LinkOptions options;
  Formal oracle(tree, leaves);
  const VMap whole = make_links(tree, oracle, options);
  CHECK(whole.statistics.coarse_waves == 0);
  options.most_rays = whole.statistics.rays / 10;
  const VMap map = make_links(tree, oracle, options);
  CHECK(map.statistics.coarse_waves > 0);
  CHECK(map.statistics.coarse_waves < map.statistics.waves);
  CHECK(map.statistics.rays < whole.statistics.rays / 2);
  const auto exchanged = [&](const VMap& of) {
    double sum = 0.0;
    for (const Link& l : of.links)
      for (std::size_t i = tree.nodes[l.a].first_point; i < tree.nodes[l.a].first_point + tree.nodes[l.a].count; ++i)
        for (std::size_t j = tree.nodes[l.b].first_point; j < tree.nodes[l.b].first_point + tree.nodes[l.b].count; ++j)
          sum += face_each_other(tree.points[i], tree.points[j]) ? static_cast<double>(l.visible) : 0.0;
    return sum;
  };
  CHECK(exchanged(map) == Approx(exchanged(whole)).epsilon(0.02)); // shares of 8 segments, over thousands of links
  const Cover cover = cover_of(tree, map);
  CHECK(*std::max_element(cover.links.begin(), cover.links.end()) == 1);
}

TEST_CASE("the links do not depend on threads or batches, but on the seed") {
  const ClusterTree tree = build_clusters(room_splats(3000), {});
  LinkOptions options;
  options.most_rays = GENERATE(0u, 20000u); // decided between waves
  Formal oracle(tree, wall_with_gap);
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const auto one = keys_of(make_links(tree, oracle, options));
  omp_set_num_threads(3);
  const auto three = keys_of(make_links(tree, oracle, options));
  options.batch = 1;
  oracle.largest = 0;
  const auto batches = keys_of(make_links(tree, oracle, options));
  omp_set_num_threads(threads);
  CHECK(one == three);
  CHECK(one == batches);
  // A range's pairs are the least that is asked at a time; of these few ask more than 4 K.
  CHECK(oracle.largest <= 256u * 8 * options.samples);
  options.seed = 2;
  CHECK(keys_of(make_links(tree, oracle, options)) != one);
}

TEST_CASE("the thesis asks one segment a pair, between the points nearest to the centroids") {
  const ClusterTree tree = build_clusters(room_splats(900), {});
  LinkOptions options;
  options.thesis = true;
  Formal oracle(tree, wall_with_gap);
  const VMap map = make_links(tree, oracle, options);
  std::vector<bool> central(tree.points.size()); // nearest to some centroid; of two points both are
  for (const Cluster& c : tree.nodes) {
    const auto distance = [&](std::uint32_t i) {
      const Splat& s = tree.points[i];
      return std::hypot(s.position[0] - c.centre[0], s.position[1] - c.centre[1], s.position[2] - c.centre[2]);
    };
    float least = 1e9f;
    for (std::uint32_t i = c.first_point; i < c.first_point + c.count; ++i)
      least = std::min(least, distance(i));
    for (std::uint32_t i = c.first_point; i < c.first_point + c.count; ++i)
      if (distance(i) < least + 1e-6f) central[i] = true; // float, of coordinates below 1
  }
  CHECK(static_cast<std::size_t>(std::count(central.begin(), central.end(), true)) < tree.points.size() / 2);
  for (const Segment& s : oracle.asked)
    REQUIRE((central[s.from] && central[s.to]));
  for (const Link& l : map.links)
    REQUIRE(l.visible == 1.0f);
  CHECK(map.statistics.rays <= 2 * map.statistics.pairs_tested); // again at most where two leaves part
}

TEST_CASE("segments are stratified by area and face each other") {
  // One cluster of two points of very different area against one point.
  std::vector<Splat> splats{make_splat(0.30f, 0.30f, 0.1f, 0, 0, 1, 0.01f),
                            make_splat(0.31f, 0.30f, 0.1f, 0, 0, 1, 0.01f),
                            make_splat(0.30f, 0.30f, 0.9f, 0, 0, -1, 0.01f)};
  splats[0].area = 3.0f;
  splats[1].area = 1.0f;
  ClusterOptions cluster_options;
  cluster_options.leaf_capacity = 2;
  const ClusterTree tree = build_clusters(splats, cluster_options);
  const std::uint32_t below = tree.leaf_of[0], above = tree.leaf_of[2];
  REQUIRE(tree.nodes[below].count == 2);
  const PairSamples samples(tree, 5, false);
  std::vector<Segment> segments;
  CHECK(samples.stratified(below, above, 64, 0, segments) == 64);
  std::size_t large = 0;
  for (const Segment& s : segments) {
    large += tree.points[s.from].area == 3.0f;
    CHECK(s.to == tree.nodes[above].first_point);
  }
  CHECK(large >= 47); // 48 of 64 strata; one may be cut
  CHECK(large <= 49);
  splats[2].normal[2] = 1.0f; // turned away
  const ClusterTree turned = build_clusters(splats, cluster_options);
  segments.clear();
  CHECK(PairSamples(turned, 5, false).stratified(turned.leaf_of[0], turned.leaf_of[2], 64, 0, segments) == 0);
  CHECK(PairSamples(turned, 5, false).exhaustive(turned.leaf_of[0], turned.leaf_of[2], 64, segments) == 0);
  CHECK(samples.exhaustive(below, above, 64, segments) == 2);
}

TEST_CASE("links of next to nothing, and options that make no sense") {
  const std::vector<Splat> one{make_splat(0.5f, 0.5f, 0.5f, 0, 0, 1, 0.1f)};
  const ClusterTree none = build_clusters(View<Splat>(), {}), single = build_clusters(one, {});
  Formal nobody(none, nothing_blocks), oracle(single, nothing_blocks);
  CHECK(make_links(none, nobody, {}).links.empty());
  CHECK(make_links(single, oracle, {}).links.size() == 1);
  LinkOptions options;
  SECTION("no samples") {
    options.samples = 0;
  }
  SECTION("too many") {
    options.samples = 1025;
  }
  SECTION("epsilon") {
    options.epsilon = -1.0f;
  }
  SECTION("epsilon is no number") {
    options.epsilon = std::numeric_limits<float>::quiet_NaN();
  }
  SECTION("separation") {
    options.separation = 0.0f;
  }
  SECTION("separation above 1") {
    options.separation = 1.5f;
  }
  CHECK_THROWS_AS(make_links(single, oracle, options), std::invalid_argument);
}
