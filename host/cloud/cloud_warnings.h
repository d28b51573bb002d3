#pragma once
/// What a user should know of a cloud that is hardly what was meant.
#include "host/cloud/knn.h"
#include "host/cloud/point_cloud.h"

namespace pointgi {

/// Warns of clouds whose points all lie at one place or on one line. `points`: how many there are at the sites.
void warn_of_degenerate(const Sites& sites, std::size_t points, CloudReport& report);

/// Warns where many neighbours' normals oppose each other; not of foliage, where they are meant to. `opposite`: their
/// share. `signs_given`: the normals are the file's own.
void warn_of_opposite(double opposite, bool signs_given, CloudReport& report);

} // namespace pointgi
