#include "octree/ref/segment_blocked.h"
#include "octree/vmap/facing.h"
#include "octree/vmap/pair_samples.h"
#include "octree/vmap/shafts.h"
#include <catch2/catch.hpp>
#include <map>

using namespace pointgi;

namespace {

/// A square of flat splats at height y that looks up or down; cells of `step`.
void add_square(std::vector<Splat>& splats, float y, float up, float low, float high, float step) {
  for (float x = low + step / 2; x < high; x += step)
    for (float z = low + step / 2; z < high; z += step)
      splats.push_back({{x, y, z}, 0.75f * step, {0, up, 0}, FLAT, {0.5f, 0.5f, 0.5f}, step * step});
}

/// Whether any pair of points of the two clusters that face each other is hidden, by a scan of all discs.
bool hides_any(const ClusterTree& tree, View<Splat> splats, const Cluster& a, const Cluster& b) {
  for (std::uint32_t i = a.first_point; i < a.first_point + a.count; ++i)
    for (std::uint32_t j = b.first_point; j < b.first_point + b.count; ++j)
      if (face_each_other(tree.points[i], tree.points[j]) && segment_blocked(splats, tree.points[i], tree.points[j]))
        return true;
  return false;
}

} // namespace

TEST_CASE("between clusters that are proved open nothing is hidden, and most that are open are proved so") {
  std::vector<Splat> splats;
  add_square(splats, 0.3f, 1.0f, 0.2f, 0.8f, 0.04f);  // floor
  add_square(splats, 0.7f, -1.0f, 0.2f, 0.8f, 0.04f); // ceiling
  const float below = GENERATE(0.005f, 0.02f, 0.1f);
  add_square(splats, 0.7f - below, -1.0f, 0.42f, 0.58f, 0.04f); // a lamp

  const ClusterTree tree = build_clusters(splats, {});
  const Shafts shafts(splats);
  std::map<Obstacles, int> open, hidden;
  for (std::size_t a = 0; a < tree.nodes.size(); ++a)
    for (std::size_t b = a + 1; b < tree.nodes.size(); ++b) {
      const Cluster &x = tree.nodes[a], &y = tree.nodes[b];
      if (x.count > 64 || y.count > 64 || facing(x, y) == Facing::none || facing(y, x) == Facing::none) continue;
      ++(hides_any(tree, splats, x, y) ? hidden : open)[shafts.between(x, y)];
    }
  CAPTURE(open[Obstacles::none], open[Obstacles::own], open[Obstacles::some]);
  CHECK(hidden[Obstacles::none] == 0);
  CHECK(hidden[Obstacles::own] == 0);
  CHECK(hidden[Obstacles::some] > 0);
  CHECK(open[Obstacles::none] > 2 * open[Obstacles::some]);
}
