#include "host/cloud/knn.h"
#include "host/error.h"
#include "octree/build/cell_key.h"
#include "octree/parallel.h"
#include <algorithm>
#include <cmath>
#include <flann/algorithms/dist.h>
#include <flann/algorithms/kdtree_single_index.h>
#include <limits>
#include <string>

namespace pointgi {

namespace {

constexpr int leaf_size = 12; // sites a leaf: 8 to 16 are within 5 % of each other, building favours the larger
// Local coordinates end here: their squares still fit into float, whatever is in the file.
constexpr double farthest = 1e15;
// The Morton grid spans this many local units either side of the median; what lies beyond shares its border cells.
constexpr double grid_half = 4.0;

/// Collects the nearest sites in the caller's array, sorted by (distance, site): FLANN's own sets hold 64-bit indices
/// and allocate.
class NearestSet final : public flann::ResultSet<float> {
public:
  NearestSet(Neighbour* out, unsigned k, std::uint32_t without) : out_(out), k_(k), without_(without) {}
  bool full() const override { return count_ == k_; }
  float worstDist() const override { return worst_; }
  unsigned count() const { return count_; }
  void addPoint(float distance2, std::size_t index) override {
    const auto site = static_cast<std::uint32_t>(index);
    if (site == without_ || !(distance2 < worst_)) return;
    unsigned at = count_ < k_ ? count_++ : k_ - 1;
    for (; at > 0 &&
           (out_[at - 1].distance2 > distance2 || (out_[at - 1].distance2 == distance2 && out_[at - 1].site > site));
         --at)
      out_[at] = out_[at - 1];
    out_[at] = {site, distance2};
    if (count_ == k_) worst_ = out_[k_ - 1].distance2;
  }

private:
  Neighbour* out_;
  unsigned k_;
  unsigned count_ = 0;
  std::uint32_t without_;
  float worst_ = std::numeric_limits<float>::max();
};

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::uint64_t key_of(const Eigen::Vector3f& p) {
  CellCoordinates cell;
  for (int axis = 0; axis < 3; ++axis) {
    const double place = (static_cast<double>(p[axis]) / grid_half + 1.0) * 0.5 * (1 << MAX_AXIS_BITS);
    cell[axis] = static_cast<std::uint32_t>(std::clamp(place, 0.0, (1 << MAX_AXIS_BITS) - 1.0));
  }
  return morton_key(cell);
}

} // namespace

struct Sites::Tree {
  using Index = flann::KDTreeSingleIndex<flann::L2_3D<float>>;
  std::vector<Eigen::Vector3f> data;
  std::unique_ptr<Index> index;
};

void Sites::choose_frame(const std::vector<Eigen::Vector3d>& positions) {
  std::vector<double> values(positions.size());
  for (int axis = 0; axis < 3; ++axis) {
    std::transform(positions.begin(), positions.end(), values.begin(), [&](const auto& p) { return p[axis]; });
    centre_[axis] = median(values);
  }
  std::transform(positions.begin(), positions.end(), values.begin(), [&](const Eigen::Vector3d& p) {
    return std::min((p - centre_).cwiseAbs().maxCoeff(), std::numeric_limits<double>::max());
  });
  double spread = median(values);
  if (!(spread > 0)) spread = *std::max_element(values.begin(), values.end()); // most points in one place
  int exponent = 0;
  if (spread > 0) std::frexp(spread, &exponent);
  unit_ = std::ldexp(1.0, std::clamp(exponent, -1000, 1000)); // its inverse must be finite too
}

Eigen::Vector3d Sites::to_local(const Eigen::Vector3d& world) const {
  return ((world - centre_) / unit_).cwiseMin(farthest).cwiseMax(-farthest);
}

void Sites::sort_points(const std::vector<Eigen::Vector3d>& positions) {
  struct Keyed {
    std::uint64_t key;
    std::uint32_t point;
  };
  const std::size_t n = positions.size();
  std::vector<Keyed> order(n);
  std::vector<Eigen::Vector3f> local(n);
  parallel_ranges(n, 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      local[i] = to_local(positions[i]).cast<float>();
      order[i] = {key_of(local[i]), static_cast<std::uint32_t>(i)};
    }
  });
  std::sort(order.begin(), order.end(), [&](const Keyed& a, const Keyed& b) {
    if (a.key != b.key) return a.key < b.key;
    const Eigen::Vector3f &p = local[a.point], &q = local[b.point];
    for (int axis = 0; axis < 3; ++axis)
      if (p[axis] != q[axis]) return p[axis] < q[axis];
    return a.point < b.point;
  });
  point_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t point = order[i].point;
    point_[i] = point;
    if (i == 0 || local[point] != tree_->data.back()) {
      first_point_.push_back(static_cast<std::uint32_t>(i));
      position_.push_back(to_local(positions[point]));
      tree_->data.push_back(local[point]);
    }
  }
  first_point_.push_back(static_cast<std::uint32_t>(n));
}

Sites::Sites(const std::vector<Eigen::Vector3d>& positions) : tree_(std::make_unique<Tree>()) {
  if (positions.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw Error(ErrorKind::memory,
                "cloud of " + std::to_string(positions.size()) +
                    " points: neighbours can be searched among 2147483647 at most; thin the cloud out");
  choose_frame(positions);
  sort_points(positions);
  const flann::Matrix<float> matrix(tree_->data.front().data(), tree_->data.size(), 3);
  tree_->index = std::make_unique<Tree::Index>(matrix, flann::KDTreeSingleIndexParams(leaf_size));
  tree_->index->buildIndex();
}

Sites::~Sites() = default;

unsigned Sites::nearest(std::uint32_t site, unsigned k, Neighbour* out) const {
  k = std::min(k, size() - 1);
  if (k == 0) return 0;
  NearestSet set(out, k, site);
  tree_->index->findNeighbors(set, tree_->data[site].data(), flann::SearchParams(-1));
  return set.count();
}

unsigned Sites::nearest_to(const Eigen::Vector3d& local, unsigned k, Neighbour* out) const {
  k = std::min(k, size());
  if (k == 0) return 0;
  const Eigen::Vector3f query = local.cwiseMin(farthest).cwiseMax(-farthest).cast<float>();
  NearestSet set(out, k, std::numeric_limits<std::uint32_t>::max());
  tree_->index->findNeighbors(set, query.data(), flann::SearchParams(-1));
  return set.count();
}

} // namespace pointgi
