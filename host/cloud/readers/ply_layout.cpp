#include "host/cloud/readers/ply_layout.h"
#include "host/cloud/input_file.h"
#include <initializer_list>
#include <unordered_map>

namespace pointgi {

namespace {

using Names = std::array<const char*, 3>;
using Places = std::unordered_map<std::string, std::size_t>; ///< scalar property -> its place in the element

/// The first of the `candidates` whose three names are all there gets the slots from `slot` on.
bool assign_triple(std::initializer_list<Names> candidates, int slot, const Places& places, std::vector<int>& slots) {
  for (const Names& names : candidates) {
    std::array<std::size_t, 3> found{};
    bool complete = true;
    for (int k = 0; k < 3 && complete; ++k) {
      const auto place = places.find(names[k]);
      complete = place != places.end();
      if (complete) found[k] = place->second;
    }
    if (!complete) continue;
    for (int k = 0; k < 3; ++k)
      slots[found[k]] = slot + k;
    return true;
  }
  return false;
}

void plan_vertex(const PlyElement& vertex, const std::string& file, PlyLayout& layout) {
  Places places;
  for (std::size_t p = 0; p < vertex.properties.size(); ++p)
    if (!vertex.properties[p].is_list) places.emplace(vertex.properties[p].name, p);
  layout.slots.assign(vertex.properties.size(), slot_none);

  for (const char* axis : {"x", "y", "z"})
    if (places.count(axis) == 0)
      throw Error(ErrorKind::input, file + ": line " + std::to_string(vertex.line) +
                                        ": element vertex has no property \"" + axis +
                                        "\"; expected x, y and z (single numbers, lower case)");
  assign_triple({{"x", "y", "z"}}, slot_position, places, layout.slots);
  layout.has_normal =
      assign_triple({{"nx", "ny", "nz"}, {"normal_x", "normal_y", "normal_z"}}, slot_normal, places, layout.slots);
  layout.has_colour =
      assign_triple({{"red", "green", "blue"}, {"r", "g", "b"}, {"diffuse_red", "diffuse_green", "diffuse_blue"}},
                    slot_colour, places, layout.slots);
  if (const auto place = places.find("radius"); place != places.end()) {
    layout.slots[place->second] = slot_radius;
    layout.has_radius = true;
  }
  for (std::size_t p = 0; p < layout.slots.size(); ++p) {
    const int slot = layout.slots[p];
    if (slot >= slot_colour && slot < slot_colour + 3)
      layout.colour_type[static_cast<std::size_t>(slot - slot_colour)] = vertex.properties[p].type;
    if (slot >= slot_position && slot < slot_position + 3 && vertex.properties[p].type == PlyType::f32)
      layout.is_float32[static_cast<std::size_t>(slot - slot_position)] = true;
  }
}

std::size_t find_index_list(const PlyElement& element) {
  for (std::size_t p = 0; p < element.properties.size(); ++p) {
    const PlyProperty& property = element.properties[p];
    if (property.is_list && (property.name == "vertex_indices" || property.name == "vertex_index")) return p;
  }
  return PlyLayout::none;
}

const char* use_of_slot(int slot) {
  if (slot == slot_none) return "not used";
  if (slot < slot_normal) return "position";
  if (slot < slot_colour) return "normal";
  return slot < slot_radius ? "colour" : "radius";
}

std::string describe(const PlyElement& element, const PlyProperty& property) {
  std::string type = name_of(property.type);
  if (property.is_list) type = std::string("list ") + name_of(property.count_type) + " " + type;
  return printable(element.name) + "." + printable(property.name) + " (" + type + ")";
}

} // namespace

PlyLayout plan_ply(const PlyHeader& header, const std::string& file, CloudReport& report) {
  PlyLayout layout;
  for (std::size_t e = 0; e < header.elements.size(); ++e) {
    const PlyElement& element = header.elements[e];
    if (element.name == "vertex") {
      layout.vertex_element = e;
    } else if (element.name == "face") {
      layout.face_list = find_index_list(element);
      layout.face_element = layout.face_list == PlyLayout::none ? PlyLayout::none : e;
    } else if (element.name == "tristrips") {
      layout.strip_list = find_index_list(element);
      layout.strip_element = layout.strip_list == PlyLayout::none ? PlyLayout::none : e;
    }
  }
  if (layout.vertex_element == PlyLayout::none)
    throw Error(ErrorKind::input, file + ": line " + std::to_string(header.body_line - 1) +
                                      ": the header declares no element vertex; expected \"element vertex COUNT\" "
                                      "with the properties x, y and z");
  plan_vertex(header.elements[layout.vertex_element], file, layout);

  for (std::size_t e = 0; e < header.elements.size(); ++e) {
    const PlyElement& element = header.elements[e];
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const char* use = "not used";
      if (e == layout.vertex_element)
        use = use_of_slot(layout.slots[p]);
      else if (e == layout.face_element && p == layout.face_list)
        use = "faces";
      else if (e == layout.strip_element && p == layout.strip_list)
        use = "faces (strips)";
      report.properties.push_back({describe(element, element.properties[p]), use});
    }
  }
  return layout;
}

} // namespace pointgi
