/// The lists before the maths: every point reads what is linked to it, once.
#include "fmm/ref/counting_fmm.h"
#include "tests/support/exchange.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;

namespace {

/// What count_sources() must find, from the links alone.
std::vector<std::uint64_t> counted_by_hand(const ClusterTree& tree, const std::vector<Link>& links) {
  std::vector<std::uint64_t> read(tree.points.size(), 0);
  const auto give = [&](std::uint32_t receiver, std::uint32_t source) {
    const Cluster& c = tree.nodes[receiver];
    for (std::uint32_t i = c.first_point; i < c.first_point + c.count; ++i)
      read[i] += tree.nodes[source].count;
  };
  for (const Link& link : links) {
    give(link.a, link.b);
    if (link.a != link.b) give(link.b, link.a);
  }
  return read;
}

} // namespace

TEST_CASE("unit charges through the lists: every point reads all points") {
  for (const auto& splats : {inside_sphere(3000), inside_cube(20), facing_sheets(30), mixed_splats()})
    for (const double direct_below : {0.0, 1.5, 1e9}) {
      const ClusterTree tree = build_clusters(splats, {});
      const auto links = links_without_visibility(tree);
      const auto lists = make_interaction_lists(tree, links, 0, make_grids(tree, {}), {direct_below});
      const auto read = count_sources(tree, lists);
      CHECK(std::count(read.begin(), read.end(), splats.size()) == static_cast<long>(splats.size()));
      if (direct_below == 1e9) CHECK(lists.far.source.empty());
    }
}

TEST_CASE("unit charges through the lists: links that are missing, mid or between levels") {
  const ClusterTree tree = build_clusters(inside_cube(24), {});
  auto links = links_without_visibility(tree);
  std::mt19937 random(5);
  std::vector<Link> kept;
  for (Link link : links) {
    if (random() % 3 == 0) continue;
    if (link.kind == LinkKind::far && random() % 2 == 0) link.kind = LinkKind::mid;
    link.visible = 0.25f;
    kept.push_back(link);
  }
  const auto lists = make_interaction_lists(tree, kept, 0, make_grids(tree, {}), {});
  CHECK_FALSE(lists.mid.source.empty());
  CHECK(count_sources(tree, lists) == counted_by_hand(tree, kept));
}

TEST_CASE("a far link between splats that touch goes as point pairs") {
  // Single points have no radius, so every separation criterion takes them for well separated.
  const std::vector<Splat> splats{area_splat(0.5, 0.5, 0.5, 1, 0, 0, 1e-4), area_splat(0.51, 0.5, 0.5, -1, 0, 0, 1e-4),
                                  area_splat(0.9, 0.5, 0.5, -1, 0, 0, 1e-4)};
  ClusterOptions options;
  options.leaf_capacity = 1;
  const ClusterTree tree = build_clusters(splats, options);
  const auto lists = make_interaction_lists(tree, links_without_visibility(tree), 0, make_grids(tree, {}), {0.0});
  for (std::uint32_t k = 0; k < tree.nodes.size(); ++k)
    for (std::uint32_t e = lists.far.begin[k]; e < lists.far.begin[k + 1]; ++e)
      CHECK(std::abs(tree.nodes[k].centre[0] - tree.nodes[lists.far.source[e]].centre[0]) > 0.1f);
}

TEST_CASE("what an apply evaluates is counted from the lists") {
  const ClusterTree tree = build_clusters(inside_cube(20), {});
  const auto links = links_without_visibility(tree);
  const std::uint64_t points = tree.points.size();
  // No expansions: every point with every point, itself included.
  const ExchangeCounts pairs =
      count_exchanges(tree, make_interaction_lists(tree, links, 0, make_grids(tree, {}), {1e9}));
  CHECK(pairs.m2l == 0);
  CHECK(pairs.p2p == points * points);
  const InteractionLists lists = make_interaction_lists(tree, links, 0, make_grids(tree, {}), {});
  const ExchangeCounts counts = count_exchanges(tree, lists);
  std::uint64_t far = 0;
  for (std::uint32_t k = 0; k < tree.nodes.size(); ++k)
    for (std::uint32_t e = lists.far.begin[k]; e < lists.far.begin[k + 1]; ++e)
      far += std::uint64_t{tree.nodes[k].count} * tree.nodes[lists.far.source[e]].count;
  CHECK(counts.m2l == lists.far.source.size());
  CHECK(counts.m2l > 0);
  CHECK(counts.p2p + far == points * points);
  // One flux vector each way, which all points at the other end read.
  std::vector<Link> mid;
  for (const Link& link : links)
    if (link.kind == LinkKind::far && mid.empty()) mid.push_back({link.a, link.b, 1.0f, LinkKind::mid});
  REQUIRE_FALSE(mid.empty());
  CHECK(count_exchanges(tree, make_interaction_lists(tree, mid, 0, make_grids(tree, {}), {})).m2p ==
        tree.nodes[mid[0].a].count + tree.nodes[mid[0].b].count);
}

TEST_CASE("links that cannot be are refused") {
  const ClusterTree tree = build_clusters(inside_cube(8), {});
  const Grids grids = make_grids(tree, {});
  const auto make = [&](const Link& link) {
    const std::vector<Link> links{link};
    return make_interaction_lists(tree, links, 16, grids, {});
  };
  const auto size = static_cast<std::uint32_t>(tree.nodes.size());
  CHECK_THROWS_WITH(make({0, size, 1.0f, LinkKind::far}), Catch::Contains("no such cluster"));
  CHECK_THROWS_WITH(make({0, 0, 1.0f, LinkKind::near_}), Catch::Contains("only a leaf"));
  CHECK_THROWS_WITH(make({1, 2, 0.0f, LinkKind::far}), Catch::Contains("share"));
  CHECK_THROWS_WITH(make({1, 2, NAN, LinkKind::far}), Catch::Contains("share"));
  CHECK_THROWS_WITH(make({1, 2, 0.5f, LinkKind::far, 15}), Catch::Contains("shares of its points"));
  CHECK_THROWS_AS(make_grids(tree, {7, true}), std::invalid_argument);
}
