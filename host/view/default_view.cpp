#include "host/view/default_view.h"
#include "host/scene/lighting.h"
#include "host/view/frame_filler.h"
#include "host/view/up.h"
#include <Eigen/Geometry>
#include <cmath>
#include <fmt/format.h>

namespace pointgi {

namespace {

constexpr double degree = 3.14159265358979323846 / 180.0;

/// Share of the points beyond each end of what a picture of such a cloud shows. Scans thin out with the distance.
double cut_of(CloudKind kind) {
  switch (kind) {
  case CloudKind::station:
    return 0.03;
  case CloudKind::map:
    return 0.02;
  case CloudKind::sparse:
    return 0.04;
  default:
    return 0.005;
  }
}

bool is_across(const Vector3d& extent, int thin, double share) {
  const double middle = extent.sum() - extent.minCoeff() - extent.maxCoeff();
  return extent[thin] <= share * middle;
}

/// Much flatter than wide, facing along the thin axis.
bool is_terrain(const ViewPoints& points) {
  int thin = 0;
  points.extent().minCoeff(&thin);
  return is_across(points.extent(), thin, 0.35) && std::fabs(points.mean_normal[thin]) >= 0.5;
}

/// Closed, and facing in.
bool is_inside_out(const ViewPoints& points) {
  return points.mean_normal.norm() < 0.15 && points.outwardness < -0.1;
}

/// The kind that all clouds have in common, as their files or neighbourhoods tell; else by what the points look like.
CloudKind kind_of(const WorldSplats& splats, const ViewPoints& points) {
  const auto& reports = splats.reports;
  const auto is_other = [&](const CloudReport& r) { return r.kind_reason.empty() || r.kind != reports.front().kind; };
  CloudKind kind = CloudKind::model;
  if (!reports.empty() && std::none_of(reports.begin(), reports.end(), is_other)) kind = reports.front().kind;
  if (kind != CloudKind::model) return kind;
  if (!reports.empty() && reports.front().normals_from.find("sensor at the origin") != std::string::npos)
    return CloudKind::depth_frame;
  if (is_terrain(points)) return CloudKind::terrain;
  return is_inside_out(points) ? CloudKind::room : kind;
}

Vector3d first_station(const WorldSplats& splats) {
  for (const CloudReport& report : splats.reports)
    if (!report.stations.empty()) return report.stations.front();
  return Vector3d::Zero();
}

UpChoice up_for(const Scene& scene, const WorldSplats& splats, const ViewPoints& points, CloudKind kind) {
  if (scene.up_chosen) return {up_of(scene), "as asked for"};
  for (const CloudReport& report : splats.reports)
    if (report.up) return {report.up->normalized(), "of the file or this kind of cloud"};
  std::optional<Vector3d> usual;
  for (const CloudReport& report : splats.reports)
    if (report.usual_up && !usual) usual = report.usual_up;
  return find_up(points, kind, first_station(splats), usual);
}

/// Area that faces down in the upper half, against what faces up in the lower.
bool has_ceiling(const ViewPoints& points, const Vector3d& up) {
  double floor = 0.0, ceiling = 0.0;
  const double middle = up.dot(points.centre());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double facing = up.dot(points.normal[i].cast<double>());
    if (std::fabs(facing) < 0.8) continue;
    (up.dot(points.position[i]) > middle ? ceiling : floor) += std::copysign(points.area[i], facing);
  }
  return floor > 0.0 && ceiling < -0.3 * floor;
}

/// The direction with no part along up; any where there is none else.
Vector3d level(const Vector3d& direction, const Vector3d& up) {
  const Vector3d flat = direction - direction.dot(up) * up;
  return flat.norm() > 1e-9 * direction.norm() ? Vector3d(flat.normalized()) : Vector3d(up.unitOrthogonal());
}

/// -y where z is up, +z where y is: as maps and models have the viewer.
Vector3d viewers_side(const Vector3d& up) {
  return level(std::fabs(up.z()) > 0.7 ? Vector3d(0, -1, 0) : Vector3d(0, 0, 1), up);
}

/// Where the front is: across the longer side.
Vector3d front_of(const ViewPoints& points, const Vector3d& up) {
  const Vector3d depth = viewers_side(up), across = up.cross(depth), extent = points.extent();
  return depth.cwiseAbs().dot(extent) > 1.25 * across.cwiseAbs().dot(extent) ? across : depth;
}

Vector3d from_above(const Vector3d& side, const Vector3d& up, double degrees) {
  return std::cos(degrees * degree) * side.normalized() + std::sin(degrees * degree) * up;
}

/// Behind the station, as it looks at most of what it sees; where it stands in the middle, along the longer side.
Vector3d behind_station(const ViewPoints& points, const Vector3d& station, const Vector3d& up) {
  const Vector3d ahead = points.centre() - station, flat = ahead - ahead.dot(up) * up;
  const double size = level(Vector3d(points.extent()), up).cwiseAbs().dot(points.extent());
  if (flat.norm() > 0.15 * size) return -flat.normalized();
  return front_of(points, up);
}

std::string name_of_up(const UpChoice& choice) {
  int axis = 0;
  const double most = choice.up.cwiseAbs().maxCoeff(&axis);
  const std::string name = most > 0.999
                               ? std::string(choice.up[axis] < 0.0 ? "-" : "") + "xyz"[axis]
                               : fmt::format("[{:.3g}, {:.3g}, {:.3g}]", choice.up.x(), choice.up.y(), choice.up.z());
  return name + " is up (" + choice.reason + ")";
}

/// Sets the camera; returns what it shows.
std::string look(Scene& scene, const WorldSplats& splats, const ViewPoints& points, ChosenView& view) {
  const Vector3d& up = view.up;
  // An open scan faces the way it was scanned from.
  const Vector3d open = points.mean_normal - points.mean_normal.dot(up) * up;
  const auto fit = [&](const Vector3d& from) {
    fill_frame(scene, points, from, up, scene.camera.backfaces.value_or(Backfaces::shade));
  };
  switch (view.kind) {
  case CloudKind::depth_frame:
    look_from(scene, points, first_station(splats), up);
    return "seen from its sensor";
  case CloudKind::map:
    if (open.norm() > 0.3) { // a wall, a slope
      fit(from_above(open, up, 20.0));
      return "seen from the side that most points face";
    }
    [[fallthrough]];
  case CloudKind::terrain:
    fit(from_above(viewers_side(up), up, 35.0));
    return "seen from the south, 35 degrees down";
  case CloudKind::station:
    if (!view.is_closed_room) {
      fit(from_above(behind_station(points, first_station(splats), up), up, 30.0));
      return "seen from behind and above the station";
    }
    [[fallthrough]];
  case CloudKind::room: {
    const Vector3d front = front_of(points, up);
    fit(from_above(front + 0.5 * up.cross(front), up, 40.0));
    return "seen from outside, near walls seen through";
  }
  case CloudKind::model:
  case CloudKind::sparse:
  case CloudKind::foliage:
    break;
  }
  view.is_open = open.norm() > 0.15;
  const Vector3d front = front_of(points, up);
  fit(from_above(view.is_open ? open : Vector3d(front + 0.5 * up.cross(front)), up, 17.0));
  return view.is_open ? "seen from the side that most points face" : "seen from the front";
}

bool is_indoors(const ChosenView& view, const ViewPoints& points) {
  return (view.kind == CloudKind::room || view.kind == CloudKind::station) && has_ceiling(points, view.up);
}

/// Of what is open backs would be seen, and they are black.
void see_through_backs_of_open(Scene& scene, const ChosenView& view, const ViewPoints& points) {
  const bool is_open = view.kind != CloudKind::model || points.mean_normal.norm() > 0.1;
  if (!scene.camera.backfaces && is_open) scene.camera.backfaces = Backfaces::see_through;
}

/// So many digits that a step is less than a ten-thousandth of the way from one to the other, and no more.
std::string place_text(const Vector3d& place, const Vector3d& other) {
  const double ratio = place.cwiseAbs().maxCoeff() / std::max((place - other).norm(), 1e-300);
  const int digits = std::clamp(5 + static_cast<int>(std::ceil(std::log10(std::max(ratio, 1.0)))), 6, 17);
  return fmt::format("[{:.{}g}, {:.{}g}, {:.{}g}]", place.x(), digits, place.y(), digits, place.z(), digits);
}

std::string sentence_of(const char* who, const Scene& scene, const ChosenView& view, const UpChoice& up,
                        const std::string& shown) {
  const Vector3d &p = scene.camera.position, &t = scene.camera.look_at;
  return fmt::format("camera {}: {}, {}{}{} (position = {}, look_at = {}, fov_deg = {:.4g}){}", who, name_of(view.kind),
                     name_of_up(up), shown.empty() ? "" : ", ", shown, place_text(p, t), place_text(t, p),
                     scene.camera.fov_deg,
                     scene.camera.backfaces == Backfaces::see_through ? "; backs of surfaces are seen through" : "");
}

} // namespace

ChosenView choose_camera(Scene& scene, const WorldSplats& splats) {
  ViewPoints points = view_points(splats.cloud, cut_of(CloudKind::model));
  ChosenView view;
  view.kind = kind_of(splats, points);
  if (cut_of(view.kind) != cut_of(CloudKind::model)) points = view_points(splats.cloud, cut_of(view.kind));
  const UpChoice up = up_for(scene, splats, points, view.kind);
  view.up = up.up;
  view.is_closed_room = is_indoors(view, points);
  see_through_backs_of_open(scene, view, points);
  const std::string shown = look(scene, splats, points, view);
  view.sentence = sentence_of("chosen", scene, view, up, shown);
  return view;
}

ChosenView given_view(Scene& scene, const WorldSplats& splats, bool bare) {
  constexpr double parallel = 0.02;
  const ViewPoints points = view_points(splats.cloud, cut_of(CloudKind::model));
  ChosenView view;
  view.kind = kind_of(splats, points);
  view.up = up_of(scene);
  if (bare && !scene.camera.up) {
    const UpChoice up = up_for(scene, splats, points, view.kind);
    const Vector3d ahead = (scene.camera.look_at - scene.camera.position).normalized();
    view.up = up.up;
    if (ahead.cross(up.up).norm() > parallel)
      scene.camera.up = up.up; // else the scene's own, which it does not look along
    see_through_backs_of_open(scene, view, points);
    view.sentence = sentence_of("given", scene, view, up, "");
  }
  view.is_closed_room = is_indoors(view, points);
  return view;
}

} // namespace pointgi
