#include "host/cloud/free_space.h"
#include "host/cloud/quantile.h"
#include "octree/parallel.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>

namespace pointgi {

namespace {

constexpr double outermost = 0.005; // of the sites at either end of an axis: not part of the bounds
constexpr double skipped_cells = 2.0;

} // namespace

FreeSpace::FreeSpace(const Sites& sites, const std::vector<float>& spacing, unsigned side) {
  const std::size_t n = sites.size();
  const auto bounds =
      bounds_at_ranks(n, rank_of_share(n, outermost), rank_of_share(n, 1.0 - outermost), [&](std::size_t s) {
        return Eigen::Vector3f(sites.position(static_cast<std::uint32_t>(s)).cast<float>());
      });
  low_ = Eigen::Vector3d::Map(bounds[0].data());
  Eigen::Vector3d high = Eigen::Vector3d::Map(bounds[1].data());
  const double usual = value_at_rank(n, rank_of_share(n, 0.5), [&](std::size_t s) { return spacing[s]; });
  const double extent = (high - low_).maxCoeff();
  cell_ = std::max({extent / side, 2.0 * usual, 1e-12});
  low_ -= Eigen::Vector3d::Constant(cell_);
  high += Eigen::Vector3d::Constant(cell_);
  for (int axis = 0; axis < 3; ++axis)
    size_[axis] = std::max(1, static_cast<int>(std::ceil((high[axis] - low_[axis]) / cell_)));
  occupy(sites);
}

void FreeSpace::occupy(const Sites& sites) {
  std::vector<std::atomic<std::uint64_t>> occupied((static_cast<std::size_t>(size_[0]) * size_[1] * size_[2] + 63) /
                                                   64);
  parallel_ranges(sites.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      const Eigen::Vector3d at = (sites.position(static_cast<std::uint32_t>(s)) - low_) / cell_;
      if ((at.array() < 0).any() || at[0] >= size_[0] || at[1] >= size_[1] || at[2] >= size_[2]) continue;
      const std::size_t cell =
          (static_cast<std::size_t>(at[2]) * size_[1] + static_cast<std::size_t>(at[1])) * size_[0] +
          static_cast<std::size_t>(at[0]);
      std::atomic<std::uint64_t>& word = occupied[cell / 64];
      const std::uint64_t bit = std::uint64_t{1} << (cell % 64);
      if ((word.load(std::memory_order_relaxed) & bit) == 0) word.fetch_or(bit, std::memory_order_relaxed);
    }
  });
  occupied_.assign(occupied.begin(), occupied.end());
}

Eigen::Vector3d FreeSpace::high() const {
  return low_ + cell_ * Eigen::Vector3d(size_[0], size_[1], size_[2]);
}

/// Amanatides & Woo 1987, from cell to cell. `direction` has unit length; lengths in local units.
bool FreeSpace::march(const Eigen::Vector3d& from, const Eigen::Vector3d& direction, double length,
                      double skip_end) const {
  double begin = skipped_cells * cell_, end = length - skip_end;
  for (int axis = 0; axis < 3; ++axis) { // the part of the ray inside the grid
    const double d = direction[axis], o = from[axis] - low_[axis], size = cell_ * size_[axis];
    if (std::abs(d) < 1e-12) {
      if (o < 0 || o >= size) return true;
      continue;
    }
    const double a = -o / d, b = (size - o) / d;
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  if (!(begin < end)) return true;
  const Eigen::Vector3d start = (from + begin * direction - low_) / cell_;
  std::array<int, 3> cell, step;
  std::array<double, 3> next, delta;
  for (int axis = 0; axis < 3; ++axis) {
    cell[axis] = std::clamp(static_cast<int>(std::floor(start[axis])), 0, size_[axis] - 1);
    const double d = direction[axis] / cell_;
    step[axis] = d > 0 ? 1 : -1;
    delta[axis] = std::abs(d) < 1e-12 ? std::numeric_limits<double>::infinity() : 1.0 / std::abs(d);
    const double to_border = d > 0 ? cell[axis] + 1 - start[axis] : start[axis] - cell[axis];
    next[axis] = std::isinf(delta[axis]) ? delta[axis] : begin + to_border * delta[axis];
  }
  for (;;) {
    const std::size_t at =
        (static_cast<std::size_t>(cell[2]) * size_[1] + static_cast<std::size_t>(cell[1])) * size_[0] +
        static_cast<std::size_t>(cell[0]);
    if ((occupied_[at / 64] >> (at % 64) & 1u) != 0) return false;
    const int axis = next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
    if (next[axis] >= end) return true;
    cell[axis] += step[axis];
    if (cell[axis] < 0 || cell[axis] >= size_[axis]) return true;
    next[axis] += delta[axis];
  }
}

bool FreeSpace::clear(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
  const Eigen::Vector3d way = to - from;
  const double length = way.norm();
  return length <= 0 || march(from, way / length, length, 0.0);
}

bool FreeSpace::escapes(const Eigen::Vector3d& from, const Eigen::Vector3d& direction) const {
  return march(from, direction.normalized(), std::numeric_limits<double>::infinity(), 0.0);
}

double FreeSpace::openness(const Eigen::Vector3d& from, const Eigen::Vector3d& normal) const {
  double open = 0, all = 0;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) {
        const Eigen::Vector3d d = Eigen::Vector3d(x + 0.02 * y, y + 0.03 * z, z + 0.01 * x); // off the cells' diagonals
        const double cosine = d.norm() > 0.5 ? d.normalized().dot(normal) : 0.0;
        if (cosine < 0.1) continue; // along the surface itself
        all += cosine;
        if (escapes(from, d)) open += cosine;
      }
  return all > 0 ? open / all : 0.0;
}

} // namespace pointgi
