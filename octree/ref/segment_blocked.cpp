#include "octree/ref/segment_blocked.h"
#include "octree/parallel.h"
#include "shared/traversal_types.h"
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace pointgi {

namespace {

using Vector = Eigen::Vector3d;

Vector vector_of(const float v[3]) {
  return {v[0], v[1], v[2]};
}

/// Whether a hit at distance t from a segment's end belongs to the surface there. `away`: from the end.
bool belongs_to_end(const Splat& end, const Splat& hit, const Vector& away, double t) {
  const double radii = static_cast<double>(end.radius) + hit.radius;
  double cosine = vector_of(hit.normal).dot(vector_of(end.normal)), along = vector_of(hit.normal).dot(away);
  if (is_flat(hit) && t * std::abs(along) > FLAT_HEIGHT) return false;
  if (is_sheet(hit)) {
    if (cosine < 0.0 && t * std::abs(along) < SHEET_HEIGHT * radii) { // the other side speaks for both
      cosine = -cosine;
      along = -along;
    }
    if (along < 0.0 && t > ARRIVAL_DISTANCE * hit.radius) return false;
  }
  const double steepness = std::max(1.0, SELF_HIT_REACH / SELF_HIT_HEIGHT * std::abs(vector_of(end.normal).dot(away)));
  return (steepness * t < SELF_HIT_REACH * radii && cosine > SELF_HIT_COSINE) ||
         (t < COINCIDENT(end.radius + hit.radius) && cosine < -SELF_HIT_COSINE);
}

} // namespace

bool segment_blocked(View<Splat> splats, const Splat& from, const Splat& to) {
  const Vector origin = vector_of(from.position), between = vector_of(to.position) - origin;
  const double length = between.norm();
  const Vector direction = between / length;
  const double margin = SEGMENT_MARGIN(from.radius + to.radius);
  for (const Splat& s : splats) {
    const Vector normal = vector_of(s.normal), offset = vector_of(s.position) - origin;
    const double t = normal.dot(offset) / normal.dot(direction);
    if (!(t > -margin && t < length + margin)) continue;
    if ((t * direction - offset).squaredNorm() > static_cast<double>(s.radius) * s.radius) continue;
    if (!belongs_to_end(from, s, direction, t) && !belongs_to_end(to, s, -direction, length - t)) return true;
  }
  return false;
}

std::vector<std::uint8_t> LinearScan::blocked(View<Segment> segments) {
  std::vector<std::uint8_t> answers(segments.size);
  parallel_ranges(segments.size, 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      answers[i] = segment_blocked(splats_, points_[segments[i].from], points_[segments[i].to]);
  });
  return answers;
}

} // namespace pointgi
