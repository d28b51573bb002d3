#pragma once
/// Where the faces of a mesh end: at its boundary, and at edges across which it does not go on smoothly.
#include "host/cloud/point_cloud.h"
#include <array>
#include <cstdint>
#include <vector>

namespace pointgi {

/// An edge of a triangle.
struct MeshSide {
  std::uint32_t low, high; ///< vertices
  std::uint32_t slot;      ///< 3 triangle + corner
};

class MeshBorders {
public:
  using Triangles = std::vector<std::array<std::uint32_t, 3>>;

  /// `triangles`: corners as indices into `position`. Corners in one place are one vertex. Both must outlive this.
  /// Triangles without an area, or with a corner that there is not, are left out.
  MeshBorders(const std::vector<Eigen::Vector3d>& position, const Triangles& triangles);

  /// Whether some triangle ends anywhere but at one that continues it. False, too, of a mesh with so many faces that
  /// fold back on others that it is not the surface of anything: then nothing is known of borders.
  bool any() const { return any_; }

  /// Whether the triangle has an area.
  bool is_used(std::size_t triangle) const { return vertex_[3 * triangle] != none; }

  /// The triangle that continues `triangle` within 40° across its edge from `corner` (0 .. 2) to the next; none: it
  /// ends.
  static constexpr std::uint32_t none = 0xffffffffu;
  std::uint32_t across(std::size_t triangle, int corner) const { return across_[3 * triangle + corner]; }

  /// Where the surface around `place` ends, no farther than `reach` off, as half-planes of the tangent plane with
  /// `normal` (unit): the nearest border, and another one across it. `from`: the triangles that the place lies on.
  /// Without an axis where the surface goes on, and where it turns round a corner inwards, which two half-planes are
  /// not.
  ClipStrips around(const Eigen::Vector3d& place, const Eigen::Vector3d& normal, const std::vector<std::uint32_t>& from,
                    double reach) const;

private:
  /// Where a triangle ends at one that lies at an angle to it.
  struct Fold {
    MeshSide side;
    std::uint32_t next;
  };
  void unfold_loose(std::vector<Fold>& folds, std::vector<std::uint32_t>& ends);

  bool faces_along(std::size_t triangle, const Eigen::Vector3d& normal) const;

  const std::vector<Eigen::Vector3d>& position_;
  const Triangles& triangles_;
  std::vector<std::uint32_t> vertex_; ///< of each corner: equal for corners in one place
  std::vector<std::uint32_t> across_;
  bool any_ = false;
};

/// Vertices at which edges meet become several points, one for each face: their normals stay those of the faces. Those
/// of more than 64 triangles stay one. Triangles refer to the new points afterwards, which follow the others.
void split_at_edges(PointCloud& cloud);

/// Fills cloud.clipped of the vertices of a mesh, from its faces, as far off as discs of one and a half times their
/// radii reach.
void borders_from_faces(PointCloud& cloud);

} // namespace pointgi
