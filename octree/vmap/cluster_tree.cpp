#include "octree/vmap/cluster_tree.h"
#include "octree/build/tree.h"
#include "octree/parallel.h"
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace pointgi {

namespace {

using Vector = Eigen::Vector3d;

constexpr double pi = 3.14159265358979323846;

/// A cell of no more points is a leaf however its normals spread: noise must not end in leaves of one point each.
constexpr unsigned few_points = 8;

/// Faces of shapes into which a cell is divided at most; it has eight octants.
constexpr std::size_t most_faces = 8;
/// Fewer points a face than this, in the mean, are not divided: many small boxes would end in leaves of one point each.
constexpr std::uint32_t few_of_face = 3;
/// More points than this are not looked at: a cell that large holds many faces.
constexpr std::uint32_t most_divided_by_face = 1u << 20;
/// Planes are one plane within this: 1 - cosine, and root cube units: a few roundings.
constexpr double same_direction = 1e-10, same_plane = 2e-6;

/// Items that a thread takes at a time.
constexpr std::size_t node_grain = 64, point_grain = 16384;

Vector position_of(const Splat& s) {
  return {s.position[0], s.position[1], s.position[2]};
}
Vector normal_of(const Splat& s) {
  return Vector(s.normal[0], s.normal[1], s.normal[2]).normalized();
}
Vector vector_of(const float v[3]) {
  return {v[0], v[1], v[2]};
}

double area_of(const Splat& s) {
  return s.area;
}

float rounded_up(double x) {
  const auto f = static_cast<float>(x);
  return static_cast<double>(f) < x ? std::nextafter(f, std::numeric_limits<float>::infinity()) : f;
}
float rounded_down(double x) {
  return -rounded_up(-x);
}

/// Sums over points, from which the means follow.
struct Moments {
  double area = 0.0;
  Vector position = Vector::Zero(); ///< area-weighted
  Vector normal = Vector::Zero();   ///< area-weighted
  float low[3], high[3];

  Moments() {
    std::fill_n(low, 3, std::numeric_limits<float>::infinity());
    std::fill_n(high, 3, -std::numeric_limits<float>::infinity());
  }

  void add(const Splat& s) {
    area += area_of(s);
    position += area_of(s) * position_of(s);
    normal += area_of(s) * normal_of(s);
    for (int a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], s.position[a]);
      high[a] = std::max(high[a], s.position[a]);
    }
  }
  void add(const Moments& m) {
    area += m.area;
    position += m.position;
    normal += m.normal;
    for (int a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], m.low[a]);
      high[a] = std::max(high[a], m.high[a]);
    }
  }
};

/// Largest and smallest of what is measured from the means; their order of computation does not matter: the result is
/// bit-identical.
struct Extent {
  double radius2 = 0.0;
  double chord2 = 0.0; ///< of a normal's end from the axis' end: precise where the arc cosine is not
  double low_along = std::numeric_limits<double>::infinity(), high_along = -low_along;

  void add(const Splat& s, const Vector& centre, const Vector& axis, const Vector& unit_axis) {
    const Vector p = position_of(s);
    const double along = axis.dot(p);
    radius2 = std::max(radius2, (p - centre).squaredNorm());
    chord2 = std::max(chord2, (normal_of(s) - unit_axis).squaredNorm());
    low_along = std::min(low_along, along);
    high_along = std::max(high_along, along);
  }
  void add(const Extent& e) {
    radius2 = std::max(radius2, e.radius2);
    chord2 = std::max(chord2, e.chord2);
    low_along = std::min(low_along, e.low_along);
    high_along = std::max(high_along, e.high_along);
  }
};

Extent extent_of(const Cluster& c, const Splat* points, std::size_t begin, std::size_t end) {
  const Vector centre = vector_of(c.centre), axis = vector_of(c.axis), unit_axis = axis.normalized();
  Extent extent;
  for (std::size_t i = begin; i < end; ++i)
    extent.add(points[i], centre, axis, unit_axis);
  return extent;
}

/// Box and means from sums over all the cluster's points.
void set_means(Cluster& c, const Moments& m) {
  std::copy_n(m.low, 3, c.low);
  std::copy_n(m.high, 3, c.high);
  c.area = static_cast<float>(m.area);
  const Vector middle = 0.5 * (vector_of(m.low) + vector_of(m.high));
  const Vector centre = m.area > 0.0 ? Vector(m.position / m.area) : middle;
  // Normals that cancel: where they point on the whole is rounding.
  const double length = m.normal.norm();
  const bool has_mean = length > 1e-9 * m.area;
  const Vector axis = has_mean ? Vector(m.normal / length) : Vector(0.0, 0.0, 1.0);
  for (int a = 0; a < 3; ++a) {
    c.centre[a] = static_cast<float>(centre[a]);
    c.axis[a] = static_cast<float>(axis[a]);
  }
  c.cone = has_mean ? 0.0f : static_cast<float>(pi);
}

/// Bounds, rounded outwards: what is said of all points holds for all points.
void set_bounds(Cluster& c, const Extent& e) {
  c.radius = rounded_up(std::sqrt(e.radius2));
  if (c.cone == 0.0f) c.cone = rounded_up(2.0 * std::asin(std::min(1.0, 0.5 * std::sqrt(e.chord2))));
  c.low_along = rounded_down(e.low_along);
  c.high_along = rounded_up(e.high_along);
}

/// A part of the points, in the order of the tree, and the level of the octree's cell that holds it.
struct Part {
  std::uint32_t first = 0, count = 0, level = 0;
};

class Clusters {
public:
  Clusters(View<Splat> splats, const ClusterOptions& options, View<std::uint32_t> part)
      : options_(options), part_(part) {
    {
      TreeOptions tree_options;
      tree_options.leaf_capacity = std::numeric_limits<unsigned>::max(); // of the tree only the order is wanted
      tree_options.max_depth = options.max_depth;
      tree_options.listing = Listing::centres;
      const Tree cells = build_tree(splats, tree_options);
      clusters_.order.assign(cells.order.begin(), cells.order.end());
    }
    clusters_.points.resize(splats.size);
    clusters_.leaf_of.resize(splats.size);
    parallel_ranges(splats.size, point_grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k)
        clusters_.points[k] = splats[clusters_.order[k]];
    });
    divide({0, static_cast<std::uint32_t>(splats.size), 0});
    measure();
  }

  ClusterTree take() { return std::move(clusters_); }

private:
  /// Whether points, which are no more than a leaf may hold, face nearly the same way.
  bool near_planar(const Part& part) const {
    Moments moments;
    for (std::uint32_t i = 0; i < part.count; ++i)
      moments.add(clusters_.points[part.first + i]);
    Cluster c;
    set_means(c, moments);
    set_bounds(c, extent_of(c, clusters_.points.data(), part.first, part.first + part.count));
    return c.cone <= options_.planar_cone;
  }

  bool ends_here(const Part& part) const {
    return part.count <= std::min(few_points, options_.leaf_capacity) || part.level >= options_.max_depth ||
           (part.count <= options_.leaf_capacity && near_planar(part));
  }

  /// Which flat face each point lies on, if those of the part are few; the points of none together are one more.
  /// Returns how many: 0 where there are more than `most_faces`.
  std::uint32_t faces_of(const Part& part, std::vector<std::uint8_t>& face) const {
    struct Plane {
      Vector normal;
      double along;
      std::uint32_t part;
    };
    std::vector<Plane> planes;
    constexpr std::uint8_t none = 0xff;
    bool any_flat = false, any_other = false;
    for (std::uint32_t i = 0; i < part.count; ++i) {
      const Splat& s = clusters_.points[part.first + i];
      face[i] = none;
      any_other = any_other || !is_flat(s);
      if (!is_flat(s)) continue;
      any_flat = true;
      const Vector normal = normal_of(s), position = position_of(s);
      const std::uint32_t part_number = part_.size == 0 ? 0 : part_[clusters_.order[part.first + i]];
      const auto at = std::find_if(planes.begin(), planes.end(), [&](const Plane& p) {
        return p.part == part_number && p.normal.dot(normal) > 1.0 - same_direction &&
               std::abs(p.normal.dot(position) - p.along) < same_plane;
      });
      if (at == planes.end() && planes.size() == most_faces) return 0;
      face[i] = static_cast<std::uint8_t>(at - planes.begin());
      if (at == planes.end()) planes.push_back({normal, normal.dot(position), part_number});
    }
    if (!any_flat) return 1;
    const auto of_planes = static_cast<std::uint8_t>(planes.size());
    if (any_other) std::replace(face.begin(), face.begin() + part.count, none, of_planes);
    return of_planes + (any_other ? 1u : 0u);
  }

  /// The octant of the part's cell that holds each point.
  void octants_of(const Part& part, std::vector<std::uint8_t>& octant) const {
    const double cells = std::ldexp(1.0, static_cast<int>(part.level) + 1);
    for (std::uint32_t i = 0; i < part.count; ++i) {
      octant[i] = 0;
      for (int a = 0; a < 3; ++a) {
        const double along = static_cast<double>(clusters_.points[part.first + i].position[a]) * cells;
        const auto cell = static_cast<std::uint32_t>(std::min(std::max(0.0, along), cells - 1.0));
        octant[i] |= static_cast<std::uint8_t>((cell & 1u) << a);
      }
    }
  }

  /// Gives a part's points, each of a kind below `kinds`, the order of their kinds and keeps it within these; the
  /// parts. Along the curve octants follow each other already, so that nothing large is copied.
  std::vector<Part> sorted_by_kind(const Part& part, const std::vector<std::uint8_t>& kind, std::uint32_t kinds,
                                   std::uint32_t level) {
    std::vector<Part> parts(kinds);
    for (std::uint32_t i = 0; i < part.count; ++i)
      ++parts[kind[i]].count;
    std::uint32_t first = part.first;
    for (Part& p : parts) {
      p.first = first;
      p.level = level;
      first += p.count;
    }
    if (!std::is_sorted(kind.begin(), kind.begin() + part.count)) reorder(part, kind, parts);
    parts.erase(std::remove_if(parts.begin(), parts.end(), [](const Part& p) { return p.count == 0; }), parts.end());
    return parts;
  }

  /// The points of a part in the order of their kinds, each of which has its place among `parts`.
  void reorder(const Part& part, const std::vector<std::uint8_t>& kind, const std::vector<Part>& parts) {
    std::vector<std::uint32_t> next, order(part.count);
    std::vector<Splat> points(part.count);
    for (const Part& p : parts)
      next.push_back(p.first - part.first);
    for (std::uint32_t i = 0; i < part.count; ++i) {
      order[next[kind[i]]] = clusters_.order[part.first + i];
      points[next[kind[i]]++] = clusters_.points[part.first + i];
    }
    std::copy(order.begin(), order.end(), clusters_.order.begin() + part.first);
    std::copy(points.begin(), points.end(), clusters_.points.begin() + part.first);
  }

  /// Where a part holds several points of each of a few flat faces these divide it, and what lies on one only: a
  /// cluster of two faces neither faces anything as a whole nor is hidden or seen as one. Else the octants of its cell
  /// do. Empty: a leaf.
  std::vector<Part> parts_of(const Part& part) {
    std::vector<std::uint8_t> kind(part.count);
    const std::uint32_t faces = part.count > most_divided_by_face ? 0 : faces_of(part, kind);
    if (faces > 1 && part.count >= few_of_face * faces) return sorted_by_kind(part, kind, faces, part.level);
    if (ends_here(part)) return {};
    octants_of(part, kind);
    return sorted_by_kind(part, kind, 8, part.level + 1);
  }

  /// All nodes below the root, level after level, so that a level's can be treated at once.
  void divide(const Part& root) {
    std::vector<Part> level{root};
    clusters_.nodes.emplace_back();
    clusters_.nodes[0].count = root.count;
    for (std::uint32_t first = 0; !level.empty(); first = level_starts_.back()) {
      level_starts_.push_back(first + static_cast<std::uint32_t>(level.size()));
      std::vector<std::vector<Part>> parts(level.size());
      parallel_ranges(level.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
          parts[i] = parts_of(level[i]);
      });
      std::vector<Part> next;
      for (std::size_t i = 0; i < level.size(); ++i)
        if (!parts[i].empty()) add_children(parts[i], first + static_cast<std::uint32_t>(i), next);
      level = std::move(next);
    }
  }

  void add_children(const std::vector<Part>& parts, std::uint32_t parent, std::vector<Part>& next) {
    const auto first = static_cast<std::uint32_t>(clusters_.nodes.size());
    for (const Part& part : parts) {
      Cluster c;
      c.first_point = part.first;
      c.count = part.count;
      c.parent = parent;
      c.level = clusters_.nodes[parent].level + 1;
      clusters_.nodes.push_back(c);
      next.push_back(part);
    }
    clusters_.nodes[parent].first_child = first;
    clusters_.nodes[parent].child_count = static_cast<std::uint32_t>(parts.size());
  }

  /// Means from the leaves upwards, then bounds.
  void measure() {
    moments_.resize(clusters_.nodes.size());
    for (std::size_t level = level_starts_.size(); level-- > 0;) {
      const std::size_t first = level == 0 ? 0 : level_starts_[level - 1];
      parallel_ranges(level_starts_[level] - first, node_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = first + begin; i < first + end; ++i)
          sum_up(i);
      });
    }
    std::vector<std::size_t> large;
    for (std::size_t i = 0; i < clusters_.nodes.size(); ++i)
      if (clusters_.nodes[i].count > point_grain) large.push_back(i);
    parallel_ranges(clusters_.nodes.size(), node_grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        Cluster& c = clusters_.nodes[i];
        if (c.count > 0 && c.count <= point_grain)
          set_bounds(c, extent_of(c, clusters_.points.data(), c.first_point, c.first_point + c.count));
      }
    });
    for (const std::size_t i : large)
      measure_large(clusters_.nodes[i]);
  }

  void sum_up(std::size_t node) {
    Cluster& c = clusters_.nodes[node];
    Moments& sum = moments_[node];
    for (std::uint32_t k = 0; k < c.child_count; ++k)
      sum.add(moments_[c.first_child + k]);
    if (c.child_count == 0)
      for (std::uint32_t k = 0; k < c.count; ++k) {
        sum.add(clusters_.points[c.first_point + k]);
        clusters_.leaf_of[c.first_point + k] = static_cast<std::uint32_t>(node);
      }
    if (c.count > 0) set_means(c, sum);
  }

  /// With all threads at the points of one cluster.
  void measure_large(Cluster& c) const {
    std::vector<Extent> found((c.count + point_grain - 1) / point_grain);
    parallel_ranges(c.count, point_grain, [&](std::size_t begin, std::size_t end) {
      found[begin / point_grain] = extent_of(c, clusters_.points.data(), c.first_point + begin, c.first_point + end);
    });
    Extent extent;
    for (const Extent& part : found)
      extent.add(part);
    set_bounds(c, extent);
  }

  ClusterOptions options_;
  View<std::uint32_t> part_; ///< of each input splat, or empty
  ClusterTree clusters_;
  std::vector<std::uint32_t> level_starts_; ///< one past the last node of each level
  std::vector<Moments> moments_;            ///< one a node
};

/// What nothing is known of: no point, no area, normals anywhere.
Cluster empty_cluster() {
  Cluster c;
  for (float* v : {c.low, c.high, c.centre, c.axis})
    std::fill_n(v, 3, 0.0f);
  c.axis[2] = 1.0f;
  c.radius = c.low_along = c.high_along = c.area = 0.0f;
  c.cone = static_cast<float>(pi);
  return c;
}

/// Appends the nodes of `part` but its root, whose place among `nodes` is `root`; its points begin at `first_point`.
void append_below(const ClusterTree& part, std::uint32_t root, std::uint32_t first_point, std::vector<Cluster>& nodes) {
  const auto shift = static_cast<std::uint32_t>(nodes.size()) - 1; // of all but the root
  const auto place = [&](std::uint32_t node) { return node == 0 ? root : node + shift; };
  for (std::uint32_t k = 0; k < part.nodes.size(); ++k) {
    Cluster c = part.nodes[k];
    c.first_point += first_point;
    if (c.child_count > 0) c.first_child = place(c.first_child);
    c.parent = k == 0 ? 0 : place(c.parent);
    ++c.level;
    if (k == 0)
      nodes[root] = c;
    else
      nodes.push_back(c);
  }
}

/// A root over two trees, whose points `input[0]` and `input[1]` are places in `splats`.
ClusterTree joined(View<Splat> splats, const ClusterTree (&parts)[2], const std::vector<std::uint32_t> (&input)[2]) {
  ClusterTree tree;
  tree.nodes.resize(3);
  tree.order.reserve(splats.size);
  tree.points.reserve(splats.size);
  tree.leaf_of.reserve(splats.size);
  std::uint32_t first_point = 0;
  Moments moments;
  for (std::uint32_t p = 0; p < 2; ++p) {
    const auto shift = static_cast<std::uint32_t>(tree.nodes.size()) - 1;
    append_below(parts[p], 1 + p, first_point, tree.nodes);
    for (std::size_t k = 0; k < parts[p].points.size(); ++k) {
      tree.order.push_back(input[p][parts[p].order[k]]);
      tree.points.push_back(parts[p].points[k]);
      tree.leaf_of.push_back(parts[p].leaf_of[k] == 0 ? 1 + p : parts[p].leaf_of[k] + shift);
      moments.add(parts[p].points[k]);
    }
    first_point += static_cast<std::uint32_t>(parts[p].points.size());
  }
  Cluster& root = tree.nodes[0];
  root.count = static_cast<std::uint32_t>(splats.size);
  root.first_child = 1;
  root.child_count = 2;
  set_means(root, moments);
  set_bounds(root, extent_of(root, tree.points.data(), 0, splats.size));
  return tree;
}

} // namespace

ClusterTree build_clusters(View<Splat> splats, const ClusterOptions& options, View<std::uint32_t> part) {
  if (part.size != 0 && part.size != splats.size) throw std::invalid_argument("vmap: a part of each splat, or of none");
  if (!(options.planar_cone > 0.0f)) throw std::invalid_argument("vmap: planar_cone must be above 0 radians");
  if (options.leaf_capacity < 1) throw std::invalid_argument("vmap: leaf_capacity must be at least 1");
  if (splats.size == 0) {
    ClusterTree tree;
    tree.nodes.push_back(empty_cluster());
    return tree;
  }
  // The two sides of sheets lie in one place: clusters of both would face nothing, however small.
  std::vector<std::uint32_t> input[2]; // all but backs of sheets, and these
  for (std::uint32_t i = 0; i < splats.size; ++i)
    if (is_back_of_sheet(splats[i])) input[1].push_back(i);
  if (input[1].empty() || input[1].size() == splats.size) return Clusters(splats, options, part).take();
  ClusterTree parts[2];
  for (std::uint32_t i = 0; i < splats.size; ++i)
    if (!is_back_of_sheet(splats[i])) input[0].push_back(i);
  for (std::size_t p = 0; p < 2; ++p) {
    std::vector<Splat> of_tree;
    std::vector<std::uint32_t> part_of_tree;
    for (const std::uint32_t i : input[p]) {
      of_tree.push_back(splats[i]);
      if (part.size != 0) part_of_tree.push_back(part[i]);
    }
    parts[p] = Clusters(of_tree, options, part_of_tree).take();
  }
  return joined(splats, parts, input);
}

} // namespace pointgi
