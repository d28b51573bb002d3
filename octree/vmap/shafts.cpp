#include "octree/vmap/shafts.h"
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pointgi {

namespace {

using Vector = Eigen::Vector3d;

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
    ends_[0] = &a;
    ends_[1] = &b;
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

  /// Whether a cluster of splats lies on, or behind, the plane of an end, which its own axis tells better than its box.
  bool lies_behind(const Cluster& c) const {
    constexpr double same_direction = 1e-10, flat = 1e-5;
    if (static_cast<double>(c.cone) > flat) return false;
    return std::any_of(std::begin(ends_), std::end(ends_), [&](const Cluster* end) {
      if (static_cast<double>(end->cone) > flat) return false;
      const double cosine = vector_of(end->axis).dot(vector_of(c.axis));
      if (std::abs(cosine) < 1.0 - same_direction) return false;
      const double highest = cosine > 0.0 ? c.high_along : -c.low_along;
      return highest < end->low_along + FLAT_HEIGHT;
    });
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
  const Cluster* ends_[2];
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

/// Whether rays off the disc `c` find this one to belong to the surface that they leave: as
/// kernels/surface/own_surface.cl decides where they start in the middle, for the disc's highest place.
bool belongs_to_disc(const Cluster& c, const Splat& disc) {
  if (c.count != 1 || is_flat(disc) || is_sheet(disc)) return false;
  const Vector normal = vector_of(disc.normal), axis = vector_of(c.axis);
  const Vector apart = vector_of(disc.position) - vector_of(c.centre);
  const double cosine = axis.dot(normal), radii = double{c.radius} + disc.radius;
  if (!(cosine > static_cast<double>(SELF_HIT_COSINE))) return false;
  const double lean = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  return apart.norm() < static_cast<double>(SELF_HIT_REACH) * radii &&
         axis.dot(apart) + disc.radius * lean < static_cast<double>(SELF_HIT_HEIGHT) * radii;
}

} // namespace

Shafts::Shafts(View<Splat> splats) : tree_(build_clusters(splats, {})) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  boxes_.assign(tree_.nodes.size(), {{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}});
  for (std::size_t k = tree_.nodes.size(); k-- > 0;) { // children stand behind their parents
    const Cluster& c = tree_.nodes[k];
    for (std::uint32_t i = c.first_point; c.child_count == 0 && i < c.first_point + c.count; ++i) {
      const Box disc = box_of(tree_.points[i]);
      add_box(boxes_[k], disc.low, disc.high);
    }
    if (k != 0) add_box(boxes_[c.parent], boxes_[k].low, boxes_[k].high);
  }
}

Shafts::Box Shafts::box_of(const Splat& disc) {
  Box box;
  for (int k = 0; k < 3; ++k) {
    // Not from 1 - n², which near 1 has lost its digits.
    const float reach = 1.000001f * disc.radius * std::hypot(disc.normal[(k + 1) % 3], disc.normal[(k + 2) % 3]);
    box.low[k] = disc.position[k] - reach;
    box.high[k] = disc.position[k] + reach;
  }
  return box;
}

template <class Shaft, class Meets>
bool Shafts::for_each_met(const Shaft& shaft, const Meets& meets) const {
  std::vector<std::uint32_t> waiting{0};
  for (int looks = 0; !waiting.empty(); ++looks) {
    if (looks > most_looks) return false;
    const std::uint32_t at = waiting.back();
    const Cluster& node = tree_.nodes[at];
    waiting.pop_back();
    if (!shaft.meets(boxes_[at].low, boxes_[at].high) || shaft.lies_behind(node)) continue;
    for (std::uint32_t k = 0; k < node.child_count; ++k)
      waiting.push_back(node.first_child + k);
    if (node.child_count > 0) continue;
    for (std::uint32_t i = node.first_point; i < node.first_point + node.count; ++i) {
      const Box disc = box_of(tree_.points[i]);
      if (shaft.meets(disc.low, disc.high) && !meets(tree_.points[i])) return false;
    }
  }
  return true;
}

Obstacles Shafts::between(const Cluster& a, const Cluster& b) const {
  Obstacles found = Obstacles::none;
  const bool all = for_each_met(Shaft(a, b), [&](const Splat& splat) {
    found = may_belong_to(a, splat) || may_belong_to(b, splat) ? Obstacles::own : Obstacles::some;
    return found == Obstacles::own;
  });
  return !all && found != Obstacles::some ? Obstacles::own : found;
}

Cluster Shafts::with_discs(std::uint32_t k) const {
  Cluster cluster = tree_.nodes[k];
  add_box(cluster, boxes_[k].low, boxes_[k].high);
  // A disc whose normal leans away from the axis has places that much lower.
  float radius = 0.0f;
  for (std::uint32_t i = cluster.first_point; i < cluster.first_point + cluster.count; ++i)
    radius = std::max(radius, tree_.points[i].radius);
  const float lower = cluster.cone < 0.5f * static_cast<float>(pi) ? radius * std::sin(cluster.cone) : radius;
  cluster.low_along -= lower;
  cluster.high_along += lower;
  cluster.radius += radius;
  return cluster;
}

Cluster Shafts::disc(std::uint32_t point) const {
  const Splat& splat = tree_.points[point];
  const Box box = box_of(splat);
  Cluster cluster{};
  cluster.first_point = point;
  cluster.count = 1;
  std::copy_n(box.low, 3, cluster.low);
  std::copy_n(box.high, 3, cluster.high);
  std::copy_n(splat.position, 3, cluster.centre);
  std::copy_n(splat.normal, 3, cluster.axis);
  cluster.radius = splat.radius;
  cluster.cone = 0.0f;
  cluster.low_along = cluster.high_along = static_cast<float>(vector_of(splat.normal).dot(vector_of(splat.position)));
  cluster.area = splat.area;
  return cluster;
}

bool Shafts::for_each_near(const float low[3], const float high[3],
                           const std::function<bool(std::uint32_t)>& look) const {
  std::vector<std::uint32_t> waiting{0};
  while (!waiting.empty()) {
    const std::uint32_t at = waiting.back();
    const Cluster& node = tree_.nodes[at];
    waiting.pop_back();
    bool apart = false;
    for (int k = 0; k < 3; ++k)
      apart = apart || boxes_[at].low[k] > high[k] || boxes_[at].high[k] < low[k];
    if (apart) continue;
    for (std::uint32_t k = 0; k < node.child_count; ++k)
      waiting.push_back(node.first_child + k);
    for (std::uint32_t i = node.first_point; node.child_count == 0 && i < node.first_point + node.count; ++i)
      if (!look(i)) return false;
  }
  return true;
}

bool Shafts::is_open(const Cluster& from, const Cluster& light, bool has_surface) const {
  return for_each_met(Shaft(from, light), [&](const Splat& splat) {
    return belongs_to_disc(from, splat) || (has_surface && may_belong_to(light, splat));
  });
}

} // namespace pointgi
