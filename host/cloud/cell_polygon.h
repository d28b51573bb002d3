#pragma once
/// A convex polygon about the origin of a tangent plane, cut down to a Voronoi cell one neighbour at a time.
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

namespace pointgi {

class CellPolygon {
public:
  /// A regular octagon whose corners are at distance `reach`.
  explicit CellPolygon(double reach) : count_(8), reach2_(reach * reach) {
    constexpr double diagonal = 0.70710678118654752;
    constexpr std::array<std::array<double, 2>, 8> corners = {{{1, 0},
                                                               {diagonal, diagonal},
                                                               {0, 1},
                                                               {-diagonal, diagonal},
                                                               {-1, 0},
                                                               {-diagonal, -diagonal},
                                                               {0, -1},
                                                               {diagonal, -diagonal}}};
    for (int c = 0; c < 8; ++c)
      corner_[c] = {reach * corners[c][0], reach * corners[c][1], true};
  }

  /// Keeps the side of the origin of the bisector between the origin and `neighbour` (not zero).
  void cut(const Eigen::Vector2d& neighbour) {
    const double half = 0.5 * neighbour.squaredNorm();
    if (half >= 2.0 * reach2_) return; // the bisector is farther than every corner
    std::array<double, capacity> beyond;
    bool any = false;
    for (int c = 0; c < count_; ++c) {
      beyond[c] = corner_[c].x * neighbour.x() + corner_[c].y * neighbour.y() - half;
      any = any || beyond[c] > 0;
    }
    if (!any || count_ == capacity) return; // 62 cuts deep: what is left off by then is below rounding
    std::array<Corner, capacity> kept;
    int kept_count = 0;
    reach2_ = 0;
    const auto keep = [&](double x, double y, bool open) {
      kept[kept_count++] = {x, y, open};
      reach2_ = std::max(reach2_, x * x + y * y);
    };
    for (int c = 0; c < count_; ++c) {
      const int d = c + 1 < count_ ? c + 1 : 0;
      if (beyond[c] <= 0) keep(corner_[c].x, corner_[c].y, corner_[c].open);
      if ((beyond[c] <= 0) == (beyond[d] <= 0)) continue;
      const double t = beyond[c] / (beyond[c] - beyond[d]);
      // Leaving, the next edge is the bisector; coming back, it is what is left of edge c.
      keep(corner_[c].x + t * (corner_[d].x - corner_[c].x), corner_[c].y + t * (corner_[d].y - corner_[c].y),
           beyond[c] <= 0 ? false : corner_[c].open);
    }
    corner_ = kept;
    count_ = kept_count;
  }

  double area() const {
    double twice = 0;
    for (int c = 0; c < count_; ++c) {
      const Corner &a = corner_[c], &b = corner_[c + 1 < count_ ? c + 1 : 0];
      twice += a.x * b.y - a.y * b.x;
    }
    return 0.5 * twice;
  }
  /// Squared distance of the farthest corner: a disc of that radius covers the cell.
  double reach2() const { return reach2_; }
  /// Whether some edge is still one of the octagon's: no neighbour bounds the cell there.
  bool open() const {
    return std::any_of(corner_.begin(), corner_.begin() + count_, [](const Corner& c) { return c.open; });
  }

private:
  struct Corner {
    double x, y;
    bool open; ///< the edge from here to the next corner is the octagon's
  };
  static constexpr int capacity = 64;
  std::array<Corner, capacity> corner_;
  int count_;
  double reach2_; ///< squared distance of the farthest corner
};

} // namespace pointgi
