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
// Radii over the spacing around: beside a 16-fold step in density 2 is right.
constexpr float most_spacings = 2.5f;
constexpr float surely_right = 1.0f; // over its own
// Radii over the cloud's median spacing: where nothing vouches for a surface, and where the last few points of a scan
// are metres apart, one to an object.
constexpr float most_medians = 2.0f, most_medians_of_surface = 16.0f;

float largest_radius(const PointCloud& cloud, const Sites& sites, std::size_t site) {
  float largest = 0.0f;
  for (const std::uint32_t point : sites.points(static_cast<std::uint32_t>(site)))
    largest = std::max(largest, cloud.radius[point]);
  return largest;
}

} // namespace

void limit_sizes(PointCloud& cloud, const Sites& sites, const std::vector<float>& spacing,
                 const std::vector<Structure>& structure, bool sparse) {
  const auto unit = static_cast<float>(sites.unit());
  const auto usual = static_cast<float>(value_at_rank(spacing.size(), spacing.size() / 2,
                                                      [&](std::size_t s) { return static_cast<double>(spacing[s]); }));
  const float widest = most_medians * usual, widest_surface = most_medians_of_surface * usual;
  parallel_ranges(sites.size(), 2048, [&](std::size_t begin, std::size_t end) {
    std::array<Neighbour, limit_neighbours> near;
    std::array<float, limit_neighbours> around;
    for (std::size_t s = begin; s < end; ++s) {
      const Structure own = structure.empty() ? Structure::surface : structure[s];
      if (own == Structure::surface && !sparse &&
          largest_radius(cloud, sites, s) <= std::min(surely_right * spacing[s], widest_surface) * unit)
        continue;
      const unsigned count = sites.nearest(static_cast<std::uint32_t>(s), limit_neighbours, near.data());
      if (count < 3) continue;
      for (unsigned j = 0; j < count; ++j)
        around[j] = spacing[near[j].site];
      std::nth_element(around.begin(), around.begin() + count / 2, around.begin() + count);
      const float second = std::sqrt(near[1].distance2), third = std::sqrt(near[2].distance2);
      const float most = own == Structure::line     ? std::min(second, widest_surface)
                         : own == Structure::volume ? std::min(0.75f * third, widest)
                         : sparse                   ? std::min({spacing[s], around[count / 2], widest})
                                                    : std::min(most_spacings * around[count / 2], widest_surface);
      for (const std::uint32_t point : sites.points(static_cast<std::uint32_t>(s))) {
        if (cloud.radius[point] <= most * unit) continue;
        cloud.radius[point] = std::max(most * unit, std::numeric_limits<float>::min());
        const double disc = pi * static_cast<double>(cloud.radius[point]) * static_cast<double>(cloud.radius[point]);
        cloud.area[point] = static_cast<float>(std::clamp(disc, 1e-37, static_cast<double>(cloud.area[point])));
      }
    }
  });
}

} // namespace pointgi
