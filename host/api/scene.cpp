#include "host/api/parts.h"
#include "host/error.h"
#include "host/scene/overrides.h"
#include "host/scene/presets.h"
#include <cmath>

namespace pointgi::api {

namespace {

/// What a scene built in code is called where a file would have its name.
constexpr const char* in_code = "scene";

SceneDocument empty_document() {
  return {toml::table{{"version", 1}}, in_code, in_code, {}};
}

/// Whole numbers as TOML's integers, which every key takes that wants a number.
void append(toml::array& array, double value) {
  constexpr double most = 9.0e15; // all integers below are doubles
  if (std::abs(value) < most && value == std::floor(value))
    array.push_back(static_cast<std::int64_t>(value));
  else
    array.push_back(value);
}

void put(toml::table& table, const std::string& key, const Value& value) {
  if (const auto* values = std::get_if<std::vector<double>>(&value.any())) {
    toml::array array;
    for (const double one : *values)
      append(array, one);
    table.insert_or_assign(key, std::move(array));
    return;
  }
  std::visit(
      [&](const auto& one) {
        if constexpr (!std::is_same_v<std::decay_t<decltype(one)>, std::vector<double>>)
          table.insert_or_assign(key, one);
      },
      value.any());
}

toml::table table_of(const Keys& keys) {
  toml::table table;
  for (const auto& [key, value] : keys)
    put(table, key, value);
  return table;
}

void push(toml::table& document, const std::string& kind, toml::table&& entry) {
  if (document.get(kind) == nullptr) document.insert(kind, toml::array());
  toml::array* list = document.get(kind)->as_array();
  if (list == nullptr) throw Error(ErrorKind::usage, kind + ": stands once in a scene; use set");
  list->push_back(std::move(entry));
}

std::vector<Eigen::Vector3f> vectors(const float* values, std::size_t count) {
  std::vector<Eigen::Vector3f> result;
  if (values == nullptr) return result;
  result.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    result.emplace_back(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
  return result;
}

PointCloud cloud_of(const Points& points) {
  PointCloud cloud;
  cloud.position.reserve(points.count);
  for (std::size_t i = 0; i < points.count; ++i)
    cloud.position.emplace_back(points.positions[3 * i], points.positions[3 * i + 1], points.positions[3 * i + 2]);
  cloud.normal = vectors(points.normals, points.count);
  cloud.colour = vectors(points.colours, points.count);
  if (points.radii != nullptr) cloud.radius.assign(points.radii, points.radii + points.count);
  return cloud;
}

} // namespace

pointgi::Scene Scene::Parts::description() const {
  pointgi::Scene scene = scene_of(document);
  if (quality_of_points) {
    apply_bake_preset(preset_named(quality, "quality"), scene);
    scene.ground = scene.ground && !document.bare; // a lit cloud is the cloud
  } else
    apply_preset(preset_named(quality, "quality"), scene, !quality_of_samples);
  return scene;
}

Scene::Scene() : parts_(new Parts{empty_document()}) {}

Scene Scene::from_file(const std::string& file, const std::vector<std::string>& overrides) {
  Scene scene;
  scene.parts_->document = is_scene_file(file) ? document_of_file(file) : document_of_cloud(file);
  apply_overrides(scene.parts_->document.table, overrides);
  scene.check();
  return scene;
}

Scene Scene::from_text(const std::string& toml, const std::string& folder) {
  Scene scene;
  scene.parts_->document = document_of_text(toml, in_code, folder);
  scene.check();
  return scene;
}

Scene::Parts& Scene::own() {
  if (parts_.use_count() > 1) parts_ = std::make_shared<Parts>(*parts_);
  return *parts_;
}

void Scene::add(const std::string& kind, const Keys& keys) {
  push(own().document.table, kind, table_of(keys));
}

void Scene::add(const Points& points, const Keys& keys) {
  if (points.count == 0 || points.positions == nullptr)
    throw Error(ErrorKind::usage, "a cloud in memory without points; expected a count above 0 and positions");
  SceneDocument& document = own().document;
  const std::string name = "points " + std::to_string(document.in_memory.size()); // no file's: it has no extension
  document.in_memory[name] = std::make_shared<const PointCloud>(cloud_of(points));
  toml::table entry = table_of(keys);
  entry.insert_or_assign("file", name);
  push(document.table, "cloud", std::move(entry));
}

void Scene::set(const std::string& section, const Keys& keys) {
  toml::table& table = own().document.table;
  if (table.get(section) == nullptr) table.insert(section, toml::table());
  toml::table* found = table.get(section)->as_table();
  if (found == nullptr) throw Error(ErrorKind::usage, section + ": is no section that stands once; use add");
  for (const auto& [key, value] : keys)
    put(*found, key, value);
}

void Scene::set(const std::string& assignment) {
  apply_overrides(own().document.table, {assignment});
}

void Scene::set_quality(const std::string& quality, bool samples) {
  preset_named(quality, "quality");
  own().quality = quality;
  own().quality_of_samples = samples;
  own().quality_of_points = false;
}

void Scene::set_bake_quality(const std::string& quality) {
  set_quality(quality);
  own().quality_of_points = true;
}

void Scene::check() const {
  parts_->description();
}

} // namespace pointgi::api
