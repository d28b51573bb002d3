#pragma once
#include "host/cloud/complete.h"

namespace pointgi {

/// Removes the points that can not be used: position, colour or given area not finite; and, where `options` use them,
/// normal not finite or of no length, radius not finite or not above 0 (denormal counts as 0), area likewise. What is
/// left keeps its order; triangles are renumbered, those that refer to a removed point (or to none) go too.
/// Returns how many points went.
std::size_t drop_unusable_points(PointCloud& cloud, const CompleteOptions& options);

} // namespace pointgi
