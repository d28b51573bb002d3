#include "octree/vmap/pair_samples.h"
#include "octree/parallel.h"
#include <algorithm>
#include <cmath>
#include <limits>

namespace pointgi {

namespace {

/// Candidates for each segment of towards(), where a cluster has more points than that.
constexpr std::uint32_t candidates = 8, most_candidates = 64;

/// Steele, Lea and Flood, "Fast splittable pseudorandom number generators" (2014): the finaliser of splitmix64.
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// The bits of k mirrored at the binary point: van der Corput's sequence, in [0, 1).
double mirrored_bits(std::uint32_t k) {
  std::uint32_t bits = 0;
  for (int b = 0; b < 32; ++b)
    bits |= ((k >> b) & 1u) << (31 - b);
  return bits * 0x1p-32;
}

double turned(double x, double by) {
  return x + by - std::floor(x + by);
}

} // namespace

bool face_each_other(const Splat& a, const Splat& b) {
  float before_a = 0.0f, before_b = 0.0f;
  for (int k = 0; k < 3; ++k) {
    const float d = b.position[k] - a.position[k];
    before_a += a.normal[k] * d;
    before_b -= b.normal[k] * d;
  }
  return before_a > 0.0f && before_b > 0.0f;
}

float exchange_weight(const Splat& at, const Splat& from) {
  float before_at = 0.0f, before_from = 0.0f, d2 = 0.0f;
  for (int k = 0; k < 3; ++k) {
    const float d = from.position[k] - at.position[k];
    before_at += at.normal[k] * d;
    before_from -= from.normal[k] * d;
    d2 += d * d;
  }
  if (!(before_at > 0.0f && before_from > 0.0f)) return 0.0f;
  return (before_at / d2) * (before_from / (d2 + 0.318309886f * from.area)) * from.area;
}

PairSamples::PairSamples(const ClusterTree& tree, std::uint32_t seed, bool thesis)
    : tree_(tree), seed_(seed), area_before_(tree.points.size() + 1), central_(thesis ? tree.nodes.size() : 0) {
  for (std::size_t i = 0; i < tree.points.size(); ++i)
    area_before_[i + 1] = area_before_[i] + static_cast<double>(tree.points[i].area);
  parallel_ranges(central_.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const Cluster& c = tree.nodes[n];
      float least = std::numeric_limits<float>::infinity();
      for (std::uint32_t i = c.first_point; i < c.first_point + c.count; ++i) {
        float distance2 = 0.0f;
        for (int a = 0; a < 3; ++a) {
          const float d = tree.points[i].position[a] - c.centre[a];
          distance2 += d * d;
        }
        if (distance2 < least) {
          least = distance2;
          central_[n] = i;
        }
      }
    }
  });
}

std::uint32_t PairSamples::point_at(const Cluster& c, double share) const {
  const auto first = area_before_.begin() + c.first_point, last = first + c.count;
  const auto at = std::upper_bound(first + 1, last, *first + share * (*last - *first));
  return static_cast<std::uint32_t>(at - area_before_.begin()) - 1;
}

std::uint32_t PairSamples::stratified(std::uint32_t a, std::uint32_t b, std::uint32_t count, std::uint32_t salt,
                                      std::vector<Segment>& out) const {
  const Cluster &from = tree_.nodes[a], &to = tree_.nodes[b];
  const std::uint64_t random =
      mixed(mixed((static_cast<std::uint64_t>(a) << 32) | b) ^ ((static_cast<std::uint64_t>(salt) << 32) | seed_));
  const double turn_from = static_cast<double>(random >> 32) * 0x1p-32;
  const double turn_to = static_cast<double>(random & 0xffffffffu) * 0x1p-32;
  std::uint32_t taken = 0;
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::uint32_t i = point_at(from, turned(static_cast<double>(k) / count, turn_from));
    const std::uint32_t j = point_at(to, turned(mirrored_bits(k), turn_to));
    if (!face_each_other(tree_.points[i], tree_.points[j])) continue;
    out.push_back({i, j});
    ++taken;
  }
  return taken;
}

std::uint32_t PairSamples::towards(std::uint32_t point, std::uint32_t b, std::uint32_t count, std::uint32_t salt,
                                   std::vector<Segment>& out) const {
  const Cluster& from = tree_.nodes[b];
  const Splat& at = tree_.points[point];
  const std::uint64_t random =
      mixed(mixed((static_cast<std::uint64_t>(point) << 32) | b) ^ ((static_cast<std::uint64_t>(salt) << 32) | seed_));
  const double turn = static_cast<double>(random >> 32) * 0x1p-32;
  const float draw = static_cast<float>(random & 0xffffffu) * 0x1p-24f;
  const std::uint32_t looked_at = std::min({from.count, candidates * count, most_candidates});
  std::uint32_t chosen[most_candidates];
  float sums[most_candidates], sum = 0.0f;
  for (std::uint32_t k = 0; k < looked_at; ++k) {
    // All of them, or some by area, and then their areas count no more.
    chosen[k] = looked_at == from.count ? from.first_point + k
                                        : point_at(from, turned(static_cast<double>(k) / looked_at, turn));
    const Splat& candidate = tree_.points[chosen[k]];
    const float weight = exchange_weight(at, candidate);
    sum += looked_at == from.count || weight == 0.0f ? weight : weight / candidate.area;
    sums[k] = sum;
  }
  if (!(sum > 0.0f)) return 0;
  std::uint32_t at_sum = 0;
  for (std::uint32_t k = 0; k < count; ++k) {
    const float want = sum * (static_cast<float>(k) + draw) / static_cast<float>(count);
    while (at_sum + 1 < looked_at && sums[at_sum] <= want)
      ++at_sum;
    out.push_back({point, chosen[at_sum]});
  }
  return count;
}

std::uint32_t PairSamples::exhaustive(std::uint32_t a, std::uint32_t b, std::uint32_t count,
                                      std::vector<Segment>& out) const {
  const Cluster &from = tree_.nodes[a], &to = tree_.nodes[b];
  std::vector<Segment> all;
  for (std::uint32_t i = from.first_point; i < from.first_point + from.count; ++i)
    for (std::uint32_t j = to.first_point; j < to.first_point + to.count; ++j)
      if (face_each_other(tree_.points[i], tree_.points[j])) all.push_back({i, j});
  const std::size_t taken = std::min<std::size_t>(count, all.size());
  for (std::size_t k = 0; k < taken; ++k)
    out.push_back(all[k * all.size() / taken]);
  return static_cast<std::uint32_t>(taken);
}

std::uint32_t PairSamples::central(std::uint32_t a, std::uint32_t b, std::vector<Segment>& out) const {
  out.push_back({central_[a], central_[b]});
  return 1;
}

} // namespace pointgi
