#include "host/materials/material_kind.h"
#include "host/scene/load_sections.h"

namespace pointgi {
namespace {

const std::vector<TypedKeys>& typed_keys() {
  static const std::vector<TypedKeys> types = [] {
    std::vector<TypedKeys> all;
    for (const MaterialType type : material_types())
      all.push_back({name_of(type), kind_of(type).keys});
    return all;
  }();
  return types;
}

MaterialType type_called(const std::string& name) {
  for (const MaterialType type : material_types())
    if (name == name_of(type)) return type;
  return MaterialType::diffuse;
}

MaterialSettings load_material(TableReader table, std::vector<std::string>& warnings) {
  MaterialSettings material;
  // Keys are reported under the material's name once it is known: "material.glass.ior" is what --set understands.
  if (const toml::node* name = table.find("name"); name != nullptr && name->is_string() && table.text("name"))
    table.rename("material." + *table.text("name"));
  material.type = type_called(table.typed({"name"}, typed_keys()));
  material.name = table.need_text("name", "a name that clouds and shapes refer to");
  material.place = table.place();
  kind_of(material.type).load(table, material);
  if (table.has("colour_space") && material.albedo)
    warnings.push_back(table.place("colour_space").text() + ": material " + pointgi::quoted(material.name) +
                       ": colour_space has no effect: it is that of the points' colours, but this material has an "
                       "albedo of its own, which is linear RGB; remove one of the two.");
  return material;
}

} // namespace

std::vector<MaterialSettings> load_materials(const TableReader& root, std::vector<std::string>& warnings) {
  std::vector<MaterialSettings> materials;
  std::unordered_set<std::string> names;
  for (const TableReader& table : root.tables("material")) {
    materials.push_back(load_material(table, warnings));
    if (names.insert(materials.back().name).second) continue;
    for (const MaterialSettings& first : materials)
      if (first.name == materials.back().name)
        table.fail("name", "expected a name of its own, found " + quoted(first.name) + ", which the material at " +
                               first.place.text() + " has already");
  }
  return materials;
}

MaterialNames::MaterialNames(const std::vector<MaterialSettings>& materials) {
  for (const MaterialSettings& material : materials) {
    names_.push_back(material.name);
    known_.insert(material.name);
  }
}

std::string MaterialNames::read(const TableReader& table) const {
  const std::string name = table.need_text("material", "the name of a [[material]]");
  if (known_.count(name) != 0) return name;
  table.fail("material", "expected the name of a material, found " + quoted(name) +
                             (names_.empty() ? "; the scene has no [[material]], add one of that name"
                                             : hint(name, names_, "materials")));
}

} // namespace pointgi
