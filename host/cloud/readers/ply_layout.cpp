#include "host/cloud/readers/ply_layout.h"
#include "host/cloud/input_file.h"
#include <algorithm>

namespace pointgi {

namespace {

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

/// Takes the element as scanner positions, if it has single numbers x, y and z.
void find_stations(const PlyElement& element, std::size_t index, const std::string& file, PlyLayout& layout) {
  constexpr const char* names[] = {"x", "y", "z"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto found = std::find_if(element.properties.begin(), element.properties.end(),
                                    [&](const PlyProperty& p) { return !p.is_list && p.name == names[axis]; });
    if (found == element.properties.end()) return;
    layout.station_axes[axis] = static_cast<std::size_t>(found - element.properties.begin());
  }
  if (element.count > 65535) // of which 16 bits can be an index
    throw Error(ErrorKind::input, file + ": line " + std::to_string(element.line) + ": " +
                                      std::to_string(element.count) +
                                      " scanner positions, expected at most 65535; split the scan");
  if (element.count > 0) layout.station_element = index;
}

bool is_station_axis(const PlyLayout& layout, std::size_t element, std::size_t property) {
  const auto& axes = layout.station_axes;
  return element == layout.station_element && std::find(axes.begin(), axes.end(), property) != axes.end();
}

std::string describe(const PlyElement& element, const PlyProperty& property) {
  std::string type = name_of(property.type);
  if (property.is_list) type = std::string("list ") + name_of(property.count_type) + " " + type;
  return printable(element.name) + "." + printable(property.name) + " (" + type + ")";
}

} // namespace

PlyLayout plan_ply(const PlyHeader& header, const ReadRequest& request, const std::string& file, CloudReport& report) {
  PlyLayout layout;
  for (std::size_t e = 0; e < header.elements.size(); ++e) {
    const PlyElement& element = header.elements[e];
    if (element.name == "vertex") {
      layout.vertex_element = e;
    } else if (element.name == "face") {
      layout.face_list = find_index_list(element);
      layout.face_element = layout.face_list == PlyLayout::none ? PlyLayout::none : e;
    } else if (element.name == "station") {
      find_stations(element, e, file, layout);
    } else if (element.name == "tristrips") {
      layout.strip_list = find_index_list(element);
      layout.strip_element = layout.strip_list == PlyLayout::none ? PlyLayout::none : e;
    }
  }
  if (layout.vertex_element == PlyLayout::none)
    throw Error(ErrorKind::input, file + ": line " + std::to_string(header.body_line - 1) +
                                      ": the header declares no element vertex; expected \"element vertex COUNT\" "
                                      "with the properties x, y and z");
  layout.plan = plan_vertex(header, header.elements[layout.vertex_element], request, file);
  if (layout.station_element == PlyLayout::none) layout.plan.forget(slot_station); // an index into nothing
  report_fields(layout.plan, report);

  for (std::size_t e = 0; e < header.elements.size(); ++e) {
    const PlyElement& element = header.elements[e];
    std::size_t field = 0;
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const char* use = "not used";
      if (e == layout.vertex_element && !element.properties[p].is_list)
        use = layout.plan.use_of(field++);
      else if (e == layout.face_element && p == layout.face_list)
        use = "faces";
      else if (e == layout.strip_element && p == layout.strip_list)
        use = "faces (strips)";
      else if (is_station_axis(layout, e, p))
        use = "scanner position";
      report.properties.push_back({describe(element, element.properties[p]), use});
    }
  }
  return layout;
}

} // namespace pointgi
