#include "host/scene/load_sections.h"
#include <Eigen/Geometry>
#include <algorithm>

namespace pointgi {
namespace {

const std::vector<TypedKeys>& shape_types() {
  static const std::vector<TypedKeys> types = {
      {"quad", {"corner", "edge_u", "edge_v"}},
      {"sphere", {"centre", "radius", "inward"}},
      {"box", {"min", "max", "inward"}},
      {"disc", {"centre", "normal", "radius"}},
      {"cylinder", {"base", "top", "radius", "inward"}},
  };
  return types;
}

Vector3d edge(const TableReader& table, const char* key) {
  const Vector3d vector = table.need_vector3(key, limits::coordinate);
  if (vector.norm() < limits::length.low)
    table.fail(key, std::string("expected an edge of length ") + limits::length.words + ", found one of no length");
  return vector;
}

QuadShape load_quad(const TableReader& table) {
  QuadShape quad{table.need_vector3("corner", limits::coordinate), edge(table, "edge_u"), edge(table, "edge_v")};
  if (quad.edge_u.normalized().cross(quad.edge_v.normalized()).norm() < limits::parallel_sine)
    table.fail("edge_v", "is parallel to edge_u, so that the quad has no area; expected edges that span a surface");
  return quad;
}

SphereShape load_sphere(const TableReader& table) {
  return {table.need_vector3("centre", limits::coordinate), table.need_number("radius", limits::length),
          table.boolean("inward").value_or(false)};
}

BoxShape load_box(const TableReader& table) {
  const BoxShape box{table.need_vector3("min", limits::coordinate), table.need_vector3("max", limits::coordinate),
                     table.boolean("inward").value_or(false)};
  for (int axis = 0; axis < 3; ++axis)
    if (!(box.max[axis] - box.min[axis] >= limits::length.low))
      table.fail("max", std::string(1, "xyz"[axis]) + " is not above that of min, expected a box that is > 0 each way; "
                                                      "for a flat one use a quad");
  return box;
}

DiscShape load_disc(const TableReader& table) {
  const DiscShape disc{table.need_vector3("centre", limits::coordinate),
                       table.need_vector3("normal", limits::coordinate), table.need_number("radius", limits::length)};
  if (disc.normal.norm() < limits::length.low)
    table.fail("normal", "expected a direction, found a vector of no length");
  return disc;
}

CylinderShape load_cylinder(const TableReader& table) {
  const CylinderShape cylinder{table.need_vector3("base", limits::coordinate),
                               table.need_vector3("top", limits::coordinate),
                               table.need_number("radius", limits::length), table.boolean("inward").value_or(false)};
  if ((cylinder.top - cylinder.base).norm() <
      std::max(limits::length.low, limits::same_point * std::max(cylinder.top.norm(), cylinder.base.norm())))
    table.fail("top", "expected a point other than base, found the same; the cylinder has no axis");
  return cylinder;
}

ShapeGeometry load_geometry(const TableReader& table, const std::string& type) {
  if (type == "sphere") return load_sphere(table);
  if (type == "box") return load_box(table);
  if (type == "disc") return load_disc(table);
  if (type == "cylinder") return load_cylinder(table);
  return load_quad(table);
}

} // namespace

std::vector<ShapeSettings> load_shapes(const TableReader& root, const MaterialNames& materials) {
  std::vector<ShapeSettings> shapes;
  for (const TableReader& table : root.tables("shape")) {
    const std::string type = table.typed({"spacing", "material"}, shape_types());
    shapes.push_back({load_geometry(table, type), table.need_number("spacing", limits::length), materials.read(table),
                      table.place()});
  }
  return shapes;
}

} // namespace pointgi
