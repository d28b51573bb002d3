#include "host/cloud/readers/ply_faces.h"
#include "host/cloud/readers/colour_range.h"
#include <algorithm>

namespace pointgi {

void PlyFaces::add_triangle(std::int64_t a, std::int64_t b, std::int64_t c) {
  triangles_.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(c)});
}

void PlyFaces::add_fan() {
  if (std::find(indices_.begin(), indices_.end(), -1) != indices_.end()) {
    ++with_marker_;
    return;
  }
  if (indices_.size() < 3) ++too_small_;
  for (std::size_t k = 2; k < indices_.size(); ++k)
    add_triangle(indices_[0], indices_[k - 1], indices_[k]);
}

void PlyFaces::add_strips() {
  std::size_t start = 0;
  for (std::size_t k = 0; k < indices_.size(); ++k) {
    if (indices_[k] < 0) {
      start = k + 1;
      continue;
    }
    if (k < start + 2) continue;
    const std::int64_t a = indices_[k - 2], b = indices_[k - 1], c = indices_[k];
    if (a == b || b == c || a == c) continue;
    if ((k - start) % 2 == 0)
      add_triangle(a, b, c);
    else
      add_triangle(b, a, c);
  }
}

void PlyFaces::add_colour(const Eigen::Vector3f& colour) {
  if (colour_.empty()) colour_.assign(vertex_count_, Eigen::Vector4f::Zero());
  if (!colour.allFinite()) return;
  for (const std::int64_t index : indices_)
    if (index >= 0) colour_[static_cast<std::size_t>(index)] += (Eigen::Vector4f() << colour, 1.0f).finished();
}

void PlyFaces::finish(const std::array<FieldType, 3>& types, PointCloud& cloud, CloudReport& report) {
  cloud.triangle = std::move(triangles_);
  report.triangles = cloud.triangle.size();
  if (with_marker_ > 0)
    report.warnings.push_back(
        std::to_string(with_marker_) +
        " faces hold the vertex index -1 and were left out; save the mesh with plain faces if they matter.");
  if (too_small_ > 0)
    report.warnings.push_back(std::to_string(too_small_) +
                              " faces have fewer than three corners and were left out; nothing needs to be done.");
  if (colour_.empty()) return;
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (const Eigen::Vector4f& colour : colour_)
    sum += colour.cast<double>();
  if (!(sum[3] > 0.0)) return; // no vertex is in a face
  const Eigen::Vector3f mean = (sum.head<3>() / sum[3]).cast<float>();
  for (const Eigen::Vector4f& colour : colour_)
    cloud.colour.push_back(colour[3] > 0.0f ? Eigen::Vector3f(colour.head<3>() / colour[3]) : mean);
  report.notes.push_back("the file has colours for its faces only: each point got the mean of its faces' colours");
  scale_colours(types, cloud.colour, report);
}

} // namespace pointgi
