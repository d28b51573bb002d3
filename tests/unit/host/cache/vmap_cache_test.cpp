#include "host/cache/vmap_cache.h"
#include "octree/ref/segment_blocked.h"
#include "tests/support/cache_folder.h"
#include "tests/support/rooms.h"
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>

using namespace pointgi;
using namespace pointgi::test;

namespace {

struct Kept {
  std::vector<Splat> splats = room_splats(400);
  ClusterTree tree = build_clusters(splats, {});
  LinearScan oracle{tree.points, splats};
  LinkOptions options;
  VMap map;
  std::string key;

  Kept() {
    options.samples = 2;
    options.epsilon = 0.1f;
    map = make_links(tree, oracle, options, splats);
    key = vmap_key(tree, splats, options, "a linear scan");
  }
};

const Kept& kept() {
  static const Kept one;
  return one;
}

bool same(const VMap& a, const VMap& b) {
  if (a.links.size() != b.links.size() || a.statistics.rays != b.statistics.rays || a.point_shares != b.point_shares ||
      a.statistics.pairs_tested != b.statistics.pairs_tested || a.statistics.near_ != b.statistics.near_)
    return false;
  for (std::size_t i = 0; i < a.links.size(); ++i)
    if (a.links[i].a != b.links[i].a || a.links[i].b != b.links[i].b || a.links[i].visible != b.links[i].visible ||
        a.links[i].kind != b.links[i].kind || a.links[i].point_shares != b.links[i].point_shares)
      return false;
  return true;
}

void put(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

} // namespace

TEST_CASE("a V-map comes back as it was kept, and a second run asks nothing") {
  const CacheFolder cache;
  const Kept& k = kept();
  CHECK_FALSE(load_vmap(k.key, k.tree).map);
  CHECK(load_vmap(k.key, k.tree).warning.empty());
  store_vmap(k.key, k.map);
  const KeptVMap again = load_vmap(k.key, k.tree);
  REQUIRE(again.map);
  CHECK(again.warning.empty());
  CHECK(same(*again.map, k.map));

  class Silent : public VisibilityOracle {
  public:
    std::vector<std::uint8_t> blocked(View<Segment>) override { throw std::logic_error("asked"); }
  } silent;
  bool was_kept = false;
  CHECK(same(kept_or_made_links(k.tree, k.splats, silent, k.options, "a linear scan", &was_kept), k.map));
  CHECK(was_kept);
  CHECK_THROWS_AS(kept_or_made_links(k.tree, k.splats, silent, k.options, "somebody else"), std::logic_error);
}

TEST_CASE("whatever links depend on is part of the key") {
  const Kept& k = kept();
  const auto differs = [&](const ClusterTree& tree, const std::vector<Splat>& splats, const LinkOptions& options) {
    return vmap_key(tree, splats, options, "a linear scan") != k.key;
  };
  CHECK_FALSE(differs(k.tree, k.splats, k.options));
  std::vector<Splat> splats = k.splats;
  splats[7].radius *= 1.5f;
  CHECK(differs(k.tree, splats, k.options));
  CHECK(differs(build_clusters(splats, {}), k.splats, k.options));
  ClusterOptions clusters;
  clusters.leaf_capacity = 4;
  CHECK(differs(build_clusters(k.splats, clusters), k.splats, k.options));
  const auto with = [&](auto change) {
    LinkOptions options = k.options;
    change(options);
    return differs(k.tree, k.splats, options);
  };
  CHECK(with([](LinkOptions& o) { o.point_samples = 3; }));
  CHECK(with([](LinkOptions& o) { o.samples = 3; }));
  CHECK(with([](LinkOptions& o) { o.epsilon = std::nextafter(o.epsilon, 1.0f); }));
  CHECK(with([](LinkOptions& o) { o.separation = 0.5f; }));
  CHECK(with([](LinkOptions& o) { o.seed = 9; }));
  CHECK(with([](LinkOptions& o) { o.thesis = true; }));
  CHECK(with([](LinkOptions& o) { o.most_rays = 1000; }));
  CHECK_FALSE(with([](LinkOptions& o) { o.batch = 77; }));
  CHECK(vmap_key(k.tree, k.splats, k.options, "another device") != k.key);
}

TEST_CASE("a kept V-map that is cut short or damaged anywhere is not used, and made again") {
  const CacheFolder cache;
  const Kept& k = kept();
  store_vmap(k.key, k.map);
  const std::string path = vmap_file(k.key), whole = contents(path);
  REQUIRE(whole.size() == 112 + k.key.size() + 20 * k.map.links.size() + k.map.point_shares.size());
  std::size_t trusted = 0, silent = 0;
  const auto look = [&](const std::string& bytes) {
    put(path, bytes);
    const KeptVMap found = load_vmap(k.key, k.tree);
    trusted += found.map.has_value();
    silent += found.warning.empty();
  };
  for (std::size_t size = 0; size < whole.size(); size += size < 400 ? 1 : 997)
    look(whole.substr(0, size));
  look(whole + "x");
  for (std::size_t at = 0; at < whole.size(); at += at < 400 ? 1 : 991) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
    look(damaged);
  }
  CHECK(trusted == 0);
  CHECK(silent == 0);

  LinearScan oracle(k.tree.points, k.splats);
  bool was_kept = true;
  CHECK(same(kept_or_made_links(k.tree, k.splats, oracle, k.options, "a linear scan", &was_kept), k.map));
  CHECK_FALSE(was_kept);
  CHECK(contents(path) == whole); // kept again, to the byte
}

TEST_CASE("foreign files in the place of a V-map are not used") {
  const CacheFolder cache;
  const Kept& k = kept();
  const std::string other = vmap_key(k.tree, k.splats, k.options, "another device"), path = vmap_file(k.key);
  store_vmap(other, k.map);
  SECTION("the V-map of another scene") {
    put(path, contents(vmap_file(other)));
  }
  SECTION("a picture") {
    put(path, std::string(5000, '\x76'));
  }
  SECTION("a folder") {
    std::filesystem::create_directory(path);
  }
  const KeptVMap found = load_vmap(k.key, k.tree);
  CHECK_FALSE(found.map);
  CHECK_THAT(found.warning, Catch::Contains(path));
}

TEST_CASE("links that the tree cannot have are not used, however well the file is formed") {
  const CacheFolder cache;
  const Kept& k = kept();
  VMap map;
  const auto nodes = static_cast<std::uint32_t>(k.tree.nodes.size());
  SECTION("another tree's") {
    map.links = {{0, nodes, 1.0f, LinkKind::near_}};
  }
  SECTION("turned round") {
    map.links = {{2, 1, 1.0f, LinkKind::near_}};
  }
  SECTION("of no share") {
    map.links = {{1, 2, 0.0f, LinkKind::near_}};
  }
  SECTION("of no kind") {
    map.links = {{1, 2, 1.0f, static_cast<LinkKind>(9)}};
  }
  SECTION("whose points' shares are not in the file") {
    map.links = {{1, 2, 0.5f, LinkKind::near_, 1}};
    map.point_shares.resize(k.tree.nodes[1].count + k.tree.nodes[2].count);
  }
  store_vmap(k.key, map);
  CHECK_FALSE(load_vmap(k.key, k.tree).map);
}

TEST_CASE("a cache that cannot be written only means that nothing is kept") {
  const CacheFolder cache;
  const TemporaryFolder folder;
  const std::string plain = folder.write("plain", "a file where the folder should be");
  setenv("POINTGI_CACHE_DIR", plain.c_str(), 1);
  const Kept& k = kept();
  CHECK_NOTHROW(store_vmap(k.key, k.map));
  CHECK_FALSE(load_vmap(k.key, k.tree).map);
}
