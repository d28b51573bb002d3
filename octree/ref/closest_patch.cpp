#include "octree/ref/closest_patch.h"
#include "octree/ref/clip.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace pointgi {

namespace {

using Eigen::Vector3d;

/// A ray in the frame of a patch.
class RayOverPatch {
public:
  RayOverPatch(const Splat& splat, const PatchBend& bend, const Vector3d& origin, const Vector3d& direction)
      : bend_(bend) {
    const Vector3d n(splat.normal[0], splat.normal[1], splat.normal[2]);
    // Householder's reflection that takes the z axis to n, or to -n and back: the frame of `tangents` by another way.
    const double side = n.z() < 0.0 ? -1.0 : 1.0;
    const Vector3d w = (side * n + Vector3d::UnitZ()).normalized();
    const auto reflected = [&](const Vector3d& v) -> Vector3d { return 2.0 * w.dot(v) * w - v; };
    const Vector3d u = -reflected(Vector3d::UnitX()), v = -side * reflected(Vector3d::UnitY());
    const Vector3d off = origin - Vector3d(splat.position[0], splat.position[1], splat.position[2]);
    start_ = {off.dot(u), off.dot(v), off.dot(n)};
    along_ = {direction.dot(u), direction.dot(v), direction.dot(n)};
  }

  /// Of the ray's place at t over the patch.
  double height(double t) const {
    const Vector3d p = start_ + t * along_;
    return p.z() - (bend_.xx * p.x() * p.x() + bend_.xy * p.x() * p.y() + bend_.yy * p.y() * p.y());
  }

  bool in_box(double t, double radius) const { return std::abs((start_ + t * along_).z()) <= PATCH_HEIGHT * radius; }

  /// Where the ray is over the disc; false where it is not between t_min and t_max.
  bool over_disc(double radius, double* low, double* high) const {
    const double across2 = along_.head<2>().squaredNorm(), middle = -start_.head<2>().dot(along_.head<2>());
    if (across2 == 0.0) return start_.head<2>().norm() <= radius;
    const Vector3d nearest = start_ + middle / across2 * along_;
    const double left2 = radius * radius - nearest.head<2>().squaredNorm();
    if (left2 < 0.0) return false;
    const double half = std::sqrt(left2 / across2);
    *low = std::max(*low, middle / across2 - half);
    *high = std::min(*high, middle / across2 + half);
    return *low < *high;
  }

  /// t at which the height turns: the vertex of the parabola through three of its values.
  double turning(double low, double high) const {
    const double middle = 0.5 * (low + high), a = height(low), b = height(middle), c = height(high);
    const double bend = a - 2.0 * b + c;
    return bend == 0.0 ? low : middle + 0.25 * (high - low) * (a - c) / bend;
  }

  /// Where the height, monotone in [low, high], passes 0; false where it does not.
  bool cross(double low, double high, double* t) const {
    const bool below = height(low) < 0.0;
    if (!(low < high) || (height(high) < 0.0) == below) return false;
    for (int k = 0; k < 64; ++k) {
      const double middle = 0.5 * (low + high);
      ((height(middle) < 0.0) == below ? low : high) = middle;
    }
    *t = 0.5 * (low + high);
    return true;
  }

private:
  PatchBend bend_;
  Vector3d start_, along_;
};

} // namespace

RayHit closest_patch_hit(View<Splat> splats, View<PatchBend> bends, const double origin[3], const double direction[3],
                         double t_min, double t_max, View<DiscClip> clips) {
  const Vector3d from = Vector3d::Map(origin), towards = Vector3d::Map(direction);
  RayHit best{t_max, RayHit::none};
  for (std::size_t i = 0; i < splats.size; ++i) {
    const Splat& s = splats[i];
    const RayOverPatch ray(s, bends[i], from, towards);
    double low = t_min, high = best.t;
    if (!ray.over_disc(s.radius, &low, &high)) continue;
    const double turn = std::clamp(ray.turning(low, high), low, high);
    const double cuts[3] = {low, turn, high};
    for (int part = 0; part < 2; ++part) {
      double t;
      if (!ray.cross(cuts[part], cuts[part + 1], &t) || !(t < best.t)) continue;
      if (!ray.in_box(t, s.radius)) continue;
      const Vector3d off = from + t * towards - Vector3d(s.position[0], s.position[1], s.position[2]);
      if (clips.size != 0 && is_clipped_off(clips[i], off.data())) continue;
      best = {t, static_cast<std::uint32_t>(i)};
      break;
    }
  }
  if (best.splat == RayHit::none) best.t = -1.0;
  return best;
}

} // namespace pointgi
