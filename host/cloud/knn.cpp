#include "host/cloud/knn.h"
#include "host/cloud/leaf_search.h"
#include "host/cloud/quantile.h"
#include "host/error.h"
#include "octree/build/cell_key.h"
#include "octree/parallel.h"
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace pointgi {

namespace {

// Local coordinates end here: their squares still fit into float, whatever is in the file.
constexpr double farthest = 1e15;
// Half of the curve's cells along an axis lie within this many local units of the median; outwards they grow.
constexpr double inner_half = 4.0;
constexpr std::uint64_t same_site = std::uint64_t{1}
                                    << 63; // of a sorted key: the point shares the site of the one before
constexpr std::uint32_t no_site = std::numeric_limits<std::uint32_t>::max();

std::uint64_t key_of(const SitePlace& p) {
  CellCoordinates cell;
  for (int axis = 0; axis < 3; ++axis) {
    const auto x = static_cast<double>(p[axis]);
    const double place = (x / (std::fabs(x) + inner_half) + 1.0) * 0.5 * (1 << MAX_AXIS_BITS);
    cell[axis] = static_cast<std::uint32_t>(std::clamp(place, 0.0, (1 << MAX_AXIS_BITS) - 1.0));
  }
  return morton_key(cell);
}

SitePlace rounded(const Eigen::Vector3d& local) {
  return {static_cast<float>(local[0]), static_cast<float>(local[1]), static_cast<float>(local[2])};
}

constexpr unsigned least_kept = 3; // as many as far_list needs

std::size_t far_list(const std::int16_t* offset) {
  return static_cast<std::uint16_t>(offset[1]) | static_cast<std::size_t>(static_cast<std::uint16_t>(offset[2])) << 16;
}
void set_far_list(std::int16_t* offset, std::size_t list) {
  offset[0] = 0;
  offset[1] = static_cast<std::int16_t>(list & 0xffffu);
  offset[2] = static_cast<std::int16_t>(list >> 16 & 0xffffu);
}

} // namespace

void Sites::choose_frame(const std::vector<Eigen::Vector3d>& positions) {
  const std::size_t n = positions.size();
  const auto medians =
      values_at_ranks(n, std::array<std::size_t, 3>{n / 2, n / 2, n / 2},
                      [&](std::size_t i, std::size_t axis) { return positions[i][static_cast<Eigen::Index>(axis)]; });
  centre_ = Eigen::Vector3d::Map(medians.data());
  const auto distance = [&](std::size_t i) {
    return std::min((positions[i] - centre_).cwiseAbs().maxCoeff(), std::numeric_limits<double>::max());
  };
  double spread = value_at_rank(n, n / 2, distance);
  if (!(spread > 0)) spread = value_at_rank(n, n - 1, distance); // most points in one place
  int exponent = 0;
  if (spread > 0) std::frexp(spread, &exponent);
  unit_ = std::ldexp(1.0, std::clamp(exponent, -1000, 1000)); // its inverse must be finite too
}

Eigen::Vector3d Sites::to_local(const Eigen::Vector3d& world) const {
  return ((world - centre_) / unit_).cwiseMin(farthest).cwiseMax(-farthest);
}

/// The points along the curve, those at one place together and ascending; their keys say who shares a site.
Pool<KeyedIndex> Sites::sorted_points(const std::vector<Eigen::Vector3d>& positions) const {
  constexpr std::size_t grain = 1 << 14;
  const auto place = [&](const KeyedIndex& item) { return rounded(to_local(positions[item.index])); };
  Pool<KeyedIndex> order(positions.size());
  parallel_ranges(order.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      order[i].index = static_cast<std::uint32_t>(i);
      order[i].key = key_of(place(order[i]));
    }
  });
  sort_by_key(order);
  const std::vector<std::size_t> cuts =
      cuts_between_keys(order.size(), grain, [&](std::size_t i) { return order[i].key; });
  parallel_ranges(cuts.size() - 1, 1, [&](std::size_t range, std::size_t) {
    for (std::size_t i = cuts[range], past; i < cuts[range + 1]; i = past) {
      for (past = i + 1; past < cuts[range + 1] && order[past].key == order[i].key;)
        ++past;
      if (past == i + 1) continue;
      std::sort(order.begin() + static_cast<std::ptrdiff_t>(i), order.begin() + static_cast<std::ptrdiff_t>(past),
                [&](const KeyedIndex& a, const KeyedIndex& b) {
                  const SitePlace p = place(a), q = place(b);
                  return p != q ? p < q : a.index < b.index;
                });
      for (std::size_t k = past; --k > i;)
        if (place(order[k]) == place(order[k - 1])) order[k].key |= same_site;
    }
  });
  return order;
}

void Sites::make_sites(const std::vector<Eigen::Vector3d>& positions, Pool<KeyedIndex>&& order) {
  constexpr std::size_t grain = 1 << 14;
  const std::size_t n = order.size();
  std::vector<std::uint32_t> first_site((n + grain - 1) / grain + 1, 0);
  parallel_ranges(n, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      first_site[begin / grain + 1] += (order[i].key & same_site) == 0 ? 1u : 0u;
  });
  for (std::size_t range = 1; range < first_site.size(); ++range)
    first_site[range] += first_site[range - 1];
  const std::uint32_t sites = first_site.back();
  point_.resize(n);
  first_point_.resize(sites + std::size_t{1});
  first_point_[sites] = static_cast<std::uint32_t>(n);
  position_.resize(sites);
  SitePlaces places(sites);
  Pool<std::uint64_t> keys(sites);
  parallel_ranges(n, grain, [&](std::size_t begin, std::size_t end) {
    std::uint32_t site = first_site[begin / grain];
    for (std::size_t i = begin; i < end; ++i) {
      point_[i] = order[i].index;
      if ((order[i].key & same_site) != 0) continue;
      const Eigen::Vector3d local = to_local(positions[order[i].index]);
      first_point_[site] = static_cast<std::uint32_t>(i);
      Eigen::Vector3d::Map(position_[site].data()) = local;
      places.set(site, rounded(local));
      keys[site++] = order[i].key;
    }
  });
  order = {};
  tree_ = std::make_unique<SiteTree>(std::move(places), keys);
}

Sites::Sites(const std::vector<Eigen::Vector3d>& positions) {
  if (positions.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw Error(ErrorKind::memory,
                "cloud of " + std::to_string(positions.size()) +
                    " points: neighbours can be searched among 2147483647 at most; thin the cloud out");
  choose_frame(positions);
  make_sites(positions, sorted_points(positions));
}

Sites::~Sites() = default;

unsigned Sites::nearest(std::uint32_t site, unsigned k, Neighbour* out) const {
  thread_local LeafSearch search; // threads go through sites in ascending order
  k = std::min(k, size() - 1);
  if (k == 0) return 0;
  if (k > kept_) return search.nearest(*tree_, site, k, out);
  const SitePlace at = tree_->place(site);
  const std::int16_t* offset = &near_neighbours_[static_cast<std::size_t>(site) * kept_];
  const std::uint32_t* far = offset[0] == 0 ? &far_neighbours_[far_list(offset) * kept_] : nullptr;
  for (unsigned j = 0; j < k; ++j) {
    const std::uint32_t other = far != nullptr ? far[j] : site + static_cast<std::uint32_t>(std::int32_t{offset[j]});
    out[j] = {other, distance2(tree_->place(other), at)};
  }
  return k;
}

bool Sites::keep_neighbours(unsigned k, const SeeNeighbours& see) {
  constexpr std::size_t grain = 1 << 12;
  if (k < least_kept || k >= size()) return false;
  kept_ = 0;
  near_neighbours_.resize(static_cast<std::size_t>(size()) * k);
  std::vector<std::vector<std::uint32_t>> far((size() + grain - 1) / grain);
  parallel_ranges(size(), grain, [&](std::size_t begin, std::size_t end) {
    std::vector<Neighbour> near(k);
    for (std::size_t site = begin; site < end; ++site) {
      nearest(static_cast<std::uint32_t>(site), k, near.data());
      if (see) see(static_cast<std::uint32_t>(site), near.data());
      std::int16_t* to = &near_neighbours_[site * k];
      bool fits = true;
      for (unsigned j = 0; j < k; ++j) {
        const std::int64_t offset = static_cast<std::int64_t>(near[j].site) - static_cast<std::int64_t>(site);
        to[j] = static_cast<std::int16_t>(offset);
        fits = fits && to[j] == offset;
      }
      if (fits) continue;
      set_far_list(to, far[begin / grain].size() / k);
      for (const Neighbour& neighbour : near)
        far[begin / grain].push_back(neighbour.site);
    }
  });
  std::vector<std::size_t> first(far.size() + 1, 0);
  for (std::size_t range = 0; range < far.size(); ++range)
    first[range + 1] = first[range] + far[range].size();
  far_neighbours_.resize(first.back());
  parallel_ranges(size(), grain, [&](std::size_t begin, std::size_t end) {
    const std::size_t range = begin / grain;
    std::copy(far[range].begin(), far[range].end(),
              far_neighbours_.begin() + static_cast<std::ptrdiff_t>(first[range]));
    for (std::size_t site = begin; site < end; ++site)
      if (std::int16_t* to = &near_neighbours_[site * k]; to[0] == 0) set_far_list(to, first[range] / k + far_list(to));
  });
  kept_ = k;
  return true;
}

unsigned Sites::nearest_to(const Eigen::Vector3d& local, unsigned k, Neighbour* out) const {
  return tree_->nearest(rounded(local.cwiseMin(farthest).cwiseMax(-farthest)), std::min(k, size()), no_site, out);
}

} // namespace pointgi
