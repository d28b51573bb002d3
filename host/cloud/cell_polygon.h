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
      corner_[c] = {reach * corners[c][0], reach * corners[c][1], reach2_, true};
  }

  /// Whether a neighbour at this squared distance (or farther) cuts nothing off: its bisector is beyond every corner.
  bool is_beyond(double distance2) const { return distance2 >= 4.0 * reach2_; }

  /// Keeps the side of the origin of the bisector between the origin and `neighbour` (not zero).
  void cut(const Eigen::Vector2d& neighbour) {
    const double distance2 = neighbour.squaredNorm();
    if (is_beyond(distance2)) return;
    cut_at(neighbour, 0.5 * distance2);
  }

  /// Keeps what has axis . x <= limit (>= 0).
  void cut_at(const Eigen::Vector2d& axis, double limit) {
    std::array<double, capacity> beyond;
    const int first = measure(axis, limit, beyond);
    if (first < 0 || count_ == capacity) return; // 62 cuts deep: what is left off by then is below rounding
    // Corners beyond the bisector follow each other: from `first` up to, not including, `past`.
    int past = first;
    do
      past = next(past);
    while (beyond[past] > 0);
    const int before = first > 0 ? first - 1 : count_ - 1, last = past > 0 ? past - 1 : count_ - 1;
    // Leaving, the next edge is the bisector; coming back, it is what is left of the last edge.
    const Corner leaving = crossing(before, first, beyond, false);
    const Corner coming = crossing(last, past, beyond, corner_[last].open);
    replace(first, past, leaving, coming);
    reach2_ = 0;
    for (int c = 0; c < count_; ++c)
      reach2_ = std::max(reach2_, corner_[c].distance2);
  }

  double area() const {
    double twice = 0;
    for (int c = 0; c < count_; ++c) {
      const Corner &a = corner_[c], &b = corner_[c + 1 < count_ ? c + 1 : 0];
      twice += a.x * b.y - a.y * b.x;
    }
    return 0.5 * twice;
  }
  /// How far the polygon reaches along `axis` (unit).
  double reach_along(const Eigen::Vector2d& axis) const {
    double most = 0;
    for (int c = 0; c < count_; ++c)
      most = std::max(most, corner_[c].x * axis.x() + corner_[c].y * axis.y());
    return most;
  }
  /// Squared distance of the farthest corner: a disc of that radius covers the cell.
  double reach2() const { return reach2_; }
  /// Whether some edge is still one of the octagon's: no neighbour bounds the cell there.
  bool open() const {
    return std::any_of(corner_.begin(), corner_.begin() + count_, [](const Corner& c) { return c.open; });
  }

private:
  struct Corner {
    double x, y, distance2;
    bool open; ///< the edge from here to the next corner is the octagon's
  };
  static constexpr int capacity = 64;

  int next(int c) const { return c + 1 < count_ ? c + 1 : 0; }

  /// How far each corner lies beyond the line, times the axis' length; the first that does so after one that does not,
  /// or -1.
  int measure(const Eigen::Vector2d& axis, double limit, std::array<double, capacity>& beyond) const {
    int first = -1;
    double before = corner_[count_ - 1].x * axis.x() + corner_[count_ - 1].y * axis.y() - limit;
    for (int c = 0; c < count_; ++c) {
      beyond[c] = corner_[c].x * axis.x() + corner_[c].y * axis.y() - limit;
      if (beyond[c] > 0 && before <= 0) first = c;
      before = beyond[c];
    }
    return first;
  }
  Corner crossing(int from, int to, const std::array<double, capacity>& beyond, bool open) const {
    const double t = beyond[from] / (beyond[from] - beyond[to]);
    const double x = corner_[from].x + t * (corner_[to].x - corner_[from].x);
    const double y = corner_[from].y + t * (corner_[to].y - corner_[from].y);
    return {x, y, x * x + y * y, open};
  }

  /// Puts two corners in the place of those from `first` up to `past`, around the end where past is not above first.
  void replace(int first, int past, const Corner& one, const Corner& other) {
    const auto at = [&](int c) { return corner_.begin() + c; };
    if (past > first || past == 0) {
      const int end = past == 0 ? count_ : past, removed = end - first;
      if (removed == 1) std::copy_backward(at(end), at(count_), at(count_ + 1));
      if (removed > 2) std::copy(at(end), at(count_), at(first + 2));
      count_ += 2 - removed;
    } else {
      std::copy(at(past), at(first), at(0));
      first -= past;
      count_ = first + 2;
    }
    corner_[first] = one;
    corner_[first + 1] = other;
  }

  std::array<Corner, capacity> corner_;
  int count_;
  double reach2_; ///< squared distance of the farthest corner
};

} // namespace pointgi
