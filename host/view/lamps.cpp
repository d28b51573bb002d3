#include "host/view/lamps.h"
#include "host/view/view_points.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace pointgi {

namespace {

constexpr std::size_t most_lamps = 10;
constexpr double pi = 3.14159265358979323846;

/// A column of the room above one part of its plan.
struct Column {
  double floor = -INFINITY,
         ceiling = INFINITY; ///< heights: the highest level surface below the middle, the lowest above
  std::size_t points = 0;
  Vector3d place{0, 0, 0};
};

/// The plan in square parts, and what is above and below the middle height of each.
std::vector<Column> columns_of(const ViewPoints& points, const Vector3d& up, double side) {
  const Vector3d u = up.unitOrthogonal(), v = up.cross(u);
  const Vector3d centre = points.centre();
  const double half_u = 0.5 * u.cwiseAbs().dot(points.extent()), half_v = 0.5 * v.cwiseAbs().dot(points.extent());
  const auto count_u = static_cast<std::size_t>(std::clamp(std::round(2.0 * half_u / side), 1.0, 16.0));
  const auto count_v = static_cast<std::size_t>(std::clamp(std::round(2.0 * half_v / side), 1.0, 16.0));
  const double middle = up.dot(centre);
  std::vector<Column> columns(count_u * count_v);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const double x = (static_cast<double>(i % count_u) + 0.5) / static_cast<double>(count_u) * 2.0 - 1.0;
    const double y = (static_cast<double>(i / count_u) + 0.5) / static_cast<double>(count_v) * 2.0 - 1.0;
    columns[i].place = centre + x * half_u * u + y * half_v * v;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3d d = points.position[i] - centre;
    const double x = 0.5 * (d.dot(u) / half_u + 1.0), y = 0.5 * (d.dot(v) / half_v + 1.0);
    if (!(x >= 0.0 && x < 1.0 && y >= 0.0 && y < 1.0)) continue;
    Column& column = columns[static_cast<std::size_t>(y * static_cast<double>(count_v)) * count_u +
                             static_cast<std::size_t>(x * static_cast<double>(count_u))];
    ++column.points;
    const double height = up.dot(points.position[i]), facing = up.dot(points.normal[i].cast<double>());
    if (facing > 0.8 && height < middle) column.floor = std::max(column.floor, height);
    if (facing < -0.8 && height > middle) column.ceiling = std::min(column.ceiling, height);
  }
  return columns;
}

std::vector<Vector3d> places_of_lamps(const ViewPoints& points, const Vector3d& up, double height) {
  std::vector<Column> columns = columns_of(points, up, 1.5 * height);
  const auto is_open = [](const Column& c) { return !std::isfinite(c.floor) || !std::isfinite(c.ceiling); };
  columns.erase(std::remove_if(columns.begin(), columns.end(), is_open), columns.end());
  std::sort(columns.begin(), columns.end(), [](const Column& a, const Column& b) { return a.points > b.points; });
  columns.resize(std::min(columns.size(), most_lamps));
  std::vector<Vector3d> places;
  for (const Column& c : columns)
    places.push_back(c.place + (c.floor + 0.75 * (c.ceiling - c.floor) - up.dot(c.place)) * up);
  if (places.empty()) places.push_back(points.centre() + 0.25 * height * up);
  return places;
}

} // namespace

std::size_t light_room(Scene& scene, const WorldSplats& splats, const ChosenView& view) {
  const ViewPoints points = view_points(splats.cloud, 0.005);
  const double height = std::fabs(view.up.dot(points.high) - view.up.dot(points.low));
  std::vector<Vector3d> places;
  for (const CloudReport& report : splats.reports)
    places.insert(places.end(), report.stations.begin(), report.stations.end());
  if (places.empty()) places = places_of_lamps(points, view.up, height);
  places.resize(std::min(places.size(), most_lamps));
  scene.lights.clear();
  for (const Vector3d& place : places) {
    LightSettings lamp;
    lamp.type = LightType::point;
    lamp.vector = place;
    // At its height above the floor it gives what the sun outdoors does.
    lamp.strength = 0.5 * pi * height * height * Vector3d(1.03, 1.0, 0.94);
    scene.lights.push_back(lamp);
  }
  scene.environment = Vector3d(0.3, 0.3, 0.31);
  return places.size();
}

} // namespace pointgi
