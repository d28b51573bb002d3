#include "host/scene/load_scene.h"
#include "host/cloud/input_file.h"
#include "host/scene/load_sections.h"
#include "host/scene/overrides.h"
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

toml::table parse_file(const std::string& path) {
  const std::string text = read_scene_text(path);
  check_nesting(text, path);
  try {
    // Without a source path: nodes that carry one came from --set (toml_words.h).
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    throw Error(ErrorKind::input, place_of(error.source(), path).text() + ": not valid TOML: " + complaint(error));
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
  return scene.environment.maxCoeff() > 0 || std::any_of(scene.lights.begin(), scene.lights.end(), lit) ||
         std::any_of(scene.clouds.begin(), scene.clouds.end(), emits) ||
         std::any_of(scene.shapes.begin(), scene.shapes.end(), emits);
}

/// The scene that a document describes; errors name `path`. `scene_file` is the file that it was read from, which its
/// clouds are relative to and cannot be themselves; empty for a document that was made here.
Scene scene_of_document(const toml::table& document, const std::string& path, const std::string& scene_file) {
  const TableReader root(document, path, "");
  check_version(root);
  root.allow_only({"version", "up", "render", "camera", "material", "cloud", "shape", "light", "environment",
                   "radiosity", "caustics", "octree", "traversal"});

  Scene scene;
  scene.file = path;
  if (const auto up = root.choice("up", {"y", "z"})) {
    scene.up = *up == "y" ? UpAxis::y : UpAxis::z;
    scene.up_chosen = true;
  }
  load_render(root, scene.render);
  load_camera(root, scene.up, scene.camera);
  scene.materials = load_materials(root, scene.warnings);
  const MaterialNames names(scene.materials);
  scene.clouds = load_clouds(root, names, scene_file);
  scene.shapes = load_shapes(root, names);
  scene.lights = load_lights(root);
  load_environment(root, scene.environment);
  load_radiosity(root, scene.radiosity);
  load_caustics(root, scene.caustics);
  load_octree(root, scene.octree);
  load_traversal(root, scene.traversal);

  if (scene.clouds.empty() && scene.shapes.empty())
    throw Error(ErrorKind::input,
                path +
                    ": the scene is empty, expected at least one [[cloud]] or [[shape]]; there is nothing to render");
  if (!shines(scene))
    scene.warnings.push_back(path + ": nothing gives light, the picture will be black; add a [[light]], an "
                                    "[environment] or a material with emission.");
  return scene;
}

} // namespace

Scene load_scene(const std::string& path, const std::vector<std::string>& overrides) {
  toml::table document = parse_file(path);
  apply_overrides(document, overrides);
  return scene_of_document(document, path, path);
}

Scene load_bare_cloud(const std::string& path, const std::vector<std::string>& overrides) {
  require_regular_file(path);
  const char* name = "points";
  toml::table document{
      {"version", 1},
      {"material", toml::array{toml::table{{"name", name}, {"type", "diffuse"}}}},
      {"cloud", toml::array{toml::table{{"file", std::filesystem::absolute(path).string()}, {"material", name}}}}};
  apply_overrides(document, overrides);
  Scene scene = scene_of_document(document, path, "");
  if (scene.clouds.size() == 1) // named as the user named it
    scene.clouds.front().file = path;
  scene.warnings.clear(); // of the one that there is no light: the caller chooses it
  return scene;
}

} // namespace pointgi
