/// [environment]: light from all around.
#include "host/cloud/input_file.h"
#include "host/lights/environment_map.h"
#include "host/scene/load_sections.h"
#include <filesystem>

namespace pointgi {
namespace {

std::string map_file(const TableReader& table, const std::string& scene_file) {
  const std::string name = table.need_text("map", "the name of a .hdr or .exr file");
  return std::filesystem::absolute(std::filesystem::path(scene_file).parent_path() / name).lexically_normal().string();
}

EnvironmentMap load_map(const TableReader& table, const std::string& path, UpAxis up) {
  const double turn = table.number("rotate_deg", limits::angle).value_or(0.0);
  const double scale = table.number("scale", limits::light).value_or(1.0);
  try {
    require_regular_file(path);
    return load_environment_map(path, sky_frame(up, turn), scale);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input) throw;
    table.fail("map", error.what());
  }
}

/// A map that is constant becomes its radiance.
void surround(std::shared_ptr<const EnvironmentMap> map, Scene& scene) {
  scene.warnings.insert(scene.warnings.end(), map->warnings.begin(), map->warnings.end());
  // Directions are those of the axis that was named, or of the default: a chosen camera takes the same.
  scene.up_chosen = true;
  if (map->constant)
    scene.environment = *map->constant;
  else
    scene.sky = std::move(map);
}

void load_section(const TableReader& table, const std::string& scene_file, Scene& scene) {
  table.allow_only({"radiance", "map", "rotate_deg", "scale"});
  if (!table.has("map")) {
    for (const char* key : {"rotate_deg", "scale"})
      if (table.has(key)) table.fail(key, "goes with a map, and there is none; give map or remove it");
    scene.environment = table.need_vector3("radiance", limits::light);
    return;
  }
  if (table.has("radiance"))
    table.fail("radiance", "the environment has a map, which gives its radiance; remove one of the two");
  scene.environment_file = map_file(table, scene_file);
  surround(std::make_shared<const EnvironmentMap>(load_map(table, scene.environment_file, scene.up)), scene);
}

} // namespace

void load_environment(const TableReader& root, const std::string& scene_file, Scene& scene) {
  const std::optional<TableReader> table = root.table("environment");
  if (table) load_section(*table, scene_file, scene);
  bool surrounded = table.has_value();
  for (const LightSettings& light : scene.lights) {
    if (light.sky == nullptr) continue;
    if (surrounded)
      throw Error(ErrorKind::input, light.place.text() + ": light: the " + name_of(light.type) +
                                        " brings its own sky, and there is " +
                                        (table ? "an [environment]; remove one of the two, or use a directional light"
                                               : "another sun before it; keep one"));
    surround(light.sky, scene);
    surrounded = true;
  }
}

} // namespace pointgi
