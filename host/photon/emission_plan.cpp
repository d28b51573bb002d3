#include "host/photon/emission_plan.h"
#include "host/lights/light_kind.h"
#include "octree/mixed_bits.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace pointgi {

namespace {

using Vector = Eigen::Vector3d;

constexpr double pi = 3.14159265358979323846;
/// K: segments from a source to a leaf; and what a pair gets for which all are blocked.
constexpr std::size_t segments_a_pair = 8;
constexpr double share_of_hidden = 1.0 / 8.0;
/// Points of the emitters that stand for all of them when numbers of photons are chosen.
constexpr std::size_t emitter_samples = 16;
/// A leaf that lies below an emitter's horizon is not given up, as other emitters may see it.
constexpr double least_cosine = 0.05;
/// Of the photons that are aimed at leaves, at least this share is taken to hit them.
constexpr double least_hits = 0.25;

Vector vector(const float v[3]) {
  return {v[0], v[1], v[2]};
}
double luminance(const float c[3]) {
  return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
}

bool is_far(const LightSource& light) {
  return kind_of(static_cast<LightType>(light.type)).is_far;
}

/// A source as it is seen from a leaf: luminance of its flux, root cube units.
struct Flux {
  double sphere = 0.0; ///< into the leaf's sphere
  double leaf = 0.0;   ///< onto its splats, were none hidden: at most that
  double disc = 0.0;   ///< through its average disc (method.md §5)
};

struct Leaf {
  Vector centre, axis;
  double radius, area;

  /// Light of radiant intensity 1 from x.
  Flux from_point(const Vector& x) const {
    const Vector to = centre - x;
    const double d2 = to.squaredNorm(), r2 = radius * radius;
    if (d2 <= r2) return {4.0 * pi, 4.0 * pi, 4.0 * pi};
    const double s2 = r2 / d2, cosine = std::fabs(axis.dot(to)) / std::sqrt(d2);
    const double cone = 2.0 * pi * s2 / (1.0 + std::sqrt(1.0 - s2));
    return {cone, std::min(cone, area * cosine / d2), pi * s2 * cosine};
  }
  /// Light of irradiance 1 from one direction.
  Flux from_direction(const Vector& towards) const {
    const double r2 = radius * radius, cosine = std::fabs(axis.dot(towards));
    return {pi * r2, std::min(pi * r2, area * cosine), pi * r2 * cosine};
  }
  /// Light of radiance 1 from everywhere.
  Flux from_everywhere() const {
    const double r2 = radius * radius;
    return {4.0 * pi * pi * r2, 2.0 * pi * std::min(area, 2.0 * pi * r2), 2.0 * pi * pi * r2};
  }
};

Leaf leaf_of(const SpecularLeaves& leaves, std::size_t k) {
  return {vector(leaves.leaves[k].centre), vector(&leaves.axis[3 * k]), double{leaves.leaves[k].radius},
          double{leaves.area[k]}};
}

Flux scaled(const Flux& f, double by) {
  return {f.sphere * by, f.leaf * by, f.disc * by};
}

/// The emitters that stand for all: spread over their shares.
std::vector<std::uint32_t> emitters_for_all(const PhotonSources& sources) {
  std::vector<std::uint32_t> chosen;
  for (std::size_t k = 0; k < emitter_samples && !sources.emitters.empty(); ++k) {
    const float at = (static_cast<float>(k) + 0.5f) / static_cast<float>(emitter_samples);
    const auto found = std::upper_bound(sources.emitters.begin(), sources.emitters.end(), at,
                                        [](float u, const Emitter& e) { return u < e.cumulative; });
    chosen.push_back(std::min(found, sources.emitters.end() - 1)->point);
  }
  return chosen;
}

struct Pair {
  pg_uint source, leaf;
  Flux flux;
  bool visible = true;
};

/// All sources and all leaves, and who sees whom.
class Pairs {
public:
  Pairs(const SpecularLeaves& leaves, View<Splat> points, const PhotonSources& sources)
      : leaves_(leaves), points_(points), sources_(sources), emitters_(emitters_for_all(sources)) {
    for (std::size_t e = 0; e < sources.emitters.size(); ++e)
      emitted_ += luminance(sources.radiance[e].data()) * points[sources.emitters[e].point].area;
    for (std::size_t k = 0; k < leaves.leaves.size(); ++k) {
      const auto leaf = static_cast<pg_uint>(k);
      for (std::size_t s = 0; s < sources.light_sources.size(); ++s)
        pairs_.push_back({static_cast<pg_uint>(s), leaf, from_source(sources.light_sources[s], leaf_of(leaves, k))});
      if (emitted_ > 0.0) pairs_.push_back({SOURCE_EMITTERS, leaf, from_emitters(leaf_of(leaves, k))});
      if (sources.has_environment())
        pairs_.push_back({SOURCE_ENVIRONMENT, leaf,
                          scaled(leaf_of(leaves, k).from_everywhere(), luminance(sources.environment.data()))});
    }
  }

  std::vector<Pair> take(const AskSegments& ask) {
    for (std::size_t begin = 0; begin < pairs_.size(); begin += most_photon_pairs)
      test_visibility(begin, std::min(begin + most_photon_pairs, pairs_.size()), ask);
    return std::move(pairs_);
  }

private:
  Flux from_source(const LightSource& light, const Leaf& leaf) const {
    const Flux flux = is_far(light) ? leaf.from_direction(vector(light.vector)) : leaf.from_point(vector(light.vector));
    return scaled(flux, luminance(light.strength));
  }

  /// A diffuse emitter of power pi L A has the intensity L A cos.
  Flux from_emitters(const Leaf& leaf) const {
    Flux sum;
    for (const std::uint32_t point : emitters_) {
      const Vector x = vector(points_[point].position), to = leaf.centre - x;
      const double cosine = to.norm() > leaf.radius ? vector(points_[point].normal).dot(to) / to.norm() : 1.0;
      const Flux flux = scaled(leaf.from_point(x), emitted_ * std::max(cosine, least_cosine) / emitter_samples);
      sum = {sum.sphere + flux.sphere, sum.leaf + flux.leaf, sum.disc + flux.disc};
    }
    return sum;
  }

  /// A table's entry that is nobody's surface.
  static Splat free_point(const Vector& x) {
    Splat splat{};
    for (int a = 0; a < 3; ++a)
      splat.position[a] = static_cast<float>(x[a]);
    return splat;
  }

  /// Where light of the pair's source for a splat of its leaf comes from.
  Splat origin(const Pair& pair, std::size_t k, const Splat& target) const {
    if (pair.source == SOURCE_EMITTERS) return points_[emitters_[k * emitter_samples / segments_a_pair]];
    const LightSource& light = sources_.light_sources[pair.source];
    if (!is_far(light)) return free_point(vector(light.vector));
    return free_point(vector(target.position) + 2.0 * vector(light.vector)); // outside the root cube
  }

  void test_visibility(std::size_t begin, std::size_t end, const AskSegments& ask) {
    std::vector<Splat> table;
    std::vector<Segment> segments;
    std::vector<std::size_t> of;
    for (std::size_t p = begin; p < end; ++p) {
      if (pairs_[p].source == SOURCE_ENVIRONMENT) continue; // some of it is nearly always seen
      const PhotonLeaf& leaf = leaves_.leaves[pairs_[p].leaf];
      pairs_[p].visible = false;
      for (std::size_t k = 0; k < segments_a_pair; ++k) {
        const Splat& target = points_[leaves_.splats[leaf.first + (2 * k + 1) * leaf.count / (2 * segments_a_pair)]];
        table.push_back(origin(pairs_[p], k, target));
        table.push_back(target);
        const auto at = static_cast<pg_uint>(table.size());
        segments.push_back({at - 2, at - 1});
        of.push_back(p);
      }
    }
    if (segments.empty()) return;
    const std::vector<std::uint8_t> blocked = ask(table, segments);
    for (std::size_t i = 0; i < segments.size(); ++i)
      pairs_[of[i]].visible |= blocked[i] == 0;
  }

  const SpecularLeaves& leaves_;
  View<Splat> points_;
  const PhotonSources& sources_;
  std::vector<std::uint32_t> emitters_;
  double emitted_ = 0.0; ///< sum of radiance times area
  std::vector<Pair> pairs_;
};

/// `photons` in proportion to weight(pair), whole numbers that add up to it: those of all pairs laid end to end, cut at
/// every whole number, from a random start.
template <typename Weight>
void deal_out(const std::vector<Pair>& pairs, double photons, std::uint32_t seed, const Weight& weight,
              bool equal_power, EmissionPlan& plan) {
  double total = 0.0;
  for (const Pair& pair : pairs)
    total += weight(pair);
  if (!(total > 0.0) || !(photons > 0.0)) return;
  const double start = uniform_of(seed);
  double sum = 0.0, before = std::floor(start);
  for (const Pair& pair : pairs) {
    const double expected = photons * (weight(pair) / total);
    sum += expected;
    const double after = std::floor(sum + start), count = after - before;
    before = after;
    if (!(count >= 1.0)) continue;
    EmissionBatch batch{};
    batch.first = plan.photons;
    batch.count = static_cast<pg_uint>(count);
    batch.source = pair.source;
    batch.leaf = pair.leaf;
    batch.share = static_cast<float>(equal_power ? total / photons : expected >= 1.0 ? 1.0 / count : 1.0 / expected);
    plan.batches.push_back(batch);
    plan.photons += batch.count;
  }
}

} // namespace

EmissionPlan plan_emission(const SpecularLeaves& leaves, View<Splat> points, const PhotonSources& sources,
                           const AskSegments& ask, const EmissionOptions& options) {
  EmissionPlan plan;
  if (options.photons == 0 || leaves.leaves.empty()) return plan;
  const std::vector<Pair> pairs = Pairs(leaves, points, sources).take(ask);
  const auto photons = static_cast<double>(options.photons);
  if (options.equal_power) {
    deal_out(
        pairs, photons, options.seed, [](const Pair& p) { return p.visible ? p.flux.disc : 0.0; }, true, plan);
    return plan;
  }
  const auto weight = [](const Pair& p) { return p.flux.sphere * (p.visible ? 1.0 : share_of_hidden); };
  double aimed = 0.0, hits = 0.0;
  for (const Pair& pair : pairs) {
    aimed += weight(pair);
    hits += pair.visible ? pair.flux.leaf : 0.0;
  }
  deal_out(pairs, std::round(photons * aimed / std::max(hits, least_hits * aimed)), options.seed, weight, false, plan);
  return plan;
}

} // namespace pointgi
