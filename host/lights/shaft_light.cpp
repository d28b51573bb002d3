#include "host/lights/shaft_light.h"
#include "octree/parallel.h"
#include "octree/vmap/facing.h"
#include "octree/vmap/shafts.h"
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>

namespace pointgi {

namespace {

using Vector = Eigen::Vector3d;

constexpr double pi = 3.14159265358979323846;
/// A lamp whose normals spread wider hides a part of itself.
constexpr float flat_lamp = 0.05f;
/// Discs of a lamp count as one where they are seen under this angle: a cosine and a distance squared are wrong by its
/// square at most.
constexpr double far_discs = 0.04;
/// A disc of a lamp that is nearer than this many of its radii is no point of light.
constexpr double near_disc = 6.0;
/// Lamps nearer than this many radii of a point's disc change over it more than by a gradient: the error of cos / d² is
/// about (radius / d)², here 1e-3.
constexpr double far_lamp = 32.0;
/// Where neighbours' normals differ by more, so does the cosine between them: an error of half the square, 5e-3 at
/// most.
constexpr double flat_cosine = 0.995;
/// Those that differ by more than this are of another surface (kernels/surface/blend.cl).
constexpr double same_surface = 0.5;
/// The longest way in the root cube.
constexpr double across_cube = 1.75;

Vector vector_of(const float v[3]) {
  return {v[0], v[1], v[2]};
}

/// Clusters of the emitting splats, with what leaves them along their axis.
struct Lamps {
  ClusterTree tree;
  std::vector<Vector> flux;         ///< of each node: sum of radiance times area
  std::vector<std::uint32_t> lamps; ///< nodes that lie apart from each other
};

double diagonal2(const Cluster& c) {
  return (vector_of(c.high) - vector_of(c.low)).squaredNorm();
}

/// A node is one lamp unless the boxes of its children leave most of its own empty.
void add_lamps(const ClusterTree& tree, std::uint32_t node, std::vector<std::uint32_t>& lamps) {
  const Cluster& c = tree.nodes[node];
  double of_children = 0.0;
  for (std::uint32_t k = 0; k < c.child_count; ++k)
    of_children += diagonal2(tree.nodes[c.first_child + k]);
  // Of a square cut into four the sum is that of the square, of a cube cut into eight twice, of a rod half.
  constexpr double one_piece = 0.45;
  if (c.child_count < 2 || of_children >= one_piece * diagonal2(c)) {
    lamps.push_back(node);
    return;
  }
  for (std::uint32_t k = 0; k < c.child_count && lamps.size() <= most_lamps; ++k)
    add_lamps(tree, c.first_child + k, lamps);
}

Lamps lamps_of(View<Splat> points, const DeviceLighting& lighting) {
  std::vector<Splat> shining;
  for (const Emitter& e : lighting.emitters)
    shining.push_back(points[e.point]);
  Lamps lamps{build_clusters(shining, {}), {}, {}};
  for (const Cluster& c : lamps.tree.nodes) {
    Vector flux = Vector::Zero();
    for (std::uint32_t i = c.first_point; i < c.first_point + c.count; ++i) {
      const Splat& splat = lamps.tree.points[i];
      flux += vector_of(lighting.materials[material_of(splat)].emission) * double{splat.area};
    }
    lamps.flux.push_back(flux);
  }
  add_lamps(lamps.tree, 0, lamps.lamps);
  return lamps;
}

/// With what its discs reach beyond their centres.
Cluster with_radius(const Cluster& lamp, const std::vector<Splat>& points) {
  Cluster c = lamp;
  for (std::uint32_t i = lamp.first_point; i < lamp.first_point + lamp.count; ++i)
    for (int k = 0; k < 3; ++k) {
      const float reach = points[i].radius * std::hypot(points[i].normal[(k + 1) % 3], points[i].normal[(k + 2) % 3]);
      c.low[k] = std::min(c.low[k], points[i].position[k] - reach);
      c.high[k] = std::max(c.high[k], points[i].position[k] + reach);
    }
  return c;
}

/// Where the light of a [[light]] may come from that reaches a cluster: a point, or the cluster's box shifted out of
/// the cube, wider by the disc that is seen there.
Cluster source_for(const LightSource& light, const Cluster& from) {
  Cluster c{};
  const bool is_near = light.type == LIGHT_POINT;
  const double sine = std::sqrt(double{light.sine2}), widening = across_cube * sine / std::sqrt(1.0 - light.sine2);
  for (int k = 0; k < 3; ++k) {
    const double shift = across_cube * light.vector[k];
    c.low[k] = is_near ? light.vector[k] : static_cast<float>(from.low[k] + shift - widening);
    c.high[k] = is_near ? light.vector[k] : static_cast<float>(from.high[k] + shift + widening);
    c.centre[k] = 0.5f * (c.low[k] + c.high[k]);
  }
  c.count = 1;
  c.radius = static_cast<float>(0.5 * std::sqrt(diagonal2(c)));
  c.axis[2] = 1.0f;
  c.cone = static_cast<float>(pi); // of no surface
  return c;
}

enum class Sight { hidden, open, unknown };

class PointLight {
public:
  PointLight(View<Splat> points, const DeviceLighting& lighting, const Shafts& shafts)
      : lighting_(lighting), shafts_(shafts) {
    if (lighting.emitters.empty()) return;
    lamps_ = lamps_of(points, lighting);
    for (const std::uint32_t lamp : lamps_->lamps)
      boxes_.push_back(with_radius(lamps_->tree.nodes[lamp], lamps_->tree.points));
  }

  std::size_t lamps() const { return boxes_.size() + lighting_.light_sources.size(); }
  const Shafts& shafts() const { return shafts_; }

  /// What of every lamp the discs of `from` see: all or nothing, or it is unknown.
  bool is_known(const Cluster& from, std::vector<std::uint8_t>& shines) const {
    shines.assign(lamps(), 0);
    for (std::size_t k = 0; k < boxes_.size(); ++k) {
      const Sight sight = of_lamp(from, boxes_[k]);
      if (sight == Sight::unknown) return false;
      shines[k] = sight == Sight::open ? 1 : 0;
    }
    for (std::size_t k = 0; k < lighting_.light_sources.size(); ++k) {
      const Sight sight = of_source(from, lighting_.light_sources[k]);
      if (sight == Sight::unknown) return false;
      shines[boxes_.size() + k] = sight == Sight::open ? 1 : 0;
    }
    return true;
  }

  /// Of the lamps that shine on it; nothing where a disc of one is too near to be summed over.
  std::optional<Vector> irradiance(const Splat& at, const std::vector<std::uint8_t>& shines) const {
    Vector sum = Vector::Zero();
    const Vector position = vector_of(at.position), normal = vector_of(at.normal);
    for (std::size_t k = 0; k < boxes_.size(); ++k)
      if (shines[k] != 0 && !add_lamp(lamps_->lamps[k], position, normal, sum)) return std::nullopt;
    for (std::size_t k = 0; k < lighting_.light_sources.size(); ++k) {
      if (shines[boxes_.size() + k] == 0) continue;
      const LightSource& light = lighting_.light_sources[k];
      Vector towards = vector_of(light.vector);
      double falloff = 1.0;
      if (light.type == LIGHT_POINT) {
        towards -= position;
        falloff = 1.0 / towards.squaredNorm();
        towards.normalize();
      }
      sum += vector_of(light.strength) * (falloff * std::max(0.0, normal.dot(towards)));
    }
    return sum;
  }

  /// ShaftLight::change, by differences over the disc. `here`: irradiance() at its middle.
  Vector change(const Splat& at, const std::vector<std::uint8_t>& shines, const Vector& here) const {
    Vector gradient = Vector::Zero();
    if (!(here.sum() > 0.0)) return gradient;
    const Vector normal = vector_of(at.normal), tangent = normal.unitOrthogonal();
    for (const Vector& along : {tangent, Vector(normal.cross(tangent))}) {
      double ends[2];
      for (int side = 0; side < 2; ++side) {
        Splat moved = at;
        for (int k = 0; k < 3; ++k)
          moved.position[k] += static_cast<float>((side == 0 ? -1.0 : 1.0) * at.radius * along[k]);
        const std::optional<Vector> there = irradiance(moved, shines);
        ends[side] = there ? there->sum() : here.sum();
      }
      gradient += along * ((ends[1] - ends[0]) / (2.0 * at.radius * here.sum()));
    }
    return gradient;
  }

private:
  /// Whether a box is far enough for its light to change little over the discs.
  bool is_far(const Cluster& from, const Cluster& box) const {
    double apart2 = 0.0, radius = 0.0;
    for (std::uint32_t i = from.first_point; i < from.first_point + from.count; ++i)
      radius = std::max(radius, double{shafts_.tree().points[i].radius});
    for (int k = 0; k < 3; ++k) {
      const double apart = std::max({0.0, double{box.low[k]} - from.high[k], double{from.low[k]} - box.high[k]});
      apart2 += apart * apart;
    }
    return apart2 > far_lamp * far_lamp * radius * radius;
  }

  Sight of_lamp(const Cluster& from, const Cluster& lamp) const {
    const Facing there = facing(from, lamp), back = facing(lamp, from);
    if (there == Facing::none || back == Facing::none) return Sight::hidden;
    if (there != Facing::all || back != Facing::all || lamp.cone >= flat_lamp || !is_far(from, lamp))
      return Sight::unknown;
    return shafts_.is_open(from, lamp, true) ? Sight::open : Sight::unknown;
  }

  Sight of_source(const Cluster& from, const LightSource& light) const {
    const Cluster source = source_for(light, from);
    // Of shifted boxes the directions between them are no longer told by the boxes: the cosine of all of them is.
    if (light.type == LIGHT_POINT) {
      const Facing there = facing(from, source);
      if (there == Facing::none) return Sight::hidden;
      if (there != Facing::all || !is_far(from, source)) return Sight::unknown;
    } else {
      const double height = std::asin(std::clamp(vector_of(from.axis).dot(vector_of(light.vector)), -1.0, 1.0));
      const double spread = double{from.cone} + std::asin(std::sqrt(double{light.sine2})) + 1e-4;
      if (height + spread < 0.0) return Sight::hidden;
      if (height - spread < 0.0) return Sight::unknown;
    }
    return shafts_.is_open(from, source, false) ? Sight::open : Sight::unknown;
  }

  bool add_lamp(std::uint32_t root, const Vector& position, const Vector& normal, Vector& sum) const {
    const ClusterTree& tree = lamps_->tree;
    std::vector<std::uint32_t> waiting{root};
    while (!waiting.empty()) {
      const std::uint32_t at = waiting.back();
      const Cluster& node = tree.nodes[at];
      waiting.pop_back();
      const Vector towards = vector_of(node.centre) - position;
      if (double{node.radius} * double{node.radius} < far_discs * far_discs * towards.squaredNorm()) {
        add(lamps_->flux[at], towards, vector_of(node.axis), normal, sum);
        continue;
      }
      for (std::uint32_t k = 0; k < node.child_count; ++k)
        waiting.push_back(node.first_child + k);
      for (std::uint32_t i = node.first_point; node.child_count == 0 && i < node.first_point + node.count; ++i) {
        const Splat& disc = tree.points[i];
        const Vector to_disc = vector_of(disc.position) - position;
        if (to_disc.squaredNorm() < near_disc * near_disc * double{disc.radius} * double{disc.radius}) return false;
        add(vector_of(lighting_.materials[material_of(disc)].emission) * double{disc.area}, to_disc,
            vector_of(disc.normal), normal, sum);
      }
    }
    return true;
  }

  /// flux: radiance times area.
  static void add(const Vector& flux, const Vector& towards, const Vector& axis, const Vector& normal, Vector& sum) {
    const double d2 = towards.squaredNorm(), cosines = normal.dot(towards) * -axis.dot(towards) / d2;
    sum += flux * (std::max(0.0, cosines) / d2);
  }

  const DeviceLighting& lighting_;
  const Shafts& shafts_;
  std::optional<Lamps> lamps_;
  std::vector<Cluster> boxes_;
};

/// Whether the discs that overlap with a point's, of its surface, face as it does.
bool is_smooth_at(const Shafts& shafts, std::uint32_t point) {
  const ClusterTree& tree = shafts.tree();
  const Cluster disc = shafts.disc(point);
  const Splat& own = tree.points[point];
  return shafts.for_each_near(disc.low, disc.high, [&](std::uint32_t i) {
    const Splat& other = tree.points[i];
    const double reach = double{own.radius} + other.radius;
    if ((vector_of(other.position) - vector_of(own.position)).squaredNorm() > reach * reach) return true;
    const double cosine = vector_of(own.normal).dot(vector_of(other.normal));
    return cosine > flat_cosine || cosine < same_surface;
  });
}

/// Whether all points that face about as those of the leaf do are dark, within two radii about it.
template <class IsDark>
bool is_dark_about(const Shafts& shafts, std::uint32_t leaf, const IsDark& is_dark) {
  const ClusterTree& tree = shafts.tree();
  const Cluster discs = shafts.with_discs(leaf);
  float radius = 0.0f, low[3], high[3];
  for (std::uint32_t i = discs.first_point; i < discs.first_point + discs.count; ++i)
    radius = std::max(radius, tree.points[i].radius);
  for (int k = 0; k < 3; ++k) {
    low[k] = discs.low[k] - radius; // with_discs() has the first radius
    high[k] = discs.high[k] + radius;
  }
  const Vector axis = vector_of(discs.axis);
  return shafts.for_each_near(low, high, [&](std::uint32_t i) {
    const Splat& disc = tree.points[i];
    for (int k = 0; k < 3; ++k)
      if (disc.position[k] + disc.radius < low[k] || disc.position[k] - disc.radius > high[k]) return true;
    constexpr double alike = 0.5;
    return is_dark(i) || vector_of(disc.normal).dot(axis) < alike;
  });
}

} // namespace

ShaftLight light_through_shafts(View<Splat> points, const DeviceLighting& lighting) {
  ShaftLight light{std::vector<float>(3 * points.size),
                   std::vector<float>(3 * points.size),
                   std::vector<std::uint8_t>(points.size),
                   {},
                   0};
  if (points.size == 0) return light;
  light.shafts = std::make_shared<const Shafts>(points);
  const PointLight of(points, lighting, *light.shafts);
  if (of.lamps() == 0 || of.lamps() > most_lamps) return light;
  const ClusterTree& tree = of.shafts().tree();
  std::vector<std::uint32_t> leaves;
  for (std::uint32_t k = 0; k < tree.nodes.size(); ++k)
    if (tree.nodes[k].child_count == 0) leaves.push_back(k);
  constexpr std::size_t leaves_a_range = 64;
  parallel_ranges(leaves.size(), leaves_a_range, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint8_t> shines;
    for (std::size_t l = begin; l < end; ++l) {
      const Cluster& leaf = tree.nodes[leaves[l]];
      const bool together = of.is_known(of.shafts().with_discs(leaves[l]), shines);
      for (std::uint32_t i = leaf.first_point; i < leaf.first_point + leaf.count; ++i) {
        if (!together && !of.is_known(of.shafts().disc(i), shines)) continue;
        const std::optional<Vector> sum = of.irradiance(tree.points[i], shines);
        if (!sum || (!sum->isZero() && leaf.cone > 0.0f && !is_smooth_at(of.shafts(), i))) continue;
        const Vector change = of.change(tree.points[i], shines, *sum);
        const std::uint32_t at = tree.order[i];
        light.known[at] = 1;
        for (int c = 0; c < 3; ++c) {
          light.irradiance[3 * at + static_cast<std::size_t>(c)] = static_cast<float>((*sum)[c]);
          light.change[3 * at + static_cast<std::size_t>(c)] = static_cast<float>(change[c]);
        }
      }
    }
  });
  light.known_points = static_cast<std::size_t>(std::count(light.known.begin(), light.known.end(), 1));
  return light;
}

void add_light_by_rays(View<float> by_rays, ShaftLight& light) {
  if (light.shafts == nullptr) return;
  const std::shared_ptr<const Shafts> shafts = std::move(light.shafts);
  const ClusterTree& tree = shafts->tree();
  for (std::size_t i = 0; i < light.known.size(); ++i)
    if (light.known[i] == 0) std::copy_n(by_rays.data + 3 * i, 3, light.irradiance.data() + 3 * i);
  const auto is_dark = [&](std::uint32_t point) {
    const float* h = &light.irradiance[3 * std::size_t{tree.order[point]}];
    return h[0] == 0.0f && h[1] == 0.0f && h[2] == 0.0f;
  };
  std::vector<std::uint32_t> dark;
  for (std::uint32_t k = 0; k < tree.nodes.size(); ++k) {
    const Cluster& leaf = tree.nodes[k];
    if (leaf.child_count != 0) continue;
    bool unknown = false, all_dark = true;
    for (std::uint32_t i = leaf.first_point; i < leaf.first_point + leaf.count; ++i) {
      unknown = unknown || light.known[tree.order[i]] == 0;
      all_dark = all_dark && is_dark(i);
    }
    if (unknown && all_dark && is_dark_about(*shafts, k, is_dark)) dark.push_back(k);
  }
  for (const std::uint32_t k : dark)
    for (std::uint32_t i = tree.nodes[k].first_point; i < tree.nodes[k].first_point + tree.nodes[k].count; ++i)
      light.known[tree.order[i]] = 1;
  light.known_points = static_cast<std::size_t>(std::count(light.known.begin(), light.known.end(), 1));
}

} // namespace pointgi
