#pragma once
/// One patch of the moving-least-squares surface, fitted to a splat's neighbours.
#include "octree/splat.h"
#include <Eigen/Core>

namespace pointgi {

/// What a patch is fitted to.
struct PatchSamples {
  struct Sample {
    Eigen::Vector3d off, normal; ///< off: from the splat's centre
    double weight;               ///< wendland() of its distance, in supports
  };
  std::vector<Sample> samples; ///< the splat among them
  double support = 0.0;        ///< distance of the farthest neighbour, which has no weight
};

/// Wendland's function, 1 at 0, with two continuous derivatives at 1, where it ends.
double wendland(double r);

enum class PatchKind { disc, plane, patch };

struct PatchFit {
  PatchKind kind = PatchKind::disc; ///< disc: the splat stays as it was
  Eigen::Vector3d shift{0, 0, 0};   ///< of the centre
  bool refused = false;             ///< neighbours determine a quadratic, and do not lie on it
  double noise = 0.0; ///< expected error of the normal by what the neighbours lie off their quadratic, radians
  float normal[3] = {0.0f, 0.0f, 0.0f};
  PatchBend bend = {0.0f, 0.0f, 0.0f, 0.0f};
};

/// A quadratic, else a plane, else the disc as it was: the first that the samples determine and lie on, and that stays
/// in the root cube. See fit_mls_patches (host/cloud/mls_patches.h).
PatchFit fit_patch(const Splat& splat, const PatchSamples& around);

} // namespace pointgi
