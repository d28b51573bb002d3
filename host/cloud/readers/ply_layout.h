#pragma once
/// Which property of a PLY file means what to us.
#include "host/cloud/point_cloud.h"
#include "host/cloud/readers/ply_header.h"
#include <array>
#include <string>
#include <vector>

namespace pointgi {

/// Places in a row of vertex values.
enum PlySlot : int {
  slot_position = 0,
  slot_normal = 3,
  slot_colour = 6,
  slot_radius = 9,
  slot_count = 10,
  slot_none = -1
};

struct PlyLayout {
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  std::size_t vertex_element = none;
  std::vector<int> slots; ///< PlySlot plus axis or channel of each vertex property, slot_none for unused ones
  bool has_normal = false;
  bool has_colour = false;
  bool has_radius = false;
  std::array<PlyType, 3> colour_type{};
  std::array<bool, 3> is_float32{}; ///< x, y, z

  std::size_t face_element = none;  ///< element "face" ...
  std::size_t face_list = none;     ///< ... and its property of vertex indices
  std::size_t strip_element = none; ///< element "tristrips": triangle strips, -1 between two strips
  std::size_t strip_list = none;
};

/// Understands by name: x y z; nx ny nz or normal_x normal_y normal_z; red green blue, r g b or diffuse_red
/// diffuse_green diffuse_blue; radius; vertex_indices or vertex_index of face and tristrips. Writes the use of every
/// property to `report`. Throws Error(input) when there is no vertex element or x, y or z is missing.
PlyLayout plan_ply(const PlyHeader& header, const std::string& file, CloudReport& report);

} // namespace pointgi
