#include "host/cloud/readers/ply_layout.h"
#include "host/cloud/input_file.h"
#include <algorithm>

namespace pointgi {

namespace {

using Triple = std::array<std::size_t, 3>;
constexpr Triple no_triple{PlyLayout::none, PlyLayout::none, PlyLayout::none};

FieldPlan plan_vertex(const PlyHeader& header, const PlyElement& vertex, const ReadRequest& request,
                      const std::string& file) {
  std::vector<FieldInfo> fields;
  for (const PlyProperty& property : vertex.properties)
    if (!property.is_list) fields.push_back({property.name, property.type, 1.0, 0.0});
  FieldPlan plan =
      match_fields(std::move(fields), request, file, "line " + std::to_string(vertex.line) + ": element vertex");
  // The bits of a float in a binary file are read as what they are.
  for (std::size_t f = 0; f < plan.fields.size(); ++f)
    if (plan.slot[f] == slot_packed_colour && plan.fields[f].type == FieldType::f32 &&
        header.format != PlyFormat::ascii)
      plan.fields[f].type = FieldType::u32;
  return plan;
}

std::size_t find_index_list(const PlyElement& element) {
  for (std::size_t p = 0; p < element.properties.size(); ++p) {
    const PlyProperty& property = element.properties[p];
    if (property.is_list && (property.name == "vertex_indices" || property.name == "vertex_index")) return p;
  }
  return PlyLayout::none;
}

/// The properties of the three names, all of them or none.
Triple find_triple(const PlyElement& element, const std::array<const char*, 3>& names) {
  Triple found = no_triple;
  for (std::size_t p = 0; p < element.properties.size(); ++p)
    for (std::size_t k = 0; k < 3; ++k)
      if (!element.properties[p].is_list && lookup_name(element.properties[p].name) == names[k]) found[k] = p;
  return std::count(found.begin(), found.end(), PlyLayout::none) == 0 ? found : no_triple;
}

Triple find_face_colour(const PlyElement& face) {
  for (const auto& names : {std::array<const char*, 3>{"red", "green", "blue"},
                            {"r", "g", "b"},
                            {"diffuse_red", "diffuse_green", "diffuse_blue"}})
    if (const Triple found = find_triple(face, names); found != no_triple) return found;
  return no_triple;
}

void find_elements(const PlyHeader& header, PlyLayout& layout) {
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
    } else if (element.name == "station" && element.count > 0) {
      layout.station_position = find_triple(element, {"x", "y", "z"});
      layout.station_element = layout.station_position == no_triple ? PlyLayout::none : e;
    }
  }
}

const char* use_of(const PlyLayout& layout, std::size_t element, std::size_t property) {
  const auto in = [&](const Triple& triple) {
    return std::find(triple.begin(), triple.end(), property) != triple.end();
  };
  if (element == layout.face_element && property == layout.face_list) return "faces";
  if (element == layout.face_element && in(layout.face_colour)) return "colour";
  if (element == layout.strip_element && property == layout.strip_list) return "faces (strips)";
  if (element == layout.station_element && in(layout.station_position)) return "scanner position";
  return "not used";
}

void report_uses(const PlyHeader& header, const PlyLayout& layout, CloudReport& report) {
  for (std::size_t e = 0; e < header.elements.size(); ++e) {
    const PlyElement& element = header.elements[e];
    std::size_t field = 0;
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      const bool is_field = e == layout.vertex_element && !property.is_list;
      std::string type = name_of(property.type);
      if (property.is_list) type = std::string("list ") + name_of(property.count_type) + " " + type;
      report.properties.push_back({printable(element.name) + "." + printable(property.name) + " (" + type + ")",
                                   is_field ? layout.plan.use_of(field++) : use_of(layout, e, p)});
    }
  }
}

} // namespace

PlyLayout plan_ply(const PlyHeader& header, const ReadRequest& request, const std::string& file, CloudReport& report) {
  PlyLayout layout;
  find_elements(header, layout);
  if (layout.vertex_element == PlyLayout::none)
    throw Error(ErrorKind::input, file + ": line " + std::to_string(header.body_line - 1) +
                                      ": the header declares no element vertex; expected \"element vertex COUNT\" "
                                      "with the properties x, y and z");
  layout.plan = plan_vertex(header, header.elements[layout.vertex_element], request, file);
  if (layout.station_element == PlyLayout::none) {
    layout.plan.forget(slot_station); // nothing gives the positions
  } else if (const PlyElement& station = header.elements[layout.station_element]; station.count > 65535) {
    throw Error(ErrorKind::input, file + ": line " + std::to_string(station.line) + ": " +
                                      std::to_string(station.count) + " stations, expected at most 65535");
  }
  const bool coloured =
      layout.plan.has(slot_colour) || layout.plan.has(slot_packed_colour) || layout.plan.has(slot_harmonic);
  if (!coloured && layout.face_element != PlyLayout::none)
    layout.face_colour = find_face_colour(header.elements[layout.face_element]);
  if (layout.face_colour != no_triple) layout.plan.forget(slot_intensity); // it need not stand in for colours
  report_fields(layout.plan, report);
  report_uses(header, layout, report);
  return layout;
}

} // namespace pointgi
