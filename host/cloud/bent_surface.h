#pragma once
/// Where a disc would stick out of a surface that is bent outwards: past the lines in which its plane meets its
/// neighbours'.
#include <Eigen/Core>
#include <array>

namespace pointgi {

/// One disc among its neighbours. Lengths in any one unit.
class BentSurface {
public:
  static constexpr unsigned most_planes = 40;

  /// The disc. `trusted`: normals are not to be doubted; else the surface must bend the same way towards several
  /// neighbours.
  void begin(const Eigen::Vector3d& normal, double radius, bool trusted);
  /// A neighbour at `offset` from the disc's centre; the normal: unit. Those beyond `most_planes` do not count.
  void add(const Eigen::Vector3d& offset, const Eigen::Vector3d& normal);

  /// A direction in the disc's plane, unit, and how far above a neighbour's plane the rim is that way; 0: nowhere.
  struct Worst {
    Eigen::Vector3d axis = Eigen::Vector3d::Zero();
    double height = 0;
  };
  /// Of all directions that `counts` says.
  template <class Counts>
  Worst worst(const Counts& counts) const {
    Worst result;
    for (unsigned k = 0; k < count_; ++k)
      if (height(line_[k]) > result.height && counts(line_[k].axis) && bends_away(line_[k].axis))
        result = {line_[k].axis, height(line_[k])};
    return result;
  }

private:
  /// Where a neighbour's plane meets the disc's.
  struct Line {
    Eigen::Vector3d axis; ///< across it
    double distance;      ///< from the disc's centre
    double sine;          ///< of the angle between the planes
  };
  struct Bend {
    Eigen::Vector3d offset;
    bool away; ///< the surface bends away from the disc's plane towards it
  };

  double height(const Line& line) const { return (radius_ - line.distance) * line.sine; }
  bool bends_away(const Eigen::Vector3d& axis) const;

  Eigen::Vector3d normal_ = Eigen::Vector3d::UnitZ();
  double radius_ = 0;
  bool trusted_ = false;
  unsigned count_ = 0, bends_ = 0;
  std::array<Line, most_planes> line_;
  std::array<Bend, most_planes> bend_;
};

} // namespace pointgi
