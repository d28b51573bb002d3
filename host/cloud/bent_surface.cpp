#include "host/cloud/bent_surface.h"
#include "host/cloud/unfold.h"

namespace pointgi {

using Eigen::Vector3d;

namespace {

constexpr double level = 0.03;     // sine of normals that are as good as parallel
constexpr double beside = 0.5;     // cosine, 60°: of neighbours that lie in a direction
constexpr double bent_share = 0.5; // of them that the surface must bend away towards

} // namespace

void BentSurface::begin(const Vector3d& normal, double radius, bool trusted) {
  normal_ = normal;
  radius_ = radius;
  trusted_ = trusted;
  count_ = bends_ = 0;
}

void BentSurface::add(const Vector3d& offset, const Vector3d& normal) {
  const double cosine = normal_.dot(normal);
  if (cosine < detail::other_side || bends_ == most_planes) return;
  const Vector3d across = normal - cosine * normal_;
  const double sine = across.norm();
  if (sine < level) return;
  // Both points lie below the other's plane where the surface is bent outwards, and the line lies between them.
  const double distance = offset.dot(normal) / sine;
  const bool away = offset.dot(normal_) < 0 && distance > 0;
  bend_[bends_++] = {offset, away};
  if (away && distance < radius_) line_[count_++] = {across / sine, distance, sine};
}

bool BentSurface::bends_away(const Vector3d& axis) const {
  if (trusted_) return true;
  unsigned all = 0, away = 0;
  for (unsigned k = 0; k < bends_; ++k) {
    if (bend_[k].offset.dot(axis) < beside * bend_[k].offset.norm()) continue;
    ++all;
    away += bend_[k].away;
  }
  return away > 0 && away >= bent_share * all;
}

} // namespace pointgi
