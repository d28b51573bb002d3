#pragma once
/// What a user should know of a cloud that is hardly what was meant.
#include "host/cloud/knn.h"
#include "host/cloud/point_cloud.h"

namespace pointgi {

/// Single places and lines: something can be shown. `points`: how many there are at the sites.
void warn_of_degenerate(const Sites& sites, std::size_t points, CloudReport& report);

/// Normals that oppose each other between neighbours, `opposite`: their share; unless the cloud is foliage.
/// `signs_given`: by the file.
void warn_of_opposite(double opposite, bool signs_given, CloudReport& report);

} // namespace pointgi
