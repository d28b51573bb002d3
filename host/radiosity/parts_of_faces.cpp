#include "host/radiosity/parts_of_faces.h"
#include "host/cloud/knn.h"
#include "octree/parallel.h"
#include <Eigen/Core>
#include <algorithm>
#include <numeric>

namespace pointgi {

namespace {

/// Neighbours that a point looks at: those around it in a grid.
constexpr unsigned neighbours = 8;
/// Farther apart than this, in units of both radii, two points are no neighbours.
constexpr double reach = 1.5;
/// How high above the face, in radii: under what hangs close before it, over what is joined to it by rounding.
constexpr float height = 0.05f;
/// What hangs before a face up to here, in radii, covers it: farther off, neighbours see nearly the same of the light.
constexpr float cover = 4.0f;
constexpr double same_direction = 1e-6;
constexpr std::size_t grain = 4096;

using Vector = Eigen::Vector3d;

Vector position_of(const Splat& s) {
  return {s.position[0], s.position[1], s.position[2]};
}
Vector normal_of(const Splat& s) {
  return {s.normal[0], s.normal[1], s.normal[2]};
}

bool are_neighbours(const Splat& a, const Splat& b) {
  const Vector between = position_of(b) - position_of(a);
  return is_flat(b) && normal_of(a).dot(normal_of(b)) > 1.0 - same_direction &&
         std::abs(normal_of(a).dot(between)) < FLAT_HEIGHT && between.norm() < reach * (a.radius + b.radius);
}

Splat lifted_by(const Splat& s, float radii) {
  Splat lifted = s;
  for (int k = 0; k < 3; ++k)
    lifted.position[k] += radii * s.radius * s.normal[k];
  return lifted;
}

/// Sets that join, each named by its lowest member.
class Sets {
public:
  explicit Sets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t of(std::uint32_t i) {
    while (parent_[i] != i)
      i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = of(a), b = of(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

private:
  std::vector<std::uint32_t> parent_;
};

} // namespace

std::vector<std::uint32_t> parts_of_faces(View<Splat> points, const AskSegments& ask) {
  std::vector<std::uint32_t> flat;
  std::vector<Vector> positions;
  for (std::uint32_t i = 0; i < points.size; ++i)
    if (is_flat(points[i])) {
      flat.push_back(i);
      positions.push_back(position_of(points[i]));
    }
  if (flat.empty()) return {};
  const auto count = static_cast<std::uint32_t>(flat.size());
  std::vector<Splat> ends; // a little above each point, then above what may cover it
  for (const float radii : {height, cover})
    for (const std::uint32_t i : flat)
      ends.push_back(lifted_by(points[i], radii));
  const Sites sites(positions);
  std::vector<std::vector<Segment>> asked((sites.size() + grain - 1) / grain);
  parallel_ranges(sites.size(), grain, [&](std::size_t begin, std::size_t end) {
    Neighbour near[neighbours];
    const auto ask_pair = [&](std::uint32_t a, std::uint32_t b) {
      if (a < b && are_neighbours(points[flat[a]], points[flat[b]])) asked[begin / grain].push_back({a, b});
    };
    for (auto site = static_cast<std::uint32_t>(begin); site < end; ++site) {
      const unsigned found = sites.nearest(site, neighbours, near);
      for (const std::uint32_t a : sites.points(site)) {
        if (a != *sites.points(site).begin()) ask_pair(*sites.points(site).begin(), a); // not each with each
        for (unsigned k = 0; k < found; ++k)
          for (const std::uint32_t b : sites.points(near[k].site)) {
            ask_pair(a, b);
            ask_pair(b, a);
          }
      }
    }
  });
  std::vector<Segment> segments;
  for (std::uint32_t k = 0; k < count; ++k)
    segments.push_back({k, count + k});
  for (std::vector<Segment>& part : asked) {
    segments.insert(segments.end(), part.begin(), part.end());
    part = {};
  }
  // Neighbours of each other were found from both sides.
  const auto pair_of = [](const Segment& s) { return std::pair(s.from, s.to); };
  std::sort(segments.begin() + count, segments.end(),
            [&](const Segment& a, const Segment& b) { return pair_of(a) < pair_of(b); });
  segments.erase(std::unique(segments.begin() + count, segments.end(),
                             [&](const Segment& a, const Segment& b) { return pair_of(a) == pair_of(b); }),
                 segments.end());
  const std::vector<std::uint8_t> blocked = ask(ends, segments);
  Sets sets(count);
  for (std::size_t k = count; k < segments.size(); ++k)
    if (blocked[k] == 0 && blocked[segments[k].from] == blocked[segments[k].to])
      sets.join(segments[k].from, segments[k].to);
  std::vector<std::uint32_t> part(points.size);
  for (std::uint32_t k = 0; k < count; ++k)
    part[flat[k]] = sets.of(k);
  return part;
}

} // namespace pointgi
