#pragma once
/// The distinct positions of a cloud, in spatial order, and the nearest neighbours among them.
#include "host/cloud/site_tree.h"
#include "octree/build/key_sort.h"
#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

namespace pointgi {

/// A "site" is a position that one or more points have. Sites are numbered along a Morton curve, so that loops over
/// them touch memory in order and ranges of them are compact. Points that share a site are handed out together: a
/// kd-tree over 1e5 equal positions would search them all for every query.
///
/// Sites live in local units: moved to the median of the points and divided by a power of two near their spread, both
/// exact in double. That keeps float distances precise for map coordinates of 1e6 and squares in range for any scale;
/// the median, unlike the bounding box, is not moved by an outlier. Points nearer to one another than the rounding of
/// float there (6e-8 of their distance to the median) count as coincident.
class Sites {
public:
  /// `positions` must be finite and not empty. Throws Error(memory) for more than 2^31 - 1 of them.
  explicit Sites(const std::vector<Eigen::Vector3d>& positions);
  ~Sites();
  Sites(const Sites&) = delete;
  Sites& operator=(const Sites&) = delete;

  std::uint32_t size() const { return static_cast<std::uint32_t>(position_.size()); }
  /// World length of one local unit, a power of two.
  double unit() const { return unit_; }
  /// Local units.
  Eigen::Vector3d position(std::uint32_t site) const { return Eigen::Vector3d::Map(position_[site].data()); }
  Eigen::Vector3d to_local(const Eigen::Vector3d& world) const;

  /// The points at a site, ascending.
  struct Points {
    const std::uint32_t* first;
    const std::uint32_t* last;
    const std::uint32_t* begin() const { return first; }
    const std::uint32_t* end() const { return last; }
    std::size_t size() const { return static_cast<std::size_t>(last - first); }
  };
  Points points(std::uint32_t site) const {
    return {point_.data() + first_point_[site], point_.data() + first_point_[site + 1]};
  }

  /// The k nearest other sites, nearest first, equally far ones in ascending order, into `out` (room for k). Returns
  /// how many there were: min(k, size() - 1). Several times faster where a thread asks for sites in ascending order.
  unsigned nearest(std::uint32_t site, unsigned k, Neighbour* out) const;
  /// Finds the k nearest of every site, on all cores, and keeps them in 2 k bytes a site: nearest() then looks up as
  /// many or fewer. For clouds that are gone through several times. `see(site, near)`: called with each site's k on the
  /// way, on all cores at once. False, and nothing is kept or seen, unless 3 <= k < size().
  using SeeNeighbours = std::function<void(std::uint32_t, const Neighbour*)>;
  bool keep_neighbours(unsigned k, const SeeNeighbours& see = {});
  /// nearest() around any position in local units, sites at that very position included.
  unsigned nearest_to(const Eigen::Vector3d& local, unsigned k, Neighbour* out) const;

private:
  void choose_frame(const std::vector<Eigen::Vector3d>& positions);
  Pool<KeyedIndex> sorted_points(const std::vector<Eigen::Vector3d>& positions) const;
  void make_sites(const std::vector<Eigen::Vector3d>& positions, Pool<KeyedIndex>&& order);

  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();
  double unit_ = 1.0;
  Pool<std::array<double, 3>> position_;
  Pool<std::uint32_t> point_;       ///< points by site
  Pool<std::uint32_t> first_point_; ///< site -> index into point_; one more than there are sites
  std::unique_ptr<SiteTree> tree_;

  unsigned kept_ = 0; ///< neighbours that are kept of each site
  /// Neighbours less their site. Where one of them is too far along the curve for that the first is 0, which none can
  /// be, and the next two are the low and the high half of the number of its list in far_neighbours_.
  Pool<std::int16_t> near_neighbours_;
  Pool<std::uint32_t> far_neighbours_;
};

} // namespace pointgi
