#include "host/cloud/patch_fit.h"
#include "host/cloud/normal_field.h"
#include "octree/build/disc_cell.h"
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

namespace pointgi {

namespace {

using Eigen::Vector3d;

constexpr int quadratic_terms = 6, plane_terms = 3;
/// Fits that move the frame, before the one that gives the bend. The second moves it by less than float rounds where
/// the first turned it by a degree.
constexpr int frame_fits = 2;
/// Least over greatest pivot of the normal equations, lengths in supports: below, neighbours stand on a line or on few
/// places. Evenly spread ones have 1e-3.
constexpr double least_pivot = 1e-6;
/// Of the neighbours' weighted deviation from their quadratic, in supports: more, and they are no surface.
constexpr double most_deviation = 0.15;
/// The foot's distance, in radii, and the cosine of the turn of the normal, beyond which a fit is not to be trusted.
constexpr double most_shift = 0.5, least_turn_cosine = 0.7;
/// The radius in supports beyond which a quadratic would run past the neighbours that it was fitted to.
constexpr double most_reach = 0.9;
/// Of the neighbours' normals with the patch's, a mean: 30 degrees, more than noise of normals.
constexpr double least_agreement = 0.87;
/// Of a patch, over its radius: it then leaves its box at a third of that.
constexpr double most_bend = 4.0;

Vector3d vector(const float v[3]) {
  return {v[0], v[1], v[2]};
}

/// Whether the patch does not stick out of the root cube, as its disc did not.
bool is_in_root(const Splat& splat, const PatchFit& fit) {
  const double reach = std::sqrt(double{PATCH_REACH2}) * splat.radius;
  const bool deep = std::all_of(splat.position, splat.position + 3,
                                [&](float p) { return p > 2.0 * reach && p < 1.0 - 2.0 * reach; });
  if (deep) return true;
  Splat moved = splat;
  for (int a = 0; a < 3; ++a)
    moved.position[a] = static_cast<float>(splat.position[a] + fit.shift[a]);
  std::copy_n(fit.normal, 3, moved.normal);
  const Slab slab = slab_of(fit.bend, splat.radius);
  float half[3];
  disc_half_extents(moved, half, slab);
  for (int a = 0; a < 3; ++a)
    if (slab_centre(moved, slab, a) - half[a] < 0.0f || slab_centre(moved, slab, a) + half[a] >= 1.0f) return false;
  return true;
}

/// Coefficients in supports; false where the samples do not determine them.
template <int Terms>
bool solve(const PatchSamples& around, const Vector3d& foot, const float normal[3], Eigen::Matrix<double, Terms, 1>& c,
           double* deviation2, double* noise) {
  using Row = Eigen::Matrix<double, Terms, 1>;
  if (around.samples.size() < Terms + 1u) return false;
  float u_of[3], v_of[3];
  splat_tangents(normal, u_of, v_of);
  const Vector3d n = vector(normal), u = vector(u_of), v = vector(v_of);
  Eigen::Matrix<double, Terms, Terms> moments = Eigen::Matrix<double, Terms, Terms>::Zero();
  Row sums = Row::Zero();
  double squares = 0.0, weights = 0.0, weights2 = 0.0;
  for (const PatchSamples::Sample& s : around.samples) {
    const Vector3d off = (s.off - foot) / around.support;
    const double x = off.dot(u), y = off.dot(v), height = off.dot(n);
    Row b;
    if constexpr (Terms == quadratic_terms)
      b << 1.0, x, y, x * x, x * y, y * y;
    else
      b << 1.0, x, y;
    moments.template selfadjointView<Eigen::Lower>().rankUpdate(b, s.weight);
    sums += s.weight * height * b;
    squares += s.weight * height * height;
    weights += s.weight;
    weights2 += s.weight * s.weight;
  }
  const Eigen::LDLT<Eigen::Matrix<double, Terms, Terms>> factors(moments);
  const auto pivots = factors.vectorD();
  if (!(pivots.minCoeff() > least_pivot * pivots.maxCoeff())) return false;
  c = factors.solve(sums);
  *deviation2 = std::max(0.0, squares - c.dot(sums)) / weights;
  // As many degrees of freedom as weights tell, less those that the terms take; at least one.
  const double samples = weights * weights / weights2,
               variance = *deviation2 * samples / std::max(samples - Terms, 1.0);
  const double slopes = factors.solve(Row::Unit(1))[1] + factors.solve(Row::Unit(2))[2];
  *noise = std::sqrt(variance * weights2 / weights * slopes);
  return c.allFinite();
}

/// Mean cosine of the neighbours' normals with the patch's below them.
double agreement(const PatchSamples& around, const PatchFit& fit) {
  float u_of[3], v_of[3];
  splat_tangents(fit.normal, u_of, v_of);
  const Vector3d n = vector(fit.normal), u = vector(u_of), v = vector(v_of);
  double cosines = 0.0, weights = 0.0;
  for (const PatchSamples::Sample& s : around.samples) {
    const double x = (s.off - fit.shift).dot(u), y = (s.off - fit.shift).dot(v);
    const Vector3d normal =
        n - (2.0 * fit.bend.xx * x + fit.bend.xy * y) * u - (fit.bend.xy * x + 2.0 * fit.bend.yy * y) * v;
    cosines += s.weight * normal.normalized().dot(s.normal);
    weights += s.weight;
  }
  return cosines / weights;
}

/// No steeper than floats are good for.
PatchBend bend_of(double xx, double xy, double yy, double radius) {
  const double steepest = 0.5 * std::abs(xx + yy) + std::hypot(0.5 * (xx - yy), 0.5 * xy);
  const double most = most_bend / radius, scale = steepest > most ? most / steepest : 1.0;
  return {static_cast<float>(scale * xx), static_cast<float>(scale * xy), static_cast<float>(scale * yy), 0.0f};
}

/// False where the samples do not determine the surface, or do not lie on it.
template <int Terms>
bool fit_terms(const Splat& splat, const PatchSamples& around, PatchFit& result) {
  Vector3d foot = Vector3d::Zero();
  Eigen::Matrix<double, Terms, 1> c;
  double deviation2 = 0.0;
  std::copy_n(splat.normal, 3, result.normal);
  for (int k = 0; k < frame_fits; ++k) {
    if (!solve<Terms>(around, foot, result.normal, c, &deviation2, &result.noise)) return false;
    float u[3], v[3];
    splat_tangents(result.normal, u, v);
    const Vector3d n = vector(result.normal);
    foot += c[0] * around.support * n;
    const Vector3d turned = (n - c[1] * vector(u) - c[2] * vector(v)).normalized();
    for (int a = 0; a < 3; ++a)
      result.normal[a] = static_cast<float>(turned[a]);
  }
  result.refused = !(foot.norm() <= most_shift * splat.radius) ||
                   !(vector(result.normal).dot(vector(splat.normal)) >= least_turn_cosine) ||
                   !(deviation2 <= most_deviation * most_deviation);
  if (result.refused) return false;
  result.shift = foot;
  result.kind = Terms == quadratic_terms ? PatchKind::patch : PatchKind::plane;
  if constexpr (Terms == quadratic_terms) {
    if (!solve<Terms>(around, foot, result.normal, c, &deviation2, &result.noise)) return false;
    result.bend = bend_of(c[3] / around.support, c[4] / around.support, c[5] / around.support, splat.radius);
    result.refused = !(agreement(around, result) >= least_agreement);
    if (result.refused) return false;
  }
  return true;
}

} // namespace

double wendland(double r) {
  if (!(r < 1.0)) return 0.0;
  const double s = (1.0 - r) * (1.0 - r);
  return s * s * (4.0 * r + 1.0);
}

PatchFit fit_patch(const Splat& splat, const PatchSamples& around) {
  PatchFit result;
  if (around.support <= 0.0) return result;
  const bool within = splat.radius < most_reach * around.support;
  if (within && fit_terms<quadratic_terms>(splat, around, result) && is_in_root(splat, result)) return result;
  const bool refused = std::exchange(result, {}).refused;
  if (!fit_terms<plane_terms>(splat, around, result) || !is_in_root(splat, result)) result = {};
  result.refused = refused;
  return result;
}

} // namespace pointgi
