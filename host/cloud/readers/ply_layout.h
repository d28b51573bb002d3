#pragma once
/// Where a PLY file has what the reader wants: elements, fields of the vertices, lists and colours of faces.
#include "host/cloud/readers/field_plan.h"
#include "host/cloud/readers/ply_header.h"
#include <array>
#include <string>
#include <vector>

namespace pointgi {

struct PlyLayout {
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  std::size_t vertex_element = none;
  FieldPlan plan;                     ///< of the vertices' single numbers
  std::size_t face_element = none;    ///< element "face" ...
  std::size_t face_list = none;       ///< ... and its property of vertex indices
  std::size_t strip_element = none;   ///< element "tristrips": triangle strips, -1 between two strips
  std::size_t strip_list = none;      ///< its property of vertex indices
  std::size_t station_element = none; ///< element "station": positions of scanners

  /// Properties of a record that hold a triple of numbers; none where it has not.
  std::array<std::size_t, 3> face_colour{none, none, none}; ///< only where the vertices have no colours
  std::array<std::size_t, 3> station_position{none, none, none};
};

/// Understands by name: the fields of match_fields() in element vertex; vertex_indices or vertex_index of face and
/// tristrips; colours of face, where the vertices have none; x y z of element station, which the vertices' property
/// station counts from 0. Writes the use of every property to `report`. Throws Error(input) when there is no vertex
/// element, x, y or z is missing, or there are more than 65535 stations.
PlyLayout plan_ply(const PlyHeader& header, const ReadRequest& request, const std::string& file, CloudReport& report);

} // namespace pointgi
