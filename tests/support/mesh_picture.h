#pragma once
/// What a camera sees of a mesh, by projecting its triangles: truth beside pictures of its vertices as splats.
#include "host/cloud/readers/readers.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace pointgi::test {

/// A camera with a square picture, as the scene file has it; up is y.
struct SquareCamera {
  Eigen::Vector3d position, look_at;
  double fov_deg;
  int side;

  std::string text() const {
    const auto list = [](const Eigen::Vector3d& v) {
      return "[" + std::to_string(v.x()) + ", " + std::to_string(v.y()) + ", " + std::to_string(v.z()) + "]";
    };
    return "[camera]\nposition = " + list(position) + "\nlook_at = " + list(look_at) +
           "\nfov_deg = " + std::to_string(fov_deg) + "\n";
  }
};

/// Of each pixel's middle, row after row from the top.
struct MeshPicture {
  std::vector<double> depth;           ///< infinity where nothing is
  std::vector<Eigen::Vector3d> normal; ///< of the vertices, interpolated; unit, towards the camera

  bool covers(std::size_t pixel) const { return std::isfinite(depth[pixel]); }
};

inline MeshPicture picture_of_mesh(const PointCloud& mesh, const SquareCamera& camera) {
  using Eigen::Vector3d;
  std::vector<Vector3d> normals(mesh.size(), Vector3d::Zero());
  for (const auto& t : mesh.triangle) { // twice its area, that large faces count more
    const Vector3d n = (mesh.position[t[1]] - mesh.position[t[0]]).cross(mesh.position[t[2]] - mesh.position[t[0]]);
    for (const std::uint32_t v : t)
      normals[v] += n;
  }
  const Vector3d forward = (camera.look_at - camera.position).normalized();
  const Vector3d right = forward.cross(Vector3d::UnitY()).normalized(), up = right.cross(forward);
  const double scale = 0.5 * camera.side / std::tan(camera.fov_deg * 3.14159265358979 / 360.0);
  const auto seen = [&](const Vector3d& p) -> Vector3d { // column, row, 1 / depth
    const Vector3d off = p - camera.position;
    const double depth = off.dot(forward);
    return {0.5 * camera.side + scale * off.dot(right) / depth, 0.5 * camera.side - scale * off.dot(up) / depth,
            1.0 / depth};
  };
  const auto pixels = static_cast<std::size_t>(camera.side) * static_cast<std::size_t>(camera.side);
  MeshPicture picture{std::vector<double>(pixels, INFINITY), std::vector<Vector3d>(pixels, Vector3d::Zero())};
  for (const auto& t : mesh.triangle) {
    const Vector3d a = seen(mesh.position[t[0]]), b = seen(mesh.position[t[1]]), c = seen(mesh.position[t[2]]);
    const double area = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
    if (area == 0.0) continue;
    const auto first = [&](double x) { return std::clamp(static_cast<int>(std::ceil(x - 0.5)), 0, camera.side); };
    const auto past = [&](double x) { return std::clamp(static_cast<int>(std::floor(x - 0.5)) + 1, 0, camera.side); };
    for (int row = first(std::min({a.y(), b.y(), c.y()})); row < past(std::max({a.y(), b.y(), c.y()})); ++row)
      for (int column = first(std::min({a.x(), b.x(), c.x()})); column < past(std::max({a.x(), b.x(), c.x()}));
           ++column) {
        const double x = column + 0.5, y = row + 0.5;
        const double wa = ((b.x() - x) * (c.y() - y) - (b.y() - y) * (c.x() - x)) / area,
                     wb = ((c.x() - x) * (a.y() - y) - (c.y() - y) * (a.x() - x)) / area, wc = 1.0 - wa - wb;
        if (wa < 0.0 || wb < 0.0 || wc < 0.0) continue;
        const double depth = 1.0 / (wa * a.z() + wb * b.z() + wc * c.z());
        const std::size_t pixel = static_cast<std::size_t>(row * camera.side + column);
        if (depth >= picture.depth[pixel]) continue;
        picture.depth[pixel] = depth;
        const Vector3d n = wa * a.z() * normals[t[0]].normalized() + wb * b.z() * normals[t[1]].normalized() +
                           wc * c.z() * normals[t[2]].normalized();
        const Vector3d ray = forward + (x - 0.5 * camera.side) / scale * right - (y - 0.5 * camera.side) / scale * up;
        picture.normal[pixel] = n.normalized() * (n.dot(ray) > 0.0 ? -1.0 : 1.0);
      }
  }
  return picture;
}

} // namespace pointgi::test
