/// The way from a cloud to the octree's pools, phase by phase, and nearest neighbours against plain FLANN: the same
/// points and k, A B A B, distances compared; ends with 1 where they differ.
///   bench_cloud [POINTS [PAIRS]]
#include "host/cloud/knn.h"
#include "host/cloud/splat_size.h"
#include "host/scene/frame.h"
#include "host/scene/merge_coincident.h"
#include "host/scene/splats.h"
#include "octree/pack/wide_pools.h"
#include "octree/parallel.h"
#include "tests/bench/synthetic_blob.h"
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <flann/algorithms/dist.h>
#include <flann/algorithms/kdtree_single_index.h>
#include <numeric>
#include <random>

using namespace pointgi;

namespace {

constexpr std::size_t grain = 1024;
constexpr int flann_leaf = 12;
constexpr unsigned wide_leaf = 64, wide_lanes = 8; // the default of CPU devices

struct Seconds {
  double wall = 0, processor = 0;
};

double processor_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

template <class Work>
Seconds seconds_of(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  const double processor = processor_seconds();
  work();
  return {std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
          processor_seconds() - processor};
}

template <class Work>
void phase(const char* name, const Work& work) {
  const Seconds s = seconds_of(work);
  std::printf("  %-28s %8.3f s, %8.3f s of processors\n", name, s.wall, s.processor);
  std::fflush(stdout);
}

/// As scanners have them: near in the file is near in space, but not in order.
PointCloud scanned(std::size_t count) {
  PointCloud cloud = bench::synthetic_blob(count);
  std::mt19937_64 random(5);
  constexpr std::size_t window = 2000;
  for (std::size_t begin = 0; begin + window <= cloud.size(); begin += window)
    for (std::size_t i = window - 1; i > 0; --i) {
      const std::size_t a = begin + i, b = begin + random() % (i + 1);
      std::swap(cloud.position[a], cloud.position[b]);
      std::swap(cloud.normal[a], cloud.normal[b]);
    }
  return cloud;
}

void phases(const PointCloud& from) {
  WorldSplats world;
  world.cloud = from;
  world.material.assign(from.size(), 0);
  std::unique_ptr<Sites> sites;
  SiteSpacing spacing;
  phase("sites", [&] { sites = std::make_unique<Sites>(from.position); });
  phase("neighbours", [&] { sites->keep_neighbours(20); });
  phase("spacings", [&] {
    std::vector<float> distances = spacings_of(*sites);
    rein_in_isolated(*sites, distances);
    spacing = with_normals(*sites, from.normal, std::move(distances));
  });
  phase("sizes", [&] {
    SplatSizes sizes = splat_sizes(*sites, from.normal, spacing, true, true);
    world.cloud.radius = std::move(sizes.radius);
    world.cloud.area = std::move(sizes.area);
  });
  sites.reset();
  Frame frame;
  std::vector<Splat> placed;
  std::vector<std::uint32_t> id(from.size());
  std::iota(id.begin(), id.end(), 0u);
  phase("frame", [&] { frame = frame_of(world.cloud); });
  phase("place", [&] { placed = place_in_cube(world, frame); });
  phase("merge", [&] { merge_coincident(placed, id); });
  Tree tree;
  TreeOptions options;
  options.listing = Listing::centres;
  options.leaf_capacity = wide_leaf;
  phase("tree", [&] { tree = build_tree(placed, options); });
  phase("pools", [&] { pack_wide(placed, tree, wide_lanes); });
}

/// FLANN's answers in the form of ours.
class FlannSet final : public flann::ResultSet<float> {
public:
  FlannSet(float* out, unsigned k, std::size_t without) : out_(out), k_(k), without_(without) {}
  bool full() const override { return count_ == k_; }
  float worstDist() const override { return worst_; }
  void addPoint(float distance2, std::size_t index) override {
    if (index == without_ || !(distance2 < worst_)) return;
    unsigned at = count_ < k_ ? count_++ : k_ - 1;
    for (; at > 0 && out_[at - 1] > distance2; --at)
      out_[at] = out_[at - 1];
    out_[at] = distance2;
    if (count_ == k_) worst_ = out_[k_ - 1];
  }

private:
  float* out_;
  unsigned k_, count_ = 0;
  std::size_t without_;
  float worst_ = std::numeric_limits<float>::max();
};

/// Returns how many k-th distances differ. Sites are FLANN's points too, in the same order: it has the same locality.
std::size_t compare(const Sites& sites, unsigned k, int pairs) {
  std::vector<float> points;
  for (std::uint32_t s = 0; s < sites.size(); ++s)
    for (int a = 0; a < 3; ++a)
      points.push_back(static_cast<float>(sites.position(s)[a]));
  flann::KDTreeSingleIndex<flann::L2_3D<float>> index(flann::Matrix<float>(points.data(), sites.size(), 3),
                                                      flann::KDTreeSingleIndexParams(flann_leaf));
  const Seconds build = seconds_of([&] { index.buildIndex(); });
  std::vector<float> ours(sites.size()), theirs(sites.size());
  std::vector<double> ratios;
  for (int pair = 0; pair < pairs; ++pair) {
    const Seconds a = seconds_of([&] {
      parallel_ranges(sites.size(), grain, [&](std::size_t begin, std::size_t end) {
        std::vector<Neighbour> near(k);
        for (std::size_t s = begin; s < end; ++s)
          ours[s] = near[sites.nearest(static_cast<std::uint32_t>(s), k, near.data()) - 1].distance2;
      });
    });
    const Seconds b = seconds_of([&] {
      parallel_ranges(sites.size(), grain, [&](std::size_t begin, std::size_t end) {
        std::vector<float> near(k);
        for (std::size_t s = begin; s < end; ++s) {
          FlannSet set(near.data(), k, s);
          index.findNeighbors(set, &points[3 * s], flann::SearchParams(-1));
          theirs[s] = near[k - 1];
        }
      });
    });
    ratios.push_back(a.processor / b.processor);
    std::printf("  k = %-3u ours %7.3f s, FLANN %7.3f s and %.3f s to build (of processors)\n", k, a.processor,
                b.processor, build.processor);
  }
  std::sort(ratios.begin(), ratios.end());
  std::printf("  k = %-3u ratio %.3f\n", k, ratios[ratios.size() / 2]);
  std::size_t different = 0;
  for (std::size_t s = 0; s < ours.size(); ++s)
    different += ours[s] == theirs[s] ? 0u : 1u;
  return different;
}

} // namespace

int main(int count, char** words) {
  const std::size_t points = count > 1 ? std::strtoull(words[1], nullptr, 10) : 1'000'000;
  const int pairs = count > 2 ? std::atoi(words[2]) : 3;
  const PointCloud cloud = scanned(points);
  std::printf("%zu points\n", cloud.size());
  phases(cloud);
  const Sites sites(cloud.position);
  std::size_t different = 0;
  for (const unsigned k : {6u, 20u})
    different += compare(sites, k, pairs);
  if (different > 0) std::printf("%zu answers differ\n", different);
  return different == 0 ? 0 : 1;
}
