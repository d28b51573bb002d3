#include "host/view/view_points.h"
#include <algorithm>
#include <cmath>

namespace pointgi {

namespace {

constexpr std::size_t enough = 400000;
constexpr double least_surface = 0.1; // a cloud with less of it has none to speak of

std::size_t surface_points(const PointCloud& cloud) {
  return static_cast<std::size_t>(std::count_if(cloud.structure.begin(), cloud.structure.end(), is_surface));
}

void measure(ViewPoints& points) {
  double area = 0.0, arms = 0.0, volume = 0.0;
  Vector3d middle(0, 0, 0), sum(0, 0, 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double a = points.area[i];
    area += a;
    middle += a * points.position[i];
    sum += a * points.normal[i].cast<double>();
  }
  middle /= area;
  points.mean_normal = sum / area;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3d arm = points.position[i] - middle;
    volume += points.area[i] * points.normal[i].cast<double>().dot(arm);
    arms += points.area[i] * arm.norm();
  }
  points.outwardness = arms > 0.0 ? volume / arms : 0.0;
}

} // namespace

double quantile(std::vector<double>& values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

bool ViewPoints::in_frame(const Vector3d& p) const {
  const Vector3d slack = 0.02 * extent();
  return (p.array() >= (low - slack).array()).all() && (p.array() <= (high + slack).array()).all();
}

ViewPoints view_points(const PointCloud& cloud, double cut) {
  const std::size_t surface = surface_points(cloud);
  const bool chosen = static_cast<double>(surface) >= least_surface * static_cast<double>(cloud.size()) && surface > 0;
  const std::size_t step = 1 + ((chosen ? surface : cloud.size()) - 1) / enough;
  ViewPoints points;
  std::size_t number = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (chosen && !is_surface(cloud.structure[i])) continue;
    if (number++ % step != 0) continue;
    points.position.push_back(cloud.position[i]);
    points.normal.push_back(cloud.normal[i]);
    points.radius.push_back(cloud.radius[i]);
    points.area.push_back(cloud.area[i]);
  }
  points.scale_of_area = static_cast<double>(step);
  std::vector<double> values(points.size());
  for (int a = 0; a < 3; ++a) {
    for (std::size_t i = 0; i < points.size(); ++i)
      values[i] = points.position[i][a];
    points.low[a] = quantile(values, cut);
    points.high[a] = quantile(values, 1.0 - cut);
  }
  measure(points);
  return points;
}

} // namespace pointgi
