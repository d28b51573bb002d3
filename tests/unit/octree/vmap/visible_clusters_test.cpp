#include "octree/ref/segment_blocked.h"
#include "octree/vmap/visible_clusters.h"
#include "tests/support/rooms.h"
#include <catch2/catch.hpp>
#include <set>

using namespace pointgi;
using namespace pointgi::test;

namespace {

bool holds(const Cluster& c, std::uint32_t point) {
  return point >= c.first_point && point < c.first_point + c.count;
}

} // namespace

TEST_CASE("the V-map answers as its list of links does") {
  const auto splats = room_splats(700);
  const ClusterTree tree = build_clusters(splats, {});
  LinearScan oracle(tree.points, splats);
  LinkOptions options;
  options.samples = 4;
  const VMap map = make_links(tree, oracle, options);
  const VisibleClusters visible(tree, map.links);
  std::size_t kinds[3] = {};
  for (std::uint32_t i = 0; i < tree.points.size(); i += 3)
    for (std::uint32_t j = 0; j < tree.points.size(); j += 5) {
      std::uint32_t truth = 0xffffffffu;
      for (std::uint32_t k = 0; k < map.links.size(); ++k) {
        const Cluster &a = tree.nodes[map.links[k].a], &b = tree.nodes[map.links[k].b];
        if ((holds(a, i) && holds(b, j)) || (holds(a, j) && holds(b, i))) truth = k;
      }
      REQUIRE(visible.link_between(i, j) == truth);
      const Sight sight = visible.sight(i, j);
      ++kinds[static_cast<int>(sight)];
      REQUIRE((sight == Sight::blocked) == (truth == 0xffffffffu));
      if (truth != 0xffffffffu) REQUIRE((sight == Sight::open) == (map.links[truth].visible == 1.0f));
    }
  CHECK(kinds[0] > 0);
  CHECK(kinds[1] > 0);
  CHECK(kinds[2] > 0);
  for (std::uint32_t n = 0; n < tree.nodes.size(); n += 7) {
    std::set<std::uint32_t> truth, here;
    for (const Link& l : map.links)
      for (const auto& [own, other] : {std::pair(l.a, l.b), std::pair(l.b, l.a)}) {
        const Cluster &c = tree.nodes[own], &mine = tree.nodes[n];
        // Nested, or one and the same: their points overlap. Clusters of a chain hold the same points.
        if (c.first_point < mine.first_point + mine.count && mine.first_point < c.first_point + c.count)
          truth.insert(other);
        if (own == n) here.insert(other);
      }
    const auto found = visible.visible_from(n);
    REQUIRE(found == std::vector<std::uint32_t>(truth.begin(), truth.end()));
    REQUIRE(visible.of(n).size == here.size());
    for (const ClusterLink& l : visible.of(n)) {
      REQUIRE(here.count(l.other) == 1);
      REQUIRE(map.links[l.link].visible == l.visible);
      REQUIRE(map.links[l.link].kind == l.kind);
    }
  }
}

TEST_CASE("links of another tree are refused") {
  const std::vector<Splat> one{make_splat(0.5f, 0.5f, 0.5f, 0, 0, 1, 0.1f)};
  const ClusterTree tree = build_clusters(one, {});
  const std::vector<Link> links{{0, 1, 1.0f, LinkKind::near_}};
  CHECK_THROWS_AS(VisibleClusters(tree, links), std::invalid_argument);
}
