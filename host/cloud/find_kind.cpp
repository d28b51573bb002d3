#include "host/cloud/find_kind.h"
#include "host/cloud/orient.h"
#include "octree/parallel.h"
#include <algorithm>

namespace pointgi {

namespace {

/// The means of the normals at each site: two sides in one place leave nothing.
std::vector<Eigen::Vector3f> mean_normals(const Sites& sites, const std::vector<Eigen::Vector3f>& normals) {
  std::vector<Eigen::Vector3f> means(sites.size());
  parallel_ranges(sites.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      const Sites::Points points = sites.points(static_cast<std::uint32_t>(s));
      means[s].setZero();
      for (const std::uint32_t point : points)
        means[s] += normals[point];
      means[s] /= static_cast<float>(points.size());
    }
  });
  return means;
}

/// Whether x and y are hundreds of kilometres east and north of somewhere and z is a height: no model lies so far from
/// its origin for its size.
bool lies_on_a_map_grid(const PointCloud& cloud) {
  constexpr double least = 1e4, far = 1e5, highest = 1e4, sizes_off = 5.0;
  constexpr std::size_t looked_at = 1000;
  Eigen::Vector3d low = cloud.position[0], high = low;
  for (std::size_t i = 0; i < cloud.size(); i += cloud.size() / looked_at + 1)
    low = low.cwiseMin(cloud.position[i]), high = high.cwiseMax(cloud.position[i]);
  const Eigen::Vector3d size = high - low, middle = ((low + high) / 2).cwiseAbs();
  const double nearer = std::min(middle.x(), middle.y()), farther = std::max(middle.x(), middle.y());
  return nearer > least && farther > far && middle.z() < std::min(highest, 0.1 * nearer) &&
         nearer > sizes_off * size.maxCoeff();
}

} // namespace

KindHints hints_for(const Sites& sites, const PointCloud& cloud, const CompleteOptions& options, bool signs_given,
                    const CloudReport& report) {
  KindHints hints;
  hints.up = options.up ? options.up : report.up;
  if (report.up)
    hints.level_by = "the format knows which way is up";
  else if (!hints.up && lies_on_a_map_grid(cloud))
    hints.level_by = "its coordinates are those of a map", hints.up = Eigen::Vector3d::UnitZ();
  hints.usual = report.usual_kind;
  hints.signs_given = signs_given;
  hints.has_stations =
      !cloud.stations.empty() && std::any_of(cloud.stations.begin(), cloud.stations.end(),
                                             [&](const Eigen::Vector3d& s) { return may_have_seen(sites, s); });
  return hints;
}

void tell_kind(const RecognisedKind& found, const PointCloud& cloud, const KindHints& hints, CloudReport& report) {
  report.kind = found.kind;
  report.kind_reason = found.reason;
  report.up = found.up;
  report.stations = hints.has_stations ? cloud.stations : std::vector<Eigen::Vector3d>();
  if (found.sensor) report.stations = {*found.sensor};
}

void find_kind(const PointCloud& cloud, const Sites& sites, const CompleteOptions& options, const SiteSpacing& spacing,
               CloudReport& report) {
  const bool one_a_site = sites.size() == cloud.size();
  const std::vector<Eigen::Vector3f> means =
      one_a_site ? std::vector<Eigen::Vector3f>() : mean_normals(sites, cloud.normal);
  const KindHints hints = hints_for(sites, cloud, options, true, report);
  const FreeSpace space(sites, spacing.spacing, free_space_side);
  tell_kind(recognise_kind(sites, spacing.spacing, one_a_site ? spacing.normal : means, {}, space, hints), cloud, hints,
            report);
}

} // namespace pointgi
