#include "host/cloud/keep_points.h"
#include <algorithm>
#include <limits>

namespace pointgi {

namespace {

constexpr std::uint32_t gone = std::numeric_limits<std::uint32_t>::max();

template <class T>
void keep_renumbered(std::vector<T>& values, const std::vector<std::uint32_t>& number, std::size_t kept) {
  if (values.empty()) return;
  for (std::size_t i = 0; i < number.size(); ++i)
    if (number[i] != gone) values[number[i]] = values[i];
  values.resize(kept);
}

/// The file's numbers of the points that are left, where the cloud had all points of its file so far.
std::vector<std::uint32_t> first_records(const std::vector<std::uint32_t>& number, std::size_t kept) {
  std::vector<std::uint32_t> record(kept);
  for (std::size_t i = 0; i < number.size(); ++i)
    if (number[i] != gone) record[number[i]] = static_cast<std::uint32_t>(i);
  return record;
}

void keep_triangles(PointCloud& cloud, const std::vector<std::uint32_t>& number) {
  const auto broken = [&](std::array<std::uint32_t, 3>& face) {
    for (std::uint32_t& corner : face) {
      corner = corner < number.size() ? number[corner] : gone;
      if (corner == gone) return true;
    }
    return false;
  };
  cloud.triangle.erase(std::remove_if(cloud.triangle.begin(), cloud.triangle.end(), broken), cloud.triangle.end());
}

void keep_clips(PointCloud& cloud, const std::vector<std::uint32_t>& number) {
  std::size_t kept = 0;
  for (const ClippedPoint& clipped : cloud.clipped)
    if (number[clipped.point] != gone) cloud.clipped[kept++] = {number[clipped.point], clipped.clip};
  cloud.clipped.resize(kept);
}

} // namespace

std::size_t keep_points(PointCloud& cloud, const std::function<bool(std::size_t)>& wanted) {
  const std::size_t n = cloud.size();
  std::vector<std::uint32_t> number(n);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < n; ++i)
    number[i] = wanted(i) ? static_cast<std::uint32_t>(kept++) : gone;
  keep_triangles(cloud, number);
  keep_clips(cloud, number);
  if (kept == n) return 0;
  if (cloud.record.empty())
    cloud.record = first_records(number, kept);
  else
    keep_renumbered(cloud.record, number, kept);
  keep_renumbered(cloud.position, number, kept);
  keep_renumbered(cloud.normal, number, kept);
  keep_renumbered(cloud.colour, number, kept);
  keep_renumbered(cloud.radius, number, kept);
  keep_renumbered(cloud.area, number, kept);
  keep_renumbered(cloud.opacity, number, kept);
  keep_renumbered(cloud.structure, number, kept);
  keep_renumbered(cloud.station, number, kept);
  for (Field& field : cloud.fields)
    keep_renumbered(field.values, number, kept);
  return n - kept;
}

} // namespace pointgi
