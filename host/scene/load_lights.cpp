#include "host/scene/load_sections.h"

namespace pointgi {
namespace {

const std::vector<std::string> no_common_keys;

const std::vector<TypedKeys>& light_types() {
  static const std::vector<TypedKeys> types = {
      {"point", {"position", "power_w"}},
      {"directional", {"direction", "irradiance"}},
  };
  return types;
}

PointLight load_point(const TableReader& table) {
  return {table.need_vector3("position", limits::coordinate), table.need_vector3("power_w", limits::light)};
}

DirectionalLight load_directional(const TableReader& table) {
  const Vector3d direction = table.need_vector3("direction", limits::coordinate);
  if (direction.norm() < limits::length.low)
    table.fail("direction", "expected the way the light travels, found a vector of no length");
  return {direction.normalized(), table.need_vector3("irradiance", limits::light)};
}

} // namespace

std::vector<LightSettings> load_lights(const TableReader& root) {
  std::vector<LightSettings> lights;
  for (const TableReader& table : root.tables("light")) {
    const std::string type = table.typed(no_common_keys, light_types());
    if (type == "directional")
      lights.push_back({load_directional(table), table.place()});
    else
      lights.push_back({load_point(table), table.place()});
  }
  return lights;
}

} // namespace pointgi
