#pragma once
/// Faces of a PLY file: polygons and strips become triangles, their colours those of the vertices.
#include "host/cloud/point_cloud.h"

namespace pointgi {

class PlyFaces {
public:
  explicit PlyFaces(std::size_t vertex_count) : vertex_count_(vertex_count) {}

  void reserve(std::size_t faces) { triangles_.reserve(faces); }

  /// Vertex indices of the face being read; -1 stands for the restart marker that some writers put into faces.
  std::vector<std::int64_t>& indices() { return indices_; }

  void add_fan();
  /// Every second triangle of a strip is wound the other way round; repeated vertices are turns, not triangles.
  void add_strips();
  /// Of the face in indices(), in the file's numbers. Takes memory for all vertices at the first call.
  void add_colour(const Eigen::Vector3f& colour);

  /// Moves the triangles to the cloud, and where faces had colours gives each vertex the mean of its faces'; the mean
  /// of all to those in no face. `types`: of the colours. Adds warnings and notes to `report`.
  void finish(const std::array<FieldType, 3>& types, PointCloud& cloud, CloudReport& report);

private:
  void add_triangle(std::int64_t a, std::int64_t b, std::int64_t c);

  std::size_t vertex_count_;
  std::vector<std::int64_t> indices_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<Eigen::Vector4f> colour_; ///< sum over the faces of each vertex, and their number
  std::size_t with_marker_ = 0;
  std::size_t too_small_ = 0;
};

} // namespace pointgi
