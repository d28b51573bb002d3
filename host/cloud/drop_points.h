#pragma once
#include "host/cloud/complete.h"

namespace pointgi {

/// Gaussians whose opacity is less than this show next to nothing, each for itself. Of thresholds from 0.02 to 0.3 this
/// one keeps the outline of a noisy capture best, and that of a clean one within 3 % of the best. [0,1]
constexpr float least_opacity = 0.1f;

/// Removes the points that can not be used: opacity below least_opacity; position, colour or given area not finite, or
/// not above 0 (denormal counts as 0); where `options` use radii, those likewise. A missing normal is no reason. What
/// is left keeps its order; triangles are renumbered, those that refer to a removed point (or to none) go too. Returns
/// how many points went.
std::size_t drop_unusable_points(PointCloud& cloud, const CompleteOptions& options);

/// Removes a few points (at most a thousandth) that lie further off than a thousand times the size of the rest: the
/// root cube would have to hold them, and the rest would be lost in its rounding. Returns how many went.
std::size_t drop_outliers(PointCloud& cloud);

} // namespace pointgi
