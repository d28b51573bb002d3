#pragma once
/// The Voronoi cell of a point on a smooth piece of surface, by arithmetic without branches.
#include "host/cloud/unfold.h"
#include <Eigen/Core>
#include <array>
#include <optional>

namespace pointgi {

/// Does what unfold() and CellPolygon do in doubles, neighbour by neighbour, for twenty neighbours at once in floats.
class SmoothCell {
public:
  static constexpr unsigned neighbours = 20;
  static constexpr unsigned nearest = 6; ///< of which cosine() tells

  /// Neighbour j, nearest first: offset from the point in spacings, unit normal.
  void set(unsigned j, const Eigen::Vector3f& e, const Eigen::Vector3f& normal) {
    ex_[j] = e.x();
    ey_[j] = e.y();
    ez_[j] = e.z();
    nx_[j] = normal.x();
    ny_[j] = normal.y();
    nz_[j] = normal.z();
  }

  struct Cell {
    double area, reach; ///< in spacings
  };
  /// None where the cell meets an edge of the surface, so that neighbours have to be looked at one by one; or where
  /// cells do not end within `known`, the distance of the farthest neighbour, so that they depend on others too.
  std::optional<Cell> find(const TangentFrame& frame, double known);

  /// Of the normals of the nearest neighbours on this sheet that of the third that differs most, with this one; 1 when
  /// there are none.
  double cosine() const { return cosine_; }

private:
  using Lanes = Eigen::Array<float, neighbours, 1>;
  static constexpr unsigned lanes = 4;
  static constexpr unsigned few = 12; ///< neighbours that the cell nearly always depends on

  float lay_flat(const TangentFrame& frame);
  void find_cosine();
  void cut_edges(unsigned count);

  Lanes ex_, ey_, ez_, nx_, ny_, nz_;
  Lanes cosine_of_;
  unsigned count_ = 0; ///< of neighbours on this sheet, whose offsets follow
  std::array<float, neighbours + lanes> x_, y_, length2_;
  float area_ = 0, reach2_ = 0;
  double cosine_ = 1;
};

} // namespace pointgi
