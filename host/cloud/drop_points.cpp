#include "host/cloud/drop_points.h"
#include <algorithm>
#include <cmath>
#include <limits>

namespace pointgi {

namespace {

constexpr std::uint32_t gone = std::numeric_limits<std::uint32_t>::max();

bool positive(float value) {
  return std::isnormal(value) && value > 0;
}

template <class T>
void keep_renumbered(std::vector<T>& values, const std::vector<std::uint32_t>& number, std::size_t kept) {
  if (values.empty()) return;
  for (std::size_t i = 0; i < number.size(); ++i)
    if (number[i] != gone) values[number[i]] = values[i];
  values.resize(kept);
}

} // namespace

std::size_t drop_unusable_points(PointCloud& cloud, const CompleteOptions& options) {
  const bool use_normal = !cloud.normal.empty() && options.normals != NormalSource::estimate;
  const bool use_radius = !cloud.radius.empty() && options.radii != RadiusSource::estimate;
  const auto usable = [&](std::size_t i) {
    if (!cloud.position[i].allFinite()) return false;
    if (!cloud.colour.empty() && !cloud.colour[i].allFinite()) return false;
    if (!cloud.area.empty() && !positive(cloud.area[i])) return false;
    if (use_radius && !positive(cloud.radius[i])) return false;
    return !use_normal || (cloud.normal[i].allFinite() && std::isnormal(cloud.normal[i].stableNorm()));
  };

  const std::size_t n = cloud.size();
  std::vector<std::uint32_t> number(n);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < n; ++i)
    number[i] = usable(i) ? static_cast<std::uint32_t>(kept++) : gone;

  const auto broken = [&](std::array<std::uint32_t, 3>& face) {
    for (std::uint32_t& corner : face) {
      corner = corner < n ? number[corner] : gone;
      if (corner == gone) return true;
    }
    return false;
  };
  cloud.triangle.erase(std::remove_if(cloud.triangle.begin(), cloud.triangle.end(), broken), cloud.triangle.end());
  if (kept == n) return 0;
  keep_renumbered(cloud.position, number, kept);
  keep_renumbered(cloud.normal, number, kept);
  keep_renumbered(cloud.colour, number, kept);
  keep_renumbered(cloud.radius, number, kept);
  keep_renumbered(cloud.area, number, kept);
  return n - kept;
}

} // namespace pointgi
