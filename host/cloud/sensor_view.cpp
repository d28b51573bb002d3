#include "host/cloud/sensor_view.h"
#include "host/cloud/quantile.h"
#include "octree/parallel.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace pointgi {

namespace {

constexpr std::size_t sample_size = 60'000; // sites looked at; enough to tell sheets apart that matter
constexpr double near_in_space = 6.0;       // times the distance of the 8th neighbour: slanted walls stretch it
constexpr unsigned seen_neighbours = 4;

// A Kinect's frame has a one_depth of 0.995, airborne lidar 0.67, closed objects seen from outside 0.5 to 0.75, a
// photogrammetric cloud seen from an arbitrary origin 0.92.
constexpr double least_one_depth = 0.97;
constexpr double farthest_sensor = 10.0;   // sizes of the cloud
constexpr double least_range_ratio = 1.35; // of a cloud whose evenness tells something
constexpr double least_evenness = -0.25;   // scanners have -0.01 to 0.2, sparse points of structure from motion -0.4

/// Share of distinct values, to a hundred-thousandth of their range.
double distinct_share(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const double least = 1e-5 * (values.back() - values.front());
  std::size_t steps = 1;
  for (std::size_t i = 1; i < values.size(); ++i)
    steps += values[i] - values[i - 1] > least;
  return static_cast<double>(steps) / static_cast<double>(values.size());
}

bool lies_on_lattice(const std::vector<Eigen::Vector3d>& offsets, int forward) {
  std::vector<double> u, v;
  for (const Eigen::Vector3d& p : offsets) {
    if (!(std::abs(p[forward]) > 0)) return false;
    u.push_back(p[(forward + 1) % 3] / p[forward]);
    v.push_back(p[(forward + 2) % 3] / p[forward]);
  }
  constexpr double few = 0.2;
  return distinct_share(std::move(u)) < few && distinct_share(std::move(v)) < few;
}

} // namespace

bool SensorView::convincing() const {
  if (one_depth < least_one_depth || away > farthest_sensor) return false;
  return lattice || (range_ratio > least_range_ratio && evenness > least_evenness);
}

SensorView sensor_view(const Sites& sites, const Eigen::Vector3d& sensor) {
  SensorView view;
  if (sites.size() < 100) return view;
  const std::size_t step = (sites.size() + sample_size - 1) / sample_size;
  std::vector<Eigen::Vector3d> offsets, directions;
  std::vector<double> ranges;
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = -low, mean = Eigen::Vector3d::Zero();
  for (std::size_t s = 0; s < sites.size(); s += step) {
    const Eigen::Vector3d offset = sites.position(static_cast<std::uint32_t>(s)) - sensor;
    const double range = offset.norm();
    if (!(range > 1e-9)) continue; // a record without a return
    offsets.push_back(offset);
    directions.push_back(offset / range);
    ranges.push_back(range);
    mean += directions.back();
    low = low.cwiseMin(offset), high = high.cwiseMax(offset);
  }
  if (offsets.size() < 100) return view;
  const std::size_t n = offsets.size();
  std::vector<double> ordered = ranges;
  std::sort(ordered.begin(), ordered.end());
  view.away = ordered[n / 2] / 4.0; // half of the cloud lies within 1 local unit of its median
  const double quarter = ordered[n / 4], three_quarters = ordered[3 * n / 4];
  view.range_ratio = ordered[n * 7 / 8] / ordered[n / 8];
  mean.normalize();
  const auto ahead =
      std::count_if(directions.begin(), directions.end(), [&](const auto& d) { return d.dot(mean) > 0.05; });
  view.all_around = static_cast<double>(ahead) < 0.999 * static_cast<double>(n);
  int forward = 0;
  mean.cwiseAbs().maxCoeff(&forward);
  if (!view.all_around) view.lattice = step == 1 || n > 1000 ? lies_on_lattice(offsets, forward) : false;

  const Sites in_space(offsets), as_seen(directions);
  if (as_seen.size() < 100) return view; // a line through the sensor
  std::vector<char> agrees(as_seen.size());
  std::vector<double> angle(as_seen.size());
  parallel_ranges(as_seen.size(), 1024, [&](std::size_t begin, std::size_t end) {
    std::array<Neighbour, 8> near;
    for (std::size_t s = begin; s < end; ++s) {
      const auto site = static_cast<std::uint32_t>(s);
      const std::uint32_t point = *as_seen.points(site).begin();
      const unsigned seen = as_seen.nearest(site, seen_neighbours, near.data());
      angle[s] = std::sqrt(static_cast<double>(near[seen - 1].distance2));
      const Eigen::Vector3d& other = offsets[*as_seen.points(near[0].site).begin()];
      const unsigned count = in_space.nearest_to(in_space.to_local(offsets[point]), 8, near.data());
      const double reach = std::sqrt(static_cast<double>(near[count - 1].distance2)) * in_space.unit();
      agrees[s] = (other - offsets[point]).norm() <= near_in_space * reach;
    }
  });
  view.one_depth =
      static_cast<double>(std::count(agrees.begin(), agrees.end(), 1)) / static_cast<double>(agrees.size());
  std::vector<double> near_angles, far_angles;
  for (std::uint32_t s = 0; s < as_seen.size(); ++s) {
    const double range = ranges[*as_seen.points(s).begin()];
    if (range <= quarter) near_angles.push_back(angle[s]);
    if (range >= three_quarters) far_angles.push_back(angle[s]);
  }
  if (!near_angles.empty() && !far_angles.empty() && view.range_ratio > 1.0)
    view.evenness =
        std::log(std::max(1e-12, median(std::move(far_angles))) / std::max(1e-12, median(std::move(near_angles)))) /
        std::log(view.range_ratio);
  return view;
}

} // namespace pointgi
