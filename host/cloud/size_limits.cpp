#include "host/cloud/size_limits.h"
#include "octree/parallel.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pointgi {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr unsigned limit_neighbours = 8;
constexpr float most_spacings = 2.5f; // radius over the spacing around: beside a 16-fold step in density 2 is right

} // namespace

void limit_sizes(PointCloud& cloud, const Sites& sites, const std::vector<float>& spacing,
                 const std::vector<Structure>& structure, bool sparse) {
  const auto unit = static_cast<float>(sites.unit());
  parallel_ranges(sites.size(), 2048, [&](std::size_t begin, std::size_t end) {
    std::array<Neighbour, limit_neighbours> near;
    std::array<float, limit_neighbours> around;
    for (std::size_t s = begin; s < end; ++s) {
      const unsigned count = sites.nearest(static_cast<std::uint32_t>(s), limit_neighbours, near.data());
      if (count < 3) continue;
      for (unsigned j = 0; j < count; ++j)
        around[j] = spacing[near[j].site];
      std::nth_element(around.begin(), around.begin() + count / 2, around.begin() + count);
      const float second = std::sqrt(near[1].distance2), third = std::sqrt(near[2].distance2);
      const Structure own = structure[s];
      const float most = own == Structure::line     ? second
                         : own == Structure::volume ? 0.75f * third
                         : sparse                   ? std::min(spacing[s], around[count / 2])
                                                    : most_spacings * around[count / 2];
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
