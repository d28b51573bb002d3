#include "host/scene/load_scene.h"
#include "host/cloud/input_file.h"
#include "host/scene/limits.h"
#include "host/scene/load_sections.h"
#include "host/scene/overrides.h"
#include "host/scene/scene_document.h"
#include "host/scene/scene_text.h"
#include <algorithm>
#include <filesystem>

namespace pointgi {
namespace {

/// The parser's own words, less the "Error" that they begin with.
std::string complaint(const toml::parse_error& error) {
  const std::string text(error.description());
  const std::string prefix = "Error ";
  return text.compare(0, prefix.size(), prefix) == 0 ? text.substr(prefix.size()) : text;
}

toml::table parse(const std::string& text, const std::string& name) {
  check_nesting(text, name);
  try {
    // Without a source path: nodes that carry one came from --set (toml_words.h).
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    throw Error(ErrorKind::input,
                harmless(place_of(error.source(), name).text() + ": not valid TOML: " + complaint(error)));
  }
}

/// Before anything else: another version may have other keys.
void check_version(const TableReader& root) {
  const toml::node* node = root.find("version");
  if (node == nullptr) root.fail("version", "missing, expected a scene file that begins with: version = 1");
  const auto* version = node->as_integer();
  if (version == nullptr || version->get() < limits::version.low || version->get() > limits::version.high)
    root.fail("version", "expected 1, found " + found_text(*node) + "; this program reads scene files of version 1");
}

bool shines(const Scene& scene) {
  const auto lit = [](const LightSettings& light) { return light.strength.maxCoeff() > 0; };
  std::unordered_set<std::string> emitting;
  for (const MaterialSettings& material : scene.materials)
    if (material.emission.maxCoeff() > 0) emitting.insert(material.name);
  const auto emits = [&](const auto& object) { return emitting.count(object.material) != 0; };
  return scene.sky != nullptr || scene.environment.maxCoeff() > 0 ||
         std::any_of(scene.lights.begin(), scene.lights.end(), lit) ||
         std::any_of(scene.clouds.begin(), scene.clouds.end(), emits) ||
         std::any_of(scene.shapes.begin(), scene.shapes.end(), emits);
}

/// Of which its own warning has told.
bool has_dark_sun(const Scene& scene) {
  return std::any_of(scene.lights.begin(), scene.lights.end(), [](const LightSettings& light) {
    return light.type == LightType::sun && light.strength.isZero();
  });
}

void load_up(const TableReader& root, Scene& scene) {
  std::vector<std::string> words;
  for (const UpAxis up : up_axes())
    words.push_back(name_of(up));
  const auto word = root.choice("up", words);
  if (!word) return;
  scene.up = up_axes()[static_cast<std::size_t>(std::find(words.begin(), words.end(), *word) - words.begin())];
  scene.up_chosen = true;
}

} // namespace

Scene scene_of(const SceneDocument& document) {
  const std::string& path = document.name;
  const TableReader root(document.table, path, "");
  check_version(root);
  root.allow_only({"version", "up", "ground", "render", "camera", "material", "cloud", "shape", "light", "environment",
                   "radiosity", "caustics", "octree", "traversal"});

  Scene scene;
  scene.file = path;
  scene.render.auto_exposure = scene.ground = document.bare; // unless the overrides say otherwise
  load_up(root, scene);
  if (const auto ground = root.choice("ground", {"auto", "none"})) scene.ground = *ground == "auto";
  load_render(root, scene.render);
  load_camera(root, scene.up, scene.camera);
  scene.materials = load_materials(root, scene.warnings);
  const MaterialNames names(scene.materials);
  scene.clouds = load_clouds(root, names, document.scene_file, document.in_memory);
  scene.shapes = load_shapes(root, names);
  scene.lights = load_lights(root, scene.up, scene.warnings);
  load_environment(root, document.scene_file, scene);
  if (document.bare) {
    scene.radiosity.epsilon = limits::bare_epsilon;
    scene.radiosity.directions = limits::bare_directions;
  }
  load_radiosity(root, scene.radiosity);
  load_caustics(root, scene.caustics);
  load_octree(root, scene.octree);
  load_traversal(root, scene.traversal);

  if (scene.clouds.empty() && scene.shapes.empty())
    throw Error(ErrorKind::input,
                path +
                    ": the scene is empty, expected at least one [[cloud]] or [[shape]]; there is nothing to render");
  if (!shines(scene) && !has_dark_sun(scene))
    scene.warnings.push_back(path + ": nothing gives light, the picture will be black; add a [[light]], an "
                                    "[environment] or a material with emission.");
  if (document.bare) {
    if (scene.clouds.size() == 1) scene.clouds.front().file = path; // named as the user named it
    scene.warnings.clear();                                         // of the one that there is no light
  }
  return scene;
}

SceneDocument document_of_file(const std::string& path) {
  return {parse(read_scene_text(path), path), path, path, {}};
}

SceneDocument document_of_text(const std::string& text, const std::string& name, const std::string& folder) {
  return {parse(text, name), name, (std::filesystem::path(folder) / name).string(), {}};
}

SceneDocument document_of_cloud(const std::string& path) {
  require_regular_file(path);
  const char* name = "points";
  toml::table table{
      {"version", 1},
      {"material", toml::array{toml::table{{"name", name}, {"type", "diffuse"}}}},
      {"cloud", toml::array{toml::table{{"file", std::filesystem::absolute(path).string()}, {"material", name}}}}};
  return {std::move(table), path, "", {}, true};
}

Scene load_scene(const std::string& path, const std::vector<std::string>& overrides) {
  SceneDocument document = document_of_file(path);
  apply_overrides(document.table, overrides);
  return scene_of(document);
}

Scene load_bare_cloud(const std::string& path, const std::vector<std::string>& overrides) {
  SceneDocument document = document_of_cloud(path);
  apply_overrides(document.table, overrides);
  return scene_of(document);
}

} // namespace pointgi
