#include "host/cloud/mls_patches.h"
#include "host/cloud/knn.h"
#include "host/cloud/patch_fit.h"
#include "octree/parallel.h"
#include "octree/ref/clip.h"
#include <algorithm>
#include <cmath>

namespace pointgi {

namespace {

using Eigen::Vector3d;

/// Of a neighbour past a splat's border: less, and the border is an edge; more, and it may be where a disc would stick
/// out of a bend that a patch follows.
constexpr double border_cosine = 0.8;
/// Error of a normal, radians, that a picture shows; to be rid of it, neighbours up to so many times as many, as long
/// as they turn the normal by no more than this share of its error. A larger share smoothes the bunny's fur: 2.2
/// degrees off its mesh instead of 1.3; a smaller one leaves noise.
constexpr double noticed_noise = 0.03, most_turn = 0.5;
constexpr unsigned most_growth = 4;
/// Of a splat whose neighbours lie on no quadratic, as at a sharp rim: what is left of its radius, that it does not
/// stick out of them. Most of its cell, and the neighbours' patches reach into the rest.
constexpr float refused_radius = 0.6f;
/// A neighbour may lie on its own clip's border but for rounding, in radii.
constexpr float on_border = 1e-3f;

Vector3d vector(const float v[3]) {
  return {v[0], v[1], v[2]};
}

class PatchFitter {
public:
  PatchFitter(const std::vector<Splat>& splats, const SplatClips& clips, const Sites& sites, unsigned neighbours)
      : splats_(splats), clips_(clips), clip_of_(clip_of_each(clips, splats.size())), sites_(sites), k_(neighbours) {}

  /// Scratch of one thread.
  struct Around {
    std::vector<Neighbour> near;
    unsigned count = 0;
    PatchSamples fitted;
  };

  /// `growth`: of the number of neighbours.
  void go_to(std::uint32_t site, Around& around, unsigned growth = 1) const {
    around.near.resize(growth * k_);
    around.count = sites_.nearest(site, growth * k_, around.near.data());
    around.fitted.support =
        around.count == 0 ? 0.0 : std::sqrt(double{around.near[around.count - 1].distance2}) * sites_.unit();
  }

  /// Of the point at a site. Where noise shows, to more neighbours, as long as that makes the normal better known.
  PatchFit fit(std::uint32_t point, std::uint32_t site, Around& around) const {
    PatchFit best = fit_around(point, around);
    for (unsigned growth = 2; growth <= most_growth && best.kind == PatchKind::patch && best.noise > noticed_noise;
         growth *= 2) {
      Around more;
      go_to(site, more, growth);
      const PatchFit smoother = fit_around(point, more);
      // More than noise turns it: what is left off the quadratic is detail.
      const double turn = (vector(smoother.normal) - vector(best.normal)).norm();
      if (smoother.kind != PatchKind::patch || smoother.noise >= best.noise || turn > most_turn * best.noise) break;
      best = smoother;
    }
    return best;
  }

private:
  PatchFit fit_around(std::uint32_t point, Around& around) const {
    collect(point, around);
    return fit_patch(splats_[point], around.fitted);
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
    around.fitted.samples.assign(1, {Vector3d::Zero(), vector(splat.normal), 1.0});
    for (unsigned i = 0; i < around.count; ++i) {
      const Splat* other = facing_point(splat, around.near[i].site);
      if (other == nullptr) continue;
      const Vector3d off = vector(other->position) - vector(splat.position);
      const double weight = wendland(off.norm() / around.fitted.support);
      const bool turned = vector(other->normal).dot(vector(splat.normal)) < border_cosine;
      if (weight > 0.0 && !(turned && is_past_border(point, off)))
        around.fitted.samples.push_back({off, vector(other->normal), weight});
    }
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
  back.radius = front.radius;
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
  std::vector<PatchFit> fits(positions.size());
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
    const PatchFit& fit = fits[k];
    if (fit.refused) splat.radius *= refused_radius;
    (fit.kind == PatchKind::patch ? result.patches : fit.kind == PatchKind::plane ? result.planes : result.discs) += 1;
    if (fit.kind == PatchKind::disc) continue;
    for (int a = 0; a < 3; ++a)
      splat.position[a] = static_cast<float>(splat.position[a] + fit.shift[a]);
    std::copy_n(fit.normal, 3, splat.normal);
    result.bends[of[k]] = fit.bend;
  }
  return result;
}

} // namespace pointgi
