#pragma once
/// Where a PLY file has what the reader wants: elements, fields of the vertices, lists of faces.
#include "host/cloud/readers/field_plan.h"
#include "host/cloud/readers/ply_header.h"
#include <array>
#include <string>
#include <vector>

namespace pointgi {

struct PlyLayout {
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  std::size_t vertex_element = none;
  FieldPlan plan;                   ///< of the vertices' single numbers
  std::size_t face_element = none;  ///< element "face" ...
  std::size_t face_list = none;     ///< ... and its property of vertex indices
  std::size_t strip_element = none; ///< element "tristrips": triangle strips, -1 between two strips
  std::size_t strip_list = none;
  std::size_t station_element = none;        ///< element "station": where the scanner stood ...
  std::array<std::size_t, 3> station_axes{}; ///< ... and its properties x, y, z
};

/// Understands by name: the fields of plan_fields() in element vertex; vertex_indices or vertex_index of face and
/// tristrips; x y z of element station, to which the vertices' station is an index. Writes the use of every property to
/// `report`. Throws Error(input) when there is no vertex element or x, y or z is missing.
PlyLayout plan_ply(const PlyHeader& header, const ReadRequest& request, const std::string& file, CloudReport& report);

} // namespace pointgi
