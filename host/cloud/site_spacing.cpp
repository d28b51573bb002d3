#include "host/cloud/site_spacing.h"
#include "host/cloud/quantile.h"
#include "octree/parallel.h"
#include <algorithm>
#include <array>
#include <cmath>

namespace pointgi {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double isolated_factor = 8.0; // spacing over that of the neighbours; a 16-fold density step gives 4 to 6
constexpr unsigned isolated_neighbours = 12;
constexpr std::size_t most_looked_at = 1'000'000; // sites; a share of their neighbours is then right to 0.0003

const auto lone_spacing = static_cast<float>(std::sqrt(2.0) / splat_overlap); // a square for a disc of radius 1

float positive_spacing_of(const Neighbour* near, unsigned count) {
  return std::max(spacing_of(near, count), 1e-18f);
}

/// Median of the neighbours' own spacings (the lower one).
float neighbours_spacing(const Sites& sites, std::uint32_t site, const std::vector<float>& spacing) {
  std::array<Neighbour, isolated_neighbours> near;
  std::array<float, isolated_neighbours> values;
  const unsigned count = sites.nearest(site, isolated_neighbours, near.data());
  for (unsigned j = 0; j < count; ++j)
    values[j] = spacing[near[j].site];
  std::nth_element(values.begin(), values.begin() + (count - 1) / 2, values.begin() + count);
  return values[(count - 1) / 2];
}

/// Whether two neighbours on one surface have contrary signs. Those of a thin wall's two sides, back to back or, across
/// a gap, face to face, are right as they are.
bool oppose(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& e) {
  if (static_cast<double>(a.dot(b)) > opposite_cosine) return false;
  const float above = a.dot(e), below = b.dot(e), clear = 0.02f * e.norm();
  return !(above > clear && below < -clear) && !(above < -clear && below > clear);
}

struct Pairs {
  std::uint64_t all = 0, opposite = 0;

  Pairs& operator+=(const Pairs& other) {
    all += other.all;
    opposite += other.opposite;
    return *this;
  }
};

/// Of a site and those of its neighbours that lie beside it, not above or below.
Pairs pairs_at(const Sites& sites, const std::vector<Eigen::Vector3f>& normal, std::uint32_t site) {
  std::array<Neighbour, spacing_neighbours> near;
  const unsigned count = sites.nearest(site, spacing_neighbours, near.data());
  Pairs pairs;
  for (unsigned j = 0; j < count; ++j) {
    const Eigen::Vector3f e = (sites.position(near[j].site) - sites.position(site)).cast<float>();
    if (std::abs(e.dot(normal[site])) > 0.5f * e.norm()) continue;
    ++pairs.all;
    pairs.opposite += oppose(normal[site], normal[near[j].site], e);
  }
  return pairs;
}

} // namespace

float spacing_of(const Neighbour* near, unsigned count) {
  // In the plane count = density pi d²; four neighbours of a row of five, or two points, still give their distance.
  const unsigned m = std::min(count, spacing_neighbours);
  return std::sqrt(near[m - 1].distance2 * static_cast<float>(pi / spacing_neighbours));
}

std::vector<float> spacings_of(const Sites& sites) {
  std::vector<float> spacing(sites.size(), lone_spacing);
  if (sites.size() == 1) return spacing;
  parallel_ranges(sites.size(), 1024, [&](std::size_t begin, std::size_t end) {
    std::array<Neighbour, spacing_neighbours> near;
    for (std::size_t s = begin; s < end; ++s) {
      const unsigned count = sites.nearest(static_cast<std::uint32_t>(s), spacing_neighbours, near.data());
      spacing[s] = positive_spacing_of(near.data(), count);
    }
  });
  return spacing;
}

std::vector<float> keep_neighbours_and_spacings(Sites& sites, unsigned k) {
  std::vector<float> spacing(sites.size());
  const auto see = [&](std::uint32_t site, const Neighbour* near) { spacing[site] = positive_spacing_of(near, k); };
  if (!sites.keep_neighbours(k, see)) spacing = spacings_of(sites);
  return spacing;
}

void rein_in_isolated(const Sites& sites, std::vector<float>& spacing) {
  if (sites.size() == 1) return;
  constexpr std::size_t grain = 4096;
  const auto own = [&](std::size_t s) { return spacing[s]; };
  const float suspicious = static_cast<float>(median(spacing.size(), own)) * static_cast<float>(isolated_factor);
  struct Change {
    std::size_t site;
    float spacing;
  };
  std::vector<std::vector<Change>> changes((sites.size() + grain - 1) / grain); // made once all are found
  parallel_ranges(sites.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      if (spacing[s] <= suspicious) continue;
      const float usual = neighbours_spacing(sites, static_cast<std::uint32_t>(s), spacing);
      if (spacing[s] > static_cast<float>(isolated_factor) * usual) changes[begin / grain].push_back({s, usual});
    }
  });
  for (const std::vector<Change>& range : changes)
    for (const Change& change : range)
      spacing[change.site] = change.spacing;
}

SiteSpacing with_normals(const Sites& sites, const std::vector<Eigen::Vector3f>& normals,
                         std::vector<float>&& spacing) {
  SiteSpacing result;
  result.spacing = std::move(spacing);
  result.normal.resize(sites.size());
  parallel_ranges(sites.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s)
      result.normal[s] = normals[*sites.points(static_cast<std::uint32_t>(s)).begin()];
  });
  if (sites.size() == 1) return result;
  const std::size_t step = (sites.size() + most_looked_at - 1) / most_looked_at;
  const Pairs pairs = parallel_sum((sites.size() + step - 1) / step, 1024, Pairs(),
                                   [&](Pairs& sum, std::size_t begin, std::size_t end) {
                                     for (std::size_t i = begin; i < end; ++i)
                                       sum += pairs_at(sites, result.normal, static_cast<std::uint32_t>(i * step));
                                   });
  if (pairs.all > 0) result.opposite = static_cast<double>(pairs.opposite) / static_cast<double>(pairs.all);
  return result;
}

} // namespace pointgi
