#include "host/scene/load_sections.h"

namespace pointgi {
namespace {

const std::vector<TypedKeys>& material_types() {
  static const std::vector<TypedKeys> types = {
      {"diffuse", {"albedo", "colour_space", "emission"}},
      {"mirror", {"reflectance"}},
      {"glass", {"ior", "absorption"}},
      {"phong", {"albedo", "colour_space", "emission", "specular", "exponent"}},
  };
  return types;
}

MaterialType type_called(const std::string& name) {
  for (const MaterialType type : {MaterialType::mirror, MaterialType::glass, MaterialType::phong})
    if (name == name_of(type)) return type;
  return MaterialType::diffuse;
}

/// What a surface gives back of the light that meets it, diffusely and specularly together, is at most all of it.
void check_energy(const TableReader& table, const MaterialSettings& material) {
  constexpr double rounding = 1e-9; // 0.7 + 0.3 written in decimals must pass
  if (!material.albedo || material.type != MaterialType::phong) return;
  const double most = (*material.albedo + material.specular).maxCoeff();
  if (most > 1.0 + rounding)
    table.fail("specular", "albedo + specular is above 1 in a channel, expected at most 1 (above 1 it would create "
                           "energy)");
}

MaterialSettings load_material(TableReader table, std::vector<std::string>& warnings) {
  MaterialSettings material;
  // Keys are reported under the material's name once it is known: "material.glass.ior" is what --set understands.
  if (const toml::node* name = table.find("name"); name != nullptr && name->is_string() && table.text("name"))
    table.rename("material." + *table.text("name"));
  material.type = type_called(table.typed({"name"}, material_types()));
  material.name = table.need_text("name", "a name that clouds and shapes refer to");
  material.place = table.place();
  material.albedo = table.vector3("albedo", limits::reflectance);
  if (const auto emission = table.vector3("emission", limits::light)) material.emission = *emission;
  if (const auto reflectance = table.vector3("reflectance", limits::reflectance)) material.reflectance = *reflectance;
  if (const auto ior = table.number("ior", limits::ior)) material.ior = *ior;
  if (const auto absorption = table.vector3("absorption", limits::absorption)) material.absorption = *absorption;
  if (const auto specular = table.vector3("specular", limits::reflectance)) material.specular = *specular;
  if (const auto exponent = table.number("exponent", limits::exponent)) material.exponent = *exponent;
  if (const auto space = table.choice("colour_space", {"srgb", "linear"})) {
    material.colour_space = *space == "srgb" ? ColourSpace::srgb : ColourSpace::linear;
    if (material.albedo)
      warnings.push_back(table.place("colour_space").text() + ": material " + pointgi::quoted(material.name) +
                         ": colour_space has no effect: it is that of the points' colours, but this material has an "
                         "albedo of its own, which is linear RGB; remove one of the two.");
  }
  check_energy(table, material);
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
