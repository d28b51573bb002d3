#pragma once
/// How large a scan's discs may be at most.
#include "host/cloud/point_cloud.h"
#include "host/cloud/site_spacing.h"

namespace pointgi {

/// Radii of a scan no larger than what lies around vouches for, and areas no larger than such a disc: lines as wide as
/// their points are apart, leaves and noise as their own, surfaces by the spacing around; points of structure from
/// motion no wider than their own. Nor is a disc much wider than most where its neighbours do not lie on one
/// surface with it: foliage has at most the cloud's median spacing, other points without a surface and sparse ones
/// twice, others 16 times. `structure`: a value a site; empty: surface everywhere.
void limit_sizes(PointCloud& cloud, const Sites& sites, const SiteSpacing& spacing,
                 const std::vector<Structure>& structure, CloudKind kind);

} // namespace pointgi
