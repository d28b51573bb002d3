#include "host/materials/material_kind.h"
#include "host/scene/toml_words.h"

namespace pointgi {

// A kind's file defines `NAME_kind`.
#define DECLARE_KIND(ID, name) extern const MaterialKind name##_kind;
MATERIAL_KINDS(DECLARE_KIND)
#undef DECLARE_KIND

const MaterialKind& kind_of(MaterialType type) {
#define KIND(ID, name) &name##_kind,
  static const MaterialKind* const kinds[] = {MATERIAL_KINDS(KIND)};
#undef KIND
  return *kinds[static_cast<std::size_t>(type)];
}

const std::vector<MaterialType>& material_types() {
#define TYPE(ID, name) MaterialType::name,
  static const std::vector<MaterialType> all{MATERIAL_KINDS(TYPE)};
#undef TYPE
  return all;
}

const char* name_of(MaterialType type) {
#define NAME(ID, name) #name,
  static constexpr const char* names[] = {MATERIAL_KINDS(NAME)};
#undef NAME
  return names[static_cast<std::size_t>(type)];
}

bool exchanges_light(const MaterialSettings& material) {
  return (material.flags & MATERIAL_REFLECTS_DIFFUSELY) != 0;
}

std::vector<std::string> joined(const std::vector<std::string>& first, const std::vector<std::string>& second) {
  std::vector<std::string> all = first;
  all.insert(all.end(), second.begin(), second.end());
  return all;
}

const std::vector<std::string>& diffuse_keys() {
  static const std::vector<std::string> keys{"albedo", "colour_space", "emission", "two_sided"};
  return keys;
}

namespace {

/// Three numbers, or fields of the points by which it goes.
void load_albedo(const TableReader& table, MaterialSettings& material) {
  const toml::node* node = table.find("albedo");
  if (node != nullptr && node->is_string())
    table.fail("albedo", "expected three numbers or a table like { field = \"intensity\" }, found a text");
  if (node == nullptr || !node->is_table()) {
    material.albedo = table.vector3("albedo", limits::reflectance);
    return;
  }
  const TableReader keys = *table.table("albedo");
  keys.allow_only({"field", "fields", "low", "high"});
  FieldAlbedo albedo;
  if (keys.has("field") && keys.has("fields")) keys.fail("fields", "there is a field, too; remove one of the two");
  if (const auto fields = keys.texts("fields", 3))
    albedo.fields = *fields;
  else
    albedo.fields = {keys.need_text("field", "the name of a field of the points")};
  albedo.low = keys.number("low", limits::field_value);
  albedo.high = keys.number("high", limits::field_value);
  if (albedo.low && albedo.high && !(*albedo.low < *albedo.high))
    keys.fail("high", "expected a number above low, found one that is not; low is black and high is white");
  material.albedo_field = std::move(albedo);
}

} // namespace

void load_diffuse_keys(const TableReader& table, MaterialSettings& material) {
  material.flags |= MATERIAL_REFLECTS_DIFFUSELY;
  load_albedo(table, material);
  if (const auto emission = table.vector3("emission", limits::light)) material.emission = *emission;
  const toml::node* sides = table.find("two_sided");
  if (sides != nullptr && sides->value<std::string>() != "auto") { // else points without a side have two
    if (!sides->is_boolean()) table.fail("two_sided", "expected true, false or \"auto\", found " + found_text(*sides));
    if (*sides->value<bool>())
      material.flags |= MATERIAL_TWO_SIDED;
    else
      material.one_sided = true;
  }
  if (const auto space = table.choice("colour_space", {"srgb", "linear"}))
    material.colour_space = *space == "srgb" ? ColourSpace::srgb : ColourSpace::linear;
}

} // namespace pointgi
