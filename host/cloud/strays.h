#pragma once
/// Points that are no part of any surface: flying pixels, floaters of photogrammetry, dust.
#include "host/cloud/knn.h"

namespace pointgi {

enum class StrayPolicy {
  drop,   ///< left out
  shrink, ///< kept as discs no larger than the spacing of the surface beside them
  keep    ///< not looked for
};

/// Whether each site is a stray. Two things make one: its neighbours lie far nearer to one another than to it
/// (statistical outlier removal, in the neighbourhood's own spacing, so that a scan which thins out with distance has
/// none); or it is far sparser than the cloud and its neighbours fill space instead of lying on a sheet or a line, as
/// floaters in a cloud of floaters do. `spacing`: local units, a value a site, > 0.
/// All are false where fewer than 100 sites tell nothing, or where more than a quarter would be strays: then there is
/// no surface to judge them by.
std::vector<char> find_strays(const Sites& sites, const std::vector<float>& spacing);

} // namespace pointgi
