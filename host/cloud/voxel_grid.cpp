#include "host/cloud/voxel_grid.h"
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace pointgi {

namespace {

using Eigen::Vector3d;

/// A hash table of cubes, each named by the point that stands for it: what the table needs to know of a cube is
/// computed from that point again.
class VoxelTable {
public:
  VoxelTable(const std::vector<Vector3d>& positions, double edge)
      : positions_(positions), edge_(edge), slots_(first_slots, empty) {}

  void add(std::uint32_t point) {
    if (2 * (cubes_ + 1) > slots_.size()) grow();
    std::uint32_t& slot = slots_[slot_of(cube_of(point))];
    if (slot == empty) {
      slot = point;
      ++cubes_;
    } else if (to_middle(point) < to_middle(slot)) {
      slot = point;
    }
  }

  std::vector<bool> chosen() const {
    std::vector<bool> result(positions_.size(), false);
    for (const std::uint32_t point : slots_)
      if (point != empty) result[point] = true;
    return result;
  }

private:
  static constexpr std::uint32_t empty = std::numeric_limits<std::uint32_t>::max();
  static constexpr std::size_t first_slots = 1024; // a power of two, as always

  /// Whole numbers, as doubles: they hold any quotient, and beyond 2^53 neighbours share a cube.
  Vector3d cube_of(std::uint32_t point) const { return (positions_[point] / edge_).array().floor(); }

  double to_middle(std::uint32_t point) const {
    const Vector3d place = positions_[point] / edge_;
    return (place.array() - place.array().floor() - 0.5).matrix().squaredNorm();
  }

  /// Where the cube is, or the empty slot where it belongs.
  std::size_t slot_of(const Vector3d& cube) const {
    std::uint64_t hash = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double whole = cube[axis] + 0.0; // -0 and 0 are one number and have different bits
      std::uint64_t bits;
      std::memcpy(&bits, &whole, sizeof bits);
      hash = (hash ^ bits) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 32;
    }
    std::size_t at = hash & (slots_.size() - 1);
    while (slots_[at] != empty && cube_of(slots_[at]) != cube)
      at = (at + 1) & (slots_.size() - 1);
    return at;
  }

  void grow() {
    std::vector<std::uint32_t> old(2 * slots_.size(), empty);
    old.swap(slots_);
    for (const std::uint32_t point : old)
      if (point != empty) slots_[slot_of(cube_of(point))] = point;
  }

  const std::vector<Vector3d>& positions_;
  double edge_;
  std::vector<std::uint32_t> slots_;
  std::size_t cubes_ = 0;
};

} // namespace

std::vector<bool> one_point_a_voxel(const std::vector<Vector3d>& positions, double edge) {
  VoxelTable table(positions, edge);
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (positions[i].allFinite()) table.add(static_cast<std::uint32_t>(i));
  return table.chosen();
}

} // namespace pointgi
