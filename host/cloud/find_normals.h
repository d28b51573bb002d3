#pragma once
/// Where the normals of a cloud come from: the file, its faces, or how its points lie.
#include "host/cloud/complete.h"
#include "host/cloud/knn.h"

namespace pointgi {

/// Unit normals; those that are missing, of length 0 or not finite, become zero. Returns how many are.
std::size_t normalise(std::vector<Eigen::Vector3f>& normals);

/// Fills cloud.normal, unit, and report.normals_from; true when the signs are the file's own. Where they are not, sides
/// are found, and with them the kind of cloud; `structure` receives then a value a site. `spacing`: local units, a
/// value a site.
bool find_normals(PointCloud& cloud, const Sites& sites, const CompleteOptions& options,
                  const std::vector<float>& spacing, std::vector<Structure>& structure, CloudReport& report);

} // namespace pointgi
