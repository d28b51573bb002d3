#pragma once
/// How large a scan's discs may be at most.
#include "host/cloud/knn.h"
#include "host/cloud/point_cloud.h"

namespace pointgi {

/// Radii of a scan no larger than what lies around vouches for, and areas no larger than such a disc: lines as wide as
/// their points are apart, leaves and noise as their own, surfaces by the spacing around; points of structure from
/// motion (`sparse`) no wider than their own. Nor is any disc much wider than most: points without a surface and sparse
/// ones have at most twice the cloud's median spacing, those of surfaces and lines 16 times. `spacing` (local units)
/// and `structure`: a value a site; `structure` empty: surface everywhere.
void limit_sizes(PointCloud& cloud, const Sites& sites, const std::vector<float>& spacing,
                 const std::vector<Structure>& structure, bool sparse);

} // namespace pointgi
