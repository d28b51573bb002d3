#include "host/cloud/faces.h"
#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

namespace pointgi {

using Eigen::Vector3d;

namespace {

constexpr double thick = 0.5;        // spacings: of a face, noise of a fifth of one at 2.5 standard deviations
constexpr double like_face = 0.9;    // cosine, 25°: of neighbours' normals on one face with each other
constexpr double apart = 0.766;      // 40°: between faces
constexpr double least_corner = 0.2; // triple product of the normals at a corner
constexpr unsigned fewest = 8;       // neighbours on a face
constexpr double nearly_all = 0.85;  // of neighbours: on one of the faces
constexpr double beside = 1.5;       // spacings from an edge: where a round surface differs most from it
// Spacings: a bend, and a mean depth beside the edge, that no face has. A radius of seven spacings bends 0.3.
constexpr double least_bend = 0.1, least_depth = 0.05, largest = 0.2;
constexpr double surely = 4.0;      // standard deviations of a mean that noise explains
constexpr double along_face = 0.97; // 14°: of normals with their face
constexpr double mostly = 0.55;     // of neighbours must be so; those beside the edge are not, where noise hides it

/// The plane that fits best through those that `counts` says.
template <class Counts>
bool fit(const NearPoint* near, unsigned count, const Counts& counts, Faces::Plane& plane) {
  Vector3d sum = Vector3d::Zero(), normals = Vector3d::Zero();
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  unsigned n = 0;
  for (unsigned j = 0; j < count; ++j) {
    if (!counts(near[j])) continue;
    sum += near[j].offset;
    moments += near[j].offset * near[j].offset.transpose();
    normals += near[j].normal;
    ++n;
  }
  if (n < fewest) return false;
  const Vector3d mean = sum / n;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(moments / n - mean * mean.transpose());
  if (!(solver.eigenvalues()[1] > 4.0 * solver.eigenvalues()[0])) return false; // a line or a clump
  plane.normal = solver.eigenvectors().col(0);
  if (plane.normal.dot(normals) < 0) plane.normal = -plane.normal;
  plane.height = mean.dot(plane.normal);
  return plane.normal.allFinite();
}

double off(const Faces::Plane& plane, const NearPoint& p) {
  return p.offset.dot(plane.normal) - plane.height;
}

/// Whether a neighbour lies on no plane found so far.
bool is_free(const Faces& faces, const NearPoint& p) {
  return std::none_of(faces.plane.begin(), faces.plane.begin() + faces.count,
                      [&](const Faces::Plane& plane) { return std::abs(off(plane, p)) < thick; });
}

/// Neighbours on no plane yet, their coordinates apart, as vector instructions take them: each is compared with all.
class FreePoints {
public:
  FreePoints(const NearPoint* near, unsigned count, const Faces& faces) {
    for (unsigned i = 0; i < count; ++i)
      if (is_free(faces, near[i])) points_.push_back(&near[i]);
    for (int c = 0; c < 3; ++c)
      for (const NearPoint* p : points_) {
        offset_[c].push_back(p->offset[c]);
        normal_[c].push_back(p->normal[c]);
      }
  }

  const std::vector<const NearPoint*>& points() const { return points_; }

  /// How many lie on a plane through p across its normal, and face alike.
  std::size_t on_plane_of(const NearPoint& p) const {
    const double *x = offset_[0].data(), *y = offset_[1].data(), *z = offset_[2].data();
    const double *u = normal_[0].data(), *v = normal_[1].data(), *w = normal_[2].data();
    const double a = p.normal[0], b = p.normal[1], c = p.normal[2];
    const double x0 = p.offset[0], y0 = p.offset[1], z0 = p.offset[2];
    std::size_t on = 0;
    for (std::size_t j = 0; j < points_.size(); ++j) {
      const bool alike = u[j] * a + (v[j] * b + w[j] * c) > like_face;
      const bool near = std::abs((x[j] - x0) * a + ((y[j] - y0) * b + (z[j] - z0) * c)) < thick;
      on += static_cast<std::size_t>(alike & near);
    }
    return on;
  }

private:
  std::vector<const NearPoint*> points_;
  std::array<std::vector<double>, 3> offset_, normal_;
};

/// Adds the plane that most of the free neighbours lie on.
bool add_plane(const NearPoint* near, unsigned count, Faces& faces) {
  const FreePoints free(near, count, faces);
  std::size_t most = fewest - 1;
  const NearPoint* seed = nullptr;
  for (const NearPoint* p : free.points()) {
    if (free.points().size() <= most) break; // none has more about it
    if (std::any_of(faces.plane.begin(), faces.plane.begin() + faces.count,
                    [&](const Faces::Plane& plane) { return plane.normal.dot(p->normal) > apart; }))
      continue;
    if (const std::size_t on = free.on_plane_of(*p); on > most) {
      most = on;
      seed = p;
    }
  }
  if (seed == nullptr) return false;
  Faces::Plane plane{seed->normal, seed->offset.dot(seed->normal), false};
  for (int round = 0; round < 3; ++round) {
    const Faces::Plane last = plane;
    if (!fit(
            near, count,
            [&](const NearPoint& p) {
              return std::abs(off(last, p)) < thick && is_free(faces, p) && p.normal.dot(last.normal) > apart;
            },
            plane))
      return false;
  }
  for (unsigned k = 0; k < faces.count; ++k)
    if (faces.plane[k].normal.dot(plane.normal) > apart) return false;
  faces.plane[faces.count++] = plane;
  return true;
}

/// The plane nearest to a neighbour.
unsigned nearest(const Faces& faces, const NearPoint& p) {
  unsigned best = 0;
  for (unsigned k = 1; k < faces.count; ++k)
    if (std::abs(off(faces.plane[k], p)) < std::abs(off(faces.plane[best], p))) best = k;
  return best;
}

/// Sums over the neighbours that lie on one plane.
struct Residuals {
  unsigned count = 0;
  double height2 = 0;                              ///< squared distances from the plane
  double across = 0, across2 = 0, with_height = 0; ///< squared distances from the middle, their squares, times heights

  void add(double height, double distance2) {
    ++count;
    height2 += height * height;
    across += distance2;
    across2 += distance2 * distance2;
    with_height += distance2 * height;
  }
  /// How far the surface bends away from the plane over the neighbours' extent. Heights sum to 0: the plane fits best.
  double bend() const {
    const double mean = across / count, spread = across2 / count - mean * mean;
    return spread > 0 ? with_height / count / std::sqrt(spread) : 0.0;
  }
};

/// Whether the neighbours lie on the planes, beside the edges, too, and each plane is one: what bends is no face.
/// `facing_share`: of normals that must be their faces'.
bool are_faces(const NearPoint* near, unsigned count, const Faces& faces, double facing_share) {
  std::array<Residuals, 3> residual;
  std::array<Vector3d, 3> middle{Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()};
  std::array<unsigned, 3> members{};
  for (unsigned j = 0; j < count; ++j) {
    const unsigned own = nearest(faces, near[j]);
    middle[own] += near[j].offset;
    ++members[own];
  }
  unsigned on = 0, near_edge = 0, facing = 0;
  double depth = 0, noise2 = 0;
  for (unsigned j = 0; j < count; ++j) {
    const unsigned own = nearest(faces, near[j]);
    const double height = off(faces.plane[own], near[j]);
    facing += near[j].normal.dot(faces.plane[own].normal) > along_face;
    if (std::abs(height) >= thick) continue;
    ++on;
    noise2 += height * height;
    residual[own].add(height, (near[j].offset - middle[own] / members[own]).squaredNorm());
    for (unsigned k = 0; k < faces.count; ++k) {
      if (k == own) continue;
      const double sine = faces.plane[own].normal.cross(faces.plane[k].normal).norm();
      if (std::abs(off(faces.plane[k], near[j])) > beside * sine) continue;
      depth += height;
      ++near_edge;
      break;
    }
  }
  if (on < nearly_all * count || facing < facing_share * count || near_edge == 0) return false;
  const double noise = std::sqrt(noise2 / on);
  const auto is_noise = [&](double mean, unsigned samples, double smallest) {
    return std::abs(mean) <= std::clamp(surely * noise / std::sqrt(samples), smallest, largest);
  };
  for (unsigned k = 0; k < faces.count; ++k)
    if (residual[k].count < fewest || !is_noise(residual[k].bend(), residual[k].count, least_bend)) return false;
  return is_noise(depth / near_edge, near_edge, least_depth);
}

} // namespace

Faces find_faces(const NearPoint* near, unsigned count, const Vector3d& normal, bool normals_given) {
  Faces faces;
  while (faces.count < faces.plane.size() && add_plane(near, count, faces)) {
  }
  // Three planes round one axis are a tube as likely as anything else.
  if (faces.count == 3 &&
      std::abs(faces.plane[0].normal.cross(faces.plane[1].normal).dot(faces.plane[2].normal)) < least_corner)
    return {};
  if (faces.count < 2 || !are_faces(near, count, faces, normals_given ? nearly_all : mostly)) return {};
  const unsigned own = nearest(faces, {Vector3d::Zero(), normal});
  if (std::abs(faces.plane[own].height) > 2.0 * thick) return {};
  std::swap(faces.plane[0], faces.plane[own]);
  for (unsigned k = 1; k < faces.count; ++k) {
    double above = 0; // of the other face's points over the point's own
    for (unsigned j = 0; j < count; ++j)
      if (nearest(faces, near[j]) == k) above += off(faces.plane[0], near[j]);
    faces.plane[k].sticks_out = above < 0;
  }
  return faces;
}

} // namespace pointgi
