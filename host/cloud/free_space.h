#pragma once
/// Where a cloud leaves space free: an occupancy grid, coarse but quick, for questions that many rays answer together.
#include "host/cloud/knn.h"
#include <array>

namespace pointgi {

class FreeSpace {
public:
  /// A grid of cubes over the middle 99 % of the sites along each axis, at most `side` along the longest and no finer
  /// than twice the median distance of neighbours, so that surfaces have no holes.
  FreeSpace(const Sites& sites, const std::vector<float>& spacing, unsigned side);

  /// Whether nothing stands between a place and another, both in local units. The first two cells at either end do not
  /// count: what lies there is the surface that the ends are on.
  bool clear(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;

  /// Whether a ray from a place on a surface leaves the grid. `direction`: of any length above 0.
  bool escapes(const Eigen::Vector3d& from, const Eigen::Vector3d& direction) const;

  /// Share of 26 directions, weighted by their cosine to `normal`, in which the half-space on that side of a place is
  /// free all the way out.
  double openness(const Eigen::Vector3d& from, const Eigen::Vector3d& normal) const;

  const Eigen::Vector3d& low() const { return low_; }
  Eigen::Vector3d high() const;

private:
  void occupy(const Sites& sites);
  bool march(const Eigen::Vector3d& from, const Eigen::Vector3d& direction, double length, double skip_end) const;

  Eigen::Vector3d low_;
  double cell_ = 1.0;
  std::array<int, 3> size_{1, 1, 1};
  std::vector<std::uint64_t> occupied_; ///< a bit a cell
};

} // namespace pointgi
