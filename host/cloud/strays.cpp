#include "host/cloud/strays.h"
#include "host/cloud/quantile.h"
#include "octree/parallel.h"
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pointgi {

namespace {

constexpr std::size_t least_sites = 100;
constexpr double most_strays = 0.25;
constexpr unsigned neighbours = 16;
// The last row of points beside a 16-fold step in density has 4 times the spacing of its neighbours beyond the step,
// but half of its neighbours are of its own kind; a point as far out as that on its own has none.
constexpr float alone = 4.0f;
constexpr float sparse = 3.0f;       // of the cloud's median spacing
constexpr double fills_space = 0.15; // least variance over the middle one; a sheet that is rough by its spacing: 0.1
constexpr double no_line = 0.01;     // middle variance over the largest

constexpr float densest_suspicion = 1.5f; // of the median spacing around, along the curve: denser sites are no strays

/// The median spacing of a range of sites; infinite where no spacing is above densest_suspicion times it, so that no
/// site of the range needs a search.
float median_if_uneven(const std::vector<float>& spacing, std::size_t begin, std::size_t end) {
  const auto first = spacing.begin() + static_cast<std::ptrdiff_t>(begin),
             past = spacing.begin() + static_cast<std::ptrdiff_t>(end);
  const float most = *std::max_element(first, past);
  const auto denser = std::count_if(first, past, [&](float s) { return densest_suspicion * s < most; });
  if (2 * denser <= past - first) return std::numeric_limits<float>::infinity(); // the median is none of these
  return median(std::vector<float>(first, past));
}

bool is_alone(float own, const Neighbour* near, unsigned count, const std::vector<float>& spacing) {
  std::array<float, neighbours> theirs;
  for (unsigned j = 0; j < count; ++j)
    theirs[j] = spacing[near[j].site];
  const unsigned middle = (count - 1) / 2;
  std::nth_element(theirs.begin(), theirs.begin() + middle, theirs.begin() + count);
  return own > alone * theirs[middle];
}

bool lies_in_a_crowd(const Sites& sites, std::uint32_t site, const Neighbour* near, unsigned count) {
  const double scale = 1.0 / std::sqrt(std::max(1e-30, static_cast<double>(near[count - 1].distance2)));
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (unsigned j = 0; j < count; ++j) {
    const Eigen::Vector3d offset = (sites.position(near[j].site) - sites.position(site)) * scale;
    mean += offset / (count + 1);
    moments += offset * offset.transpose() / (count + 1);
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(moments - mean * mean.transpose(), Eigen::EigenvaluesOnly);
  const Eigen::Vector3d variance = solver.eigenvalues();
  return variance[0] > fills_space * variance[1] && variance[1] > no_line * variance[2];
}

} // namespace

std::vector<char> find_strays(const Sites& sites, const std::vector<float>& spacing) {
  std::vector<char> stray(sites.size(), 0);
  if (sites.size() < least_sites) return stray;
  const auto usual = static_cast<float>(median(spacing.size(), [&](std::size_t s) { return spacing[s]; }));
  parallel_ranges(sites.size(), 2048, [&](std::size_t begin, std::size_t end) {
    std::array<Neighbour, neighbours> near;
    const float dense = densest_suspicion * std::min(median_if_uneven(spacing, begin, end), usual);
    for (std::size_t s = begin; s < end; ++s) {
      if (spacing[s] <= dense) continue;
      const auto site = static_cast<std::uint32_t>(s);
      const unsigned count = sites.nearest(site, neighbours, near.data());
      stray[s] = is_alone(spacing[s], near.data(), count, spacing) ||
                 (spacing[s] > sparse * usual && lies_in_a_crowd(sites, site, near.data(), count));
    }
  });
  const auto found = std::count(stray.begin(), stray.end(), 1);
  if (static_cast<double>(found) > most_strays * sites.size()) std::fill(stray.begin(), stray.end(), 0);
  return stray;
}

} // namespace pointgi
