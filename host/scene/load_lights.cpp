#include "host/lights/light_kind.h"
#include "host/scene/load_sections.h"

namespace pointgi {
namespace {

const std::vector<std::string> no_common_keys;

const std::vector<TypedKeys>& typed_keys() {
  static const std::vector<TypedKeys> types = [] {
    std::vector<TypedKeys> all;
    for (const LightType type : light_types())
      all.push_back({name_of(type), kind_of(type).keys});
    return all;
  }();
  return types;
}

LightType type_called(const std::string& name) {
  for (const LightType type : light_types())
    if (name == name_of(type)) return type;
  return LightType::point;
}

} // namespace

std::vector<LightSettings> load_lights(const TableReader& root, UpAxis up, std::vector<std::string>& warnings) {
  std::vector<LightSettings> lights;
  for (const TableReader& table : root.tables("light")) {
    LightSettings& light = lights.emplace_back();
    light.type = type_called(table.typed(no_common_keys, typed_keys()));
    light.place = table.place();
    light.is_far = kind_of(light.type).is_far;
    kind_of(light.type).load(table, {up, warnings}, light);
  }
  return lights;
}

} // namespace pointgi
