#include "host/cloud/readers/mesh_sample.h"
#include "host/cloud/mesh_borders.h"
#include "host/run.h"
#include "octree/parallel.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace pointgi {

using Eigen::Vector3d;
using Eigen::Vector3f;

namespace {

/// Points are tried in this many times the wanted number. More fill the last gaps but cost time: on a square the widest
/// gap falls from 1.1 spacings at 8 to 0.9 at 16 and 0.8 at 64.
constexpr int tries_per_point = 16;
/// Closest distance allowed, in units of the mean spacing sqrt(area / wanted); chosen by measurement such that the
/// wanted number results to 10 % (0.90 to 1.06 of it on a square and a cube).
constexpr double closest_in_spacings = 0.78;

/// How far off a border is looked for, in mean spacings: no disc is larger.
constexpr double border_reach = 2.0;

Vector3d area_vector(const MeshTriangle& t) {
  return 0.5 * (t.position[1] - t.position[0]).cross(t.position[2] - t.position[0]);
}

/// Evenly spread points of the unit cube: multiples of powers of 1/g, g^4 = g + 1 (the R3 sequence).
std::array<double, 3> spread(std::uint64_t index) {
  constexpr double g = 1.2207440846057596;
  std::array<double, 3> point{};
  double step = 1.0;
  for (double& coordinate : point) {
    step /= g;
    const double value = 0.5 + step * static_cast<double>(index);
    coordinate = value - std::floor(value);
  }
  return point;
}

struct Candidate {
  Vector3d position;
  Vector3d facing; ///< unit normal of the triangle
  std::size_t triangle;
  std::array<double, 3> weight; ///< barycentric
};

/// Accepted points by cells as wide as the closest distance, in a hash table of chains. Two cells that share a chain
/// cost a distance test and no more.
class Occupied {
public:
  Occupied(double closest, const Vector3d& origin, std::size_t expected) : closest_(closest), origin_(origin) {
    std::size_t size = 64;
    while (size < 2 * expected)
      size *= 2;
    heads_.assign(size, nobody);
  }

  /// Adds the point unless another on the same side of the sheet is closer than allowed.
  bool try_add(const Vector3d& p, const Vector3d& facing) {
    // Parts may lie farther from each other than numbers of cells go; there, far beyond what doubles tell apart, all
    // cells are one.
    constexpr double most = 4e18;
    const Eigen::Matrix<std::int64_t, 3, 1> cell =
        ((p - origin_) / closest_).array().floor().min(most).matrix().cast<std::int64_t>();
    for (std::int64_t n = 0; n < 27; ++n) {
      // From the point's own cell outwards: nearly all candidates are refused, and most of them there.
      const std::int64_t k = (n + 13) % 27;
      const std::size_t chain = chain_of(cell.x() + k % 3 - 1, cell.y() + k / 3 % 3 - 1, cell.z() + k / 9 - 1);
      for (std::uint32_t i = heads_[chain]; i != nobody; i = points_[i].next)
        // The other side of a thin wall faces away: its points don't count. -0.5 lets the sides of a right-angled and
        // of a 60-degree edge count as neighbours.
        if ((points_[i].position - p).squaredNorm() < closest_ * closest_ && points_[i].facing.dot(facing) > -0.5)
          return false;
    }
    const std::size_t chain = chain_of(cell.x(), cell.y(), cell.z());
    points_.push_back({p, facing, heads_[chain]});
    heads_[chain] = static_cast<std::uint32_t>(points_.size() - 1);
    return true;
  }

private:
  static constexpr std::uint32_t nobody = std::numeric_limits<std::uint32_t>::max();
  struct Point {
    Vector3d position, facing;
    std::uint32_t next;
  };

  std::size_t chain_of(std::int64_t x, std::int64_t y, std::int64_t z) const {
    // Teschner et al. 2003, with a last mix so that the low bits depend on all of the key.
    std::uint64_t key = (static_cast<std::uint64_t>(x) * 73856093u) ^ (static_cast<std::uint64_t>(y) * 19349663u) ^
                        (static_cast<std::uint64_t>(z) * 83492791u);
    key *= 0x9e3779b97f4a7c15u;
    return static_cast<std::size_t>(key >> 32) & (heads_.size() - 1);
  }

  double closest_;
  Vector3d origin_;
  std::vector<std::uint32_t> heads_;
  std::vector<Point> points_;
};

/// Picks candidates in proportion to area.
class CandidateSource {
public:
  explicit CandidateSource(const std::vector<MeshTriangle>& triangles) : triangles_(triangles) {
    up_to_.reserve(triangles.size());
    double sum = 0.0;
    for (const MeshTriangle& t : triangles)
      up_to_.push_back(sum += usable_area(t));
  }

  Candidate make(std::uint64_t index) const {
    const std::array<double, 3> u = spread(index);
    // The first triangle whose running sum exceeds the target: one without area cannot be met.
    const auto found = std::upper_bound(up_to_.begin(), up_to_.end(), u[0] * up_to_.back());
    Candidate c;
    c.triangle = static_cast<std::size_t>(std::min(found, up_to_.end() - 1) - up_to_.begin());
    // Uniform on the triangle: the unit square folded along its diagonal.
    const bool fold = u[1] + u[2] > 1.0;
    const double v = fold ? 1.0 - u[1] : u[1];
    const double w = fold ? 1.0 - u[2] : u[2];
    c.weight = {1.0 - v - w, v, w};
    const MeshTriangle& t = triangles_[c.triangle];
    c.position = c.weight[0] * t.position[0] + v * t.position[1] + w * t.position[2];
    c.facing = area_vector(t).normalized();
    return c;
  }

private:
  const std::vector<MeshTriangle>& triangles_;
  std::vector<double> up_to_; ///< running sum of the areas
};

Vector3f interpolate(const std::array<Vector3f, 3>& corners, const std::array<double, 3>& weight) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t k = 0; k < 3; ++k)
    sum += weight[k] * corners[k].cast<double>();
  return sum.cast<float>();
}

Vector3f normal_at(const MeshTriangle& t, const Candidate& c) {
  const Vector3f facing = c.facing.cast<float>();
  const Vector3f smooth = interpolate(t.normal, c.weight);
  const float length = smooth.norm();
  if (!std::isfinite(length) || length < 1e-6f) return facing;
  return smooth.dot(facing) < 0.0f ? Vector3f(-smooth / length) : Vector3f(smooth / length);
}

/// Where faces end within `reach` of the points; `from`: the triangle of each.
void add_borders(const std::vector<MeshTriangle>& triangles, const std::vector<std::uint32_t>& from, double reach,
                 PointCloud& cloud) {
  std::vector<Vector3d> corners;
  MeshBorders::Triangles faces;
  for (const MeshTriangle& t : triangles) {
    const auto first = static_cast<std::uint32_t>(corners.size());
    faces.push_back({first, first + 1, first + 2});
    corners.insert(corners.end(), t.position.begin(), t.position.end());
  }
  const MeshBorders borders(corners, faces);
  if (!borders.any()) return;
  constexpr std::size_t grain = 4096;
  std::vector<std::vector<ClippedPoint>> found((cloud.size() + grain - 1) / grain);
  parallel_ranges(cloud.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const ClipStrips clip = borders.around(cloud.position[p], cloud.normal[p].cast<double>(), {from[p]}, reach);
      if (!clip.strip[0].axis.isZero(0)) found[begin / grain].push_back({static_cast<std::uint32_t>(p), clip});
    }
  });
  for (const auto& part : found)
    cloud.clipped.insert(cloud.clipped.end(), part.begin(), part.end());
}

} // namespace

double usable_area(const MeshTriangle& t) {
  const double area = area_vector(t).norm();
  return std::isfinite(area) ? area : 0.0;
}

double total_area(const std::vector<MeshTriangle>& triangles) {
  double sum = 0.0;
  for (const MeshTriangle& t : triangles)
    sum += usable_area(t);
  return sum;
}

PointCloud sample_triangles(const std::vector<MeshTriangle>& triangles, double wanted, bool with_colour) {
  const CandidateSource source(triangles);
  const double area = total_area(triangles);
  Vector3d origin = Vector3d::Constant(std::numeric_limits<double>::infinity());
  for (const MeshTriangle& t : triangles)
    if (usable_area(t) > 0.0)
      for (const Vector3d& p : t.position)
        origin = origin.cwiseMin(p);

  PointCloud cloud;
  std::vector<std::uint32_t> from; // triangle of each point
  Occupied occupied(closest_in_spacings * std::sqrt(area / wanted), origin, static_cast<std::size_t>(wanted));
  const auto tries = static_cast<std::uint64_t>(std::ceil(wanted)) * tries_per_point;
  for (std::uint64_t i = 0; i < tries; ++i) {
    if (i % 65536 == 0) stop_if_asked();
    const Candidate c = source.make(i);
    if (!occupied.try_add(c.position, c.facing)) continue;
    const MeshTriangle& t = triangles[c.triangle];
    cloud.position.push_back(c.position);
    cloud.normal.push_back(normal_at(t, c));
    if (with_colour) cloud.colour.push_back(interpolate(t.colour, c.weight));
    from.push_back(static_cast<std::uint32_t>(c.triangle));
  }
  cloud.area.assign(cloud.size(), static_cast<float>(area / static_cast<double>(cloud.size())));
  add_borders(triangles, from, border_reach * std::sqrt(area / wanted), cloud);
  return cloud;
}

} // namespace pointgi
