#include "octree/vmap/shafts.h"
#include "octree/parallel.h"
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pointgi {

namespace {

using Vector = Eigen::Vector3d;

/// Splats of a lowest box, and boxes of the next.
constexpr std::size_t fan = 8;
/// Boxes and splats that a question looks at before it gives up: about what asking the segments would cost.
constexpr int most_looks = 512;
/// Rounding of positions and of products with them, coordinates below 1.
constexpr double rounding = 1e-6;
constexpr double pi = 3.14159265358979323846;

Vector vector_of(const float v[3]) {
  return {v[0], v[1], v[2]};
}

template <class Box>
void add_box(Box& box, const float low[3], const float high[3]) {
  for (int k = 0; k < 3; ++k) {
    box.low[k] = std::min(box.low[k], low[k]);
    box.high[k] = std::max(box.high[k], high[k]);
  }
}

/// All segments from points of the one cluster to points of the other.
class Shaft {
public:
  Shaft(const Cluster& a, const Cluster& b) {
    for (int k = 0; k < 3; ++k) {
      low_[k] = std::min(a.low[k], b.low[k]) - rounding;
      high_[k] = std::max(a.high[k], b.high[k]) + rounding;
    }
    for (int u = 0; u < 3; ++u)
      add_edges(a, b, u, (u + 1) % 3);
    const double longest = (vector_of(b.centre) - vector_of(a.centre)).norm() + a.radius + b.radius;
    add_front(a, longest);
    add_front(b, longest);
  }

  /// Whether a box may hold a part of a segment.
  bool meets(const float low[3], const float high[3]) const {
    for (int k = 0; k < 3; ++k)
      if (static_cast<double>(low[k]) > high_[k] || static_cast<double>(high[k]) < low_[k]) return false;
    for (int p = 0; p < count_; ++p) {
      double least = 0.0;
      for (int k = 0; k < 3; ++k)
        least += plane_[p].normal[k] * static_cast<double>(plane_[p].normal[k] > 0.0 ? low[k] : high[k]);
      if (least > plane_[p].limit) return false;
    }
    return true;
  }

private:
  struct Plane {
    Vector normal; ///< outwards
    double limit;
  };

  void add(const Vector& normal, double limit) { plane_[count_++] = {normal, limit}; }

  /// The slanting edges of the hull of the two boxes as they look along the third axis: from a corner of the one to
  /// the same corner of the other, where each box reaches beyond the other on one axis.
  void add_edges(const Cluster& a, const Cluster& b, int u, int v) {
    for (const int su : {-1, 1})
      for (const int sv : {-1, 1}) {
        const auto corner = [&](const Cluster& c, int axis, int side) {
          return static_cast<double>(side > 0 ? c.high[axis] : c.low[axis]);
        };
        const double au = corner(a, u, su), av = corner(a, v, sv);
        const double du = corner(b, u, su) - au, dv = corner(b, v, sv) - av;
        if (!(du * su * dv * sv < 0.0)) continue;
        Vector normal = Vector::Zero();
        normal[u] = su * std::abs(dv);
        normal[v] = sv * std::abs(du);
        normal.normalize();
        add(normal, normal[u] * au + normal[v] * av + rounding);
      }
  }

  /// What lies behind all points of a cluster hides nothing from them: segments go off in front of it.
  void add_front(const Cluster& c, double longest) {
    if (static_cast<double>(c.cone) >= 0.5 * pi) return;
    add(-vector_of(c.axis), -(c.low_along + FLAT_HEIGHT - longest * std::sin(static_cast<double>(c.cone))));
  }

  double low_[3], high_[3];
  std::array<Plane, 14> plane_; ///< twelve edges at most, and two fronts
  int count_ = 0;
};

/// Whether a disc may be part of the surface of a cluster: near it, and facing as it does.
bool may_belong_to(const Cluster& c, const Splat& disc) {
  if (is_flat(disc)) return false;
  double distance2 = 0.0;
  for (int k = 0; k < 3; ++k) {
    const double out = std::max(
        {0.0, static_cast<double>(c.low[k] - disc.position[k]), static_cast<double>(disc.position[k] - c.high[k])});
    distance2 += out * out;
  }
  const double reach = 2.0 * SELF_HIT_REACH * disc.radius;
  if (distance2 > reach * reach) return false;
  const double widest = std::acos(static_cast<double>(SELF_HIT_COSINE)) + c.cone;
  return widest >= pi || vector_of(c.axis).dot(vector_of(disc.normal)) > std::cos(widest);
}

} // namespace

Shafts::Shafts(View<Splat> splats) : splats_(splats) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const Box empty{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
  std::vector<Box> boxes((splats.size + fan - 1) / fan, empty);
  parallel_ranges(boxes.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t k = fan * i; k < std::min(fan * (i + 1), splats.size); ++k) {
        const Box disc = box_of(splats[k]);
        add_box(boxes[i], disc.low, disc.high);
      }
  });
  while (!boxes.empty()) {
    levels_.push_back(std::move(boxes));
    const std::vector<Box>& below = levels_.back();
    if (below.size() == 1) break;
    boxes.assign((below.size() + fan - 1) / fan, empty);
    for (std::size_t i = 0; i < below.size(); ++i)
      add_box(boxes[i / fan], below[i].low, below[i].high);
  }
}

Shafts::Box Shafts::box_of(const Splat& disc) {
  Box box;
  for (int k = 0; k < 3; ++k) {
    const float reach = disc.radius * std::sqrt(std::max(0.0f, 1.0f - disc.normal[k] * disc.normal[k]));
    box.low[k] = disc.position[k] - reach;
    box.high[k] = disc.position[k] + reach;
  }
  return box;
}

Obstacles Shafts::between(const Cluster& a, const Cluster& b) const {
  if (levels_.empty()) return Obstacles::none;
  const Shaft shaft(a, b);
  struct Place {
    std::size_t level, index;
  };
  std::vector<Place> waiting{{levels_.size() - 1, 0}};
  Obstacles found = Obstacles::none;
  for (int looks = 0; !waiting.empty(); ++looks) {
    if (looks > most_looks) return Obstacles::some;
    const Place at = waiting.back();
    waiting.pop_back();
    const Box& box = levels_[at.level][at.index];
    if (!shaft.meets(box.low, box.high)) continue;
    const std::size_t first = fan * at.index;
    if (at.level > 0) {
      for (std::size_t k = first; k < std::min(first + fan, levels_[at.level - 1].size()); ++k)
        waiting.push_back({at.level - 1, k});
      continue;
    }
    for (std::size_t k = first; k < std::min(first + fan, splats_.size); ++k) {
      const Box disc = box_of(splats_[k]);
      if (!shaft.meets(disc.low, disc.high)) continue;
      if (!may_belong_to(a, splats_[k]) && !may_belong_to(b, splats_[k])) return Obstacles::some;
      found = Obstacles::own;
    }
  }
  return found;
}

} // namespace pointgi
