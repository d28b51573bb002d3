#include "host/cloud/size_limits.h"
#include "host/cloud/quantile.h"
#include "octree/parallel.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pointgi {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr unsigned limit_neighbours = 8;
// Radii over the spacing around: beside a 16-fold step in density 2 is right. Given normals are to be trusted, so that
// cells are right where the surface is uneven: less than 5 opens pinholes.
constexpr float most_spacings = 2.5f, most_spacings_given = 5.0f;
constexpr float surely_right = 1.0f; // over its own
// Radii over the cloud's median spacing: of leaves, which need not cover each other; where nothing vouches for a
// surface; and where the last few points of a scan are metres apart, one to an object.
constexpr float most_medians_of_leaves = 1.0f, most_medians = 2.0f, most_medians_alone = 16.0f;

float largest_radius(const PointCloud& cloud, const Sites& sites, std::uint32_t site) {
  float largest = 0.0f;
  for (const std::uint32_t point : sites.points(site))
    largest = std::max(largest, cloud.radius[point]);
  return largest;
}

/// Whether three quarters of the neighbours lie near the site's tangent plane and face along its normal, either way.
bool lies_on_a_surface(const Sites& sites, const std::vector<Eigen::Vector3f>& normal, std::uint32_t site,
                       const Neighbour* near, unsigned count) {
  constexpr float along = 0.7f;
  constexpr double flat = 0.2; // height over the plane, over the distance
  const Eigen::Vector3d own = normal[site].cast<double>();
  unsigned on_it = 0;
  for (unsigned j = 0; j < count; ++j) {
    const Eigen::Vector3d way = sites.position(near[j].site) - sites.position(site);
    on_it += std::abs(normal[site].dot(normal[near[j].site])) > along && std::abs(own.dot(way)) < flat * way.norm();
  }
  return 4 * on_it >= 3 * count;
}

} // namespace

void limit_sizes(PointCloud& cloud, const Sites& sites, const SiteSpacing& spacing,
                 const std::vector<Structure>& structure, CloudKind kind) {
  const bool sparse = kind == CloudKind::sparse, foliage = kind == CloudKind::foliage;
  const auto unit = static_cast<float>(sites.unit());
  const auto usual = static_cast<float>(median(sites.size(), [&](std::size_t s) { return spacing.spacing[s]; }));
  const float widest = (foliage ? most_medians_of_leaves : most_medians) * usual,
              widest_alone = most_medians_alone * usual;
  const float of_surface = structure.empty() ? most_spacings_given : most_spacings;
  parallel_ranges(sites.size(), 2048, [&](std::size_t begin, std::size_t end) {
    std::array<Neighbour, limit_neighbours> near;
    std::array<float, limit_neighbours> around;
    for (auto s = static_cast<std::uint32_t>(begin); s < end; ++s) {
      const Structure own = structure.empty() ? Structure::surface : structure[s];
      const float largest = largest_radius(cloud, sites, s) / unit;
      const bool on_surface = own == Structure::surface && !sparse && !foliage;
      if (on_surface && largest <= std::min(surely_right * spacing.spacing[s], widest_alone)) continue;
      const unsigned count = sites.nearest(s, limit_neighbours, near.data());
      if (count < 3) continue;
      for (unsigned j = 0; j < count; ++j)
        around[j] = spacing.spacing[near[j].site];
      std::nth_element(around.begin(), around.begin() + count / 2, around.begin() + count);
      const float second = std::sqrt(near[1].distance2), third = std::sqrt(near[2].distance2);
      float most = own == Structure::line     ? std::min(second, widest_alone)
                   : own == Structure::volume ? std::min(0.75f * third, widest)
                   : sparse                   ? std::min({spacing.spacing[s], around[count / 2], widest})
                   : foliage                  ? std::min(most_spacings * around[count / 2], widest)
                                              : of_surface * around[count / 2];
      if (on_surface && std::min(largest, most) > widest_alone &&
          !lies_on_a_surface(sites, spacing.normal, s, near.data(), count))
        most = widest_alone;
      for (const std::uint32_t point : sites.points(s)) {
        if (cloud.radius[point] <= most * unit) continue;
        cloud.radius[point] = std::max(most * unit, std::numeric_limits<float>::min());
        const double disc = pi * static_cast<double>(cloud.radius[point]) * static_cast<double>(cloud.radius[point]);
        cloud.area[point] = static_cast<float>(std::clamp(disc, 1e-37, static_cast<double>(cloud.area[point])));
      }
    }
  });
}

} // namespace pointgi
