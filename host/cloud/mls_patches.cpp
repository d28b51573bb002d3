#include "host/cloud/mls_patches.h"
#include "host/cloud/knn.h"
#include "host/cloud/normal_field.h"
#include "octree/build/disc_cell.h"
#include "octree/parallel.h"
#include "octree/ref/clip.h"
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
/// Of a neighbour past a splat's border: less, and the border is an edge; more, and it may be where a disc would stick
/// out of a bend that a patch follows.
constexpr double border_cosine = 0.8;
/// Least over greatest pivot of the normal equations, lengths in supports: below, neighbours stand on a line or on few
/// places. Evenly spread ones have 1e-3.
constexpr double least_pivot = 1e-6;
/// Of the neighbours' weighted deviation from their quadratic, in supports: more, and they are no surface.
constexpr double most_deviation = 0.15;
/// Error of a normal, radians, that a picture shows; to be rid of it, neighbours up to so many times as many, as long as
/// they turn the normal by no more than this share of its error. A larger share smoothes the bunny's fur: 2.2 degrees off
/// its mesh instead of 1.3; a smaller one leaves noise.
constexpr double noticed_noise = 0.03, most_turn = 0.5;
constexpr unsigned most_growth = 4;
/// The foot's distance, in radii, and the cosine of the turn of the normal, beyond which a fit is not to be trusted.
constexpr double most_shift = 0.5, least_turn_cosine = 0.7;
/// The radius in supports beyond which a quadratic would run past the neighbours that it was fitted to.
constexpr double most_reach = 0.9;
/// Of the neighbours' normals with the patch's, a mean: 30 degrees, more than noise of normals.
constexpr double least_agreement = 0.87;
/// Of a splat whose neighbours lie on no quadratic, as at a sharp rim: what is left of its radius, that it does not stick
/// out of them. Most of its cell, and the neighbours' patches reach into the rest.
constexpr float refused_radius = 0.6f;
/// Of a patch, over its radius: it then leaves its box at a third of that.
constexpr double most_bend = 4.0;
/// A neighbour may lie on its own clip's border but for rounding, in radii.
constexpr float on_border = 1e-3f;

Vector3d vector(const float v[3]) {
  return {v[0], v[1], v[2]};
}

/// Wendland's function, 1 at 0, with two continuous derivatives at 1.
double wendland(double r) {
  if (!(r < 1.0)) return 0.0;
  const double s = (1.0 - r) * (1.0 - r);
  return s * s * (4.0 * r + 1.0);
}

struct Sample {
  Vector3d off, normal; ///< off: from the splat's centre
  double weight;
};

enum class Kind { disc, plane, patch };

struct Fit {
  Kind kind = Kind::disc;
  Vector3d shift{0, 0, 0}; ///< of the centre
  bool refused = false;    ///< neighbours determine a quadratic, and do not lie on it
  double noise = 0.0;      ///< expected error of the normal by what the neighbours lie off their quadratic, radians
  float normal[3] = {0.0f, 0.0f, 0.0f};
  PatchBend bend = {0.0f, 0.0f, 0.0f, 0.0f};
};

class PatchFitter {
public:
  PatchFitter(const std::vector<Splat>& splats, const SplatClips& clips, const Sites& sites, unsigned neighbours)
      : splats_(splats), clips_(clips), clip_of_(clip_of_each(clips, splats.size())), sites_(sites), k_(neighbours) {}

  /// Scratch of one thread.
  struct Around {
    std::vector<Neighbour> near;
    std::vector<Sample> samples;
    unsigned count = 0;
    double support = 0.0;
  };

  /// `growth`: of the number of neighbours.
  void go_to(std::uint32_t site, Around& around, unsigned growth = 1) const {
    around.near.resize(growth * k_);
    around.count = sites_.nearest(site, growth * k_, around.near.data());
    around.support =
        around.count == 0 ? 0.0 : std::sqrt(double{around.near[around.count - 1].distance2}) * sites_.unit();
  }

  /// Of the point at a site. Where noise shows, to more neighbours, as long as that makes the normal better known.
  Fit fit(std::uint32_t point, std::uint32_t site, Around& around) const {
    Fit best = fit_around(point, around);
    for (unsigned growth = 2; growth <= most_growth && best.kind == Kind::patch && best.noise > noticed_noise;
         growth *= 2) {
      Around more;
      go_to(site, more, growth);
      const Fit smoother = fit_around(point, more);
      // More than noise turns it: what is left off the quadratic is detail.
      const double turn = (vector(smoother.normal) - vector(best.normal)).norm();
      if (smoother.kind != Kind::patch || smoother.noise >= best.noise || turn > most_turn * best.noise) break;
      best = smoother;
    }
    return best;
  }

private:
  Fit fit_around(std::uint32_t point, Around& around) const {
    Fit result;
    const Splat& splat = splats_[point];
    if (around.support <= 0.0) return result;
    collect(point, around);
    const bool within = splat.radius < most_reach * around.support;
    if (within && fit_terms<quadratic_terms>(splat, around, result) && is_in_root(splat, result)) return result;
    const bool refused = std::exchange(result, {}).refused;
    if (!fit_terms<plane_terms>(splat, around, result) || !is_in_root(splat, result)) result = {};
    result.refused = refused;
    return result;
  }

  /// As its disc was.
  static bool is_in_root(const Splat& splat, const Fit& fit) {
    const double reach = std::sqrt(double{PATCH_REACH2}) * splat.radius;
    const bool deep = std::all_of(splat.position, splat.position + 3, [&](float p) { return p > 2.0 * reach && p < 1.0 - 2.0 * reach; });
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

  /// Of several points in one place, as of a sheet's two sides, the one that faces as the splat does.
  const Splat* facing_point(const Splat& splat, std::uint32_t site) const {
    const Splat* best = nullptr;
    double most = mls_surface_cosine;
    for (const std::uint32_t other : sites_.points(site)) {
      const Splat& candidate = splats_[other];
      const double cosine = vector(candidate.normal).dot(vector(splat.normal));
      if (material_of(candidate) == material_of(splat) && cosine > most) best = &candidate, most = cosine;
    }
    return best;
  }

  bool is_past_border(std::uint32_t point, const Vector3d& off) const {
    if (clip_of_.empty() || clip_of_[point] == no_clip) return false;
    DiscClip clip = clips_[clip_of_[point]].clip;
    for (ClipStrip& strip : clip.strip) {
      strip.low -= on_border * splats_[point].radius;
      strip.high += on_border * splats_[point].radius;
    }
    return is_clipped_off(clip, off.data());
  }

  void collect(std::uint32_t point, Around& around) const {
    const Splat& splat = splats_[point];
    around.samples.assign(1, {Vector3d::Zero(), vector(splat.normal), 1.0});
    for (unsigned i = 0; i < around.count; ++i) {
      const Splat* other = facing_point(splat, around.near[i].site);
      if (other == nullptr) continue;
      const Vector3d off = vector(other->position) - vector(splat.position);
      const double weight = wendland(off.norm() / around.support);
      const bool turned = vector(other->normal).dot(vector(splat.normal)) < border_cosine;
      if (weight > 0.0 && !(turned && is_past_border(point, off))) around.samples.push_back({off, vector(other->normal), weight});
    }
  }

  /// Coefficients in supports; false where the samples do not determine them.
  template <int Terms>
  static bool solve(const Around& around, const Vector3d& foot, const float normal[3],
                    Eigen::Matrix<double, Terms, 1>& c, double* deviation2, double* noise) {
    using Row = Eigen::Matrix<double, Terms, 1>;
    if (around.samples.size() < Terms + 1u) return false;
    float u_of[3], v_of[3];
    splat_tangents(normal, u_of, v_of);
    const Vector3d n = vector(normal), u = vector(u_of), v = vector(v_of);
    Eigen::Matrix<double, Terms, Terms> moments = Eigen::Matrix<double, Terms, Terms>::Zero();
    Row sums = Row::Zero();
    double squares = 0.0, weights = 0.0, weights2 = 0.0;
    for (const Sample& s : around.samples) {
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
    const double samples = weights * weights / weights2, variance = *deviation2 * samples / std::max(samples - Terms, 1.0);
    const double slopes = factors.solve(Row::Unit(1))[1] + factors.solve(Row::Unit(2))[2];
    *noise = std::sqrt(variance * weights2 / weights * slopes);
    return c.allFinite();
  }

  template <int Terms>
  static bool fit_terms(const Splat& splat, const Around& around, Fit& result) {
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
    result.kind = Terms == quadratic_terms ? Kind::patch : Kind::plane;
    if constexpr (Terms == quadratic_terms) {
      if (!solve<Terms>(around, foot, result.normal, c, &deviation2, &result.noise)) return false;
      result.bend = bend_of(c[3] / around.support, c[4] / around.support, c[5] / around.support, splat.radius);
      result.refused = !(agreement(around, result) >= least_agreement);
      if (result.refused) return false;
    }
    return true;
  }

  /// Mean cosine of the neighbours' normals with the patch's below them.
  static double agreement(const Around& around, const Fit& fit) {
    float u_of[3], v_of[3];
    splat_tangents(fit.normal, u_of, v_of);
    const Vector3d n = vector(fit.normal), u = vector(u_of), v = vector(v_of);
    double cosines = 0.0, weights = 0.0;
    for (const Sample& s : around.samples) {
      const double x = (s.off - fit.shift).dot(u), y = (s.off - fit.shift).dot(v);
      const Vector3d normal = n - (2.0 * fit.bend.xx * x + fit.bend.xy * y) * u -
                              (fit.bend.xy * x + 2.0 * fit.bend.yy * y) * v;
      cosines += s.weight * normal.normalized().dot(s.normal);
      weights += s.weight;
    }
    return cosines / weights;
  }

  /// No steeper than floats are good for.
  static PatchBend bend_of(double xx, double xy, double yy, double radius) {
    const double steepest = 0.5 * std::abs(xx + yy) + std::hypot(0.5 * (xx - yy), 0.5 * xy);
    const double most = most_bend / radius, scale = steepest > most ? most / steepest : 1.0;
    return {static_cast<float>(scale * xx), static_cast<float>(scale * xy), static_cast<float>(scale * yy), 0.0f};
  }

  const std::vector<Splat>& splats_;
  const SplatClips& clips_;
  std::vector<std::uint32_t> clip_of_;
  const Sites& sites_;
  unsigned k_;
};

/// A sheet's back is its front seen from behind: the tangents of -n are u and -v.
void set_back(const Splat& front, const PatchBend& of_front, Splat& back, PatchBend& of_back) {
  for (int a = 0; a < 3; ++a) {
    back.position[a] = front.position[a];
    back.normal[a] = -front.normal[a];
  }
  of_back = {-of_front.xx, of_front.xy, -of_front.yy, 0.0f};
}

} // namespace

MlsPatches fit_mls_patches(std::vector<Splat>& splats, const SplatClips& clips, unsigned neighbours) {
  MlsPatches result;
  result.bends.assign(splats.size(), {0.0f, 0.0f, 0.0f, 0.0f});
  std::vector<Vector3d> positions;
  std::vector<std::uint32_t> of; // splat of each position
  for (std::uint32_t i = 0; i < splats.size(); ++i)
    if (!is_flat(splats[i])) {
      positions.push_back(vector(splats[i].position));
      of.push_back(i);
    }
  std::vector<Fit> fits(positions.size());
  if (!positions.empty()) {
    std::vector<Splat> bent(of.size());
    for (std::size_t k = 0; k < of.size(); ++k)
      bent[k] = splats[of[k]];
    SplatClips of_bent;
    const std::vector<std::uint32_t> clip_of = clip_of_each(clips, splats.size());
    for (std::uint32_t k = 0; k < of.size() && !clips.empty(); ++k)
      if (clip_of[of[k]] != no_clip) of_bent.push_back({k, clips[clip_of[of[k]]].clip});
    const Sites sites(positions);
    const PatchFitter fitter(bent, of_bent, sites, neighbours);
    parallel_ranges(sites.size(), 1024, [&](std::size_t begin, std::size_t end) {
      PatchFitter::Around around;
      for (auto site = static_cast<std::uint32_t>(begin); site < end; ++site) {
        fitter.go_to(site, around);
        for (const std::uint32_t point : sites.points(site))
          if (!is_back_of_sheet(bent[point])) fits[point] = fitter.fit(point, site, around);
      }
    });
  }
  result.discs = splats.size() - of.size();
  for (std::size_t k = 0; k < of.size(); ++k) {
    Splat& splat = splats[of[k]];
    if (is_back_of_sheet(splat)) {
      set_back(splats[of[k] - 1], result.bends[of[k] - 1], splat, result.bends[of[k]]);
      continue;
    }
    const Fit& fit = fits[k];
    if (fit.refused) splat.radius *= refused_radius;
    (fit.kind == Kind::patch ? result.patches : fit.kind == Kind::plane ? result.planes : result.discs) += 1;
    if (fit.kind == Kind::disc) continue;
    for (int a = 0; a < 3; ++a)
      splat.position[a] = static_cast<float>(splat.position[a] + fit.shift[a]);
    std::copy_n(fit.normal, 3, splat.normal);
    result.bends[of[k]] = fit.bend;
  }
  return result;
}

} // namespace pointgi
