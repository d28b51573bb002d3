#include "host/cloud/input_file.h"
#include "host/scene/load_sections.h"
#include <algorithm>
#include <cctype>
#include <filesystem>

namespace pointgi {
namespace {

namespace fs = std::filesystem;

bool is_scene(const fs::path& path, const std::string& scene_file) {
  std::error_code missing; // equivalent() fails where a file is missing: then it is not the scene
  return has_extension(path.string(), ".toml") || fs::equivalent(path, scene_file, missing);
}

/// Joined with the scene's folder, and known to be a regular file. It is not opened: a FIFO would block.
std::string load_file(const TableReader& table, const std::string& scene_file) {
  const std::string name = table.need_text("file", "the name of a point cloud (PLY) or mesh");
  const fs::path path = fs::path(scene_file).parent_path() / name;
  if (is_scene(path, scene_file))
    table.fail("file", "expected a point cloud or mesh, found the scene file " + quoted(name) +
                           "; a scene cannot include itself or another scene");
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found)
    table.fail("file", "no such file: " + quoted(name) + "; it is looked for relative to the scene file's folder");
  if (status.type() == fs::file_type::none)
    table.fail("file", quoted(name) + " cannot be read: " + error.message() + "; check its permissions, and the disk");
  if (status.type() == fs::file_type::directory)
    table.fail("file", "expected a point cloud or mesh, found the folder " + quoted(name));
  if (status.type() != fs::file_type::regular)
    table.fail("file", "expected a regular file, but " + quoted(name) +
                           " is a pipe, socket or device; save the cloud to a file first");
  return path.string();
}

NormalSource normals_called(const std::string& name) {
  if (name == "file") return NormalSource::file;
  if (name == "estimate") return NormalSource::estimate;
  if (name == "flip") return NormalSource::flip;
  return NormalSource::automatic;
}

StrayPolicy strays_called(const std::string& name) {
  if (name == "keep") return StrayPolicy::keep;
  if (name == "shrink") return StrayPolicy::shrink;
  return StrayPolicy::drop;
}

RadiusSource radii_called(const std::string& name) {
  if (name == "file") return RadiusSource::file;
  if (name == "estimate") return RadiusSource::estimate;
  return RadiusSource::automatic;
}

/// A word or a number: the one key of two types.
void load_radius(const TableReader& table, CloudSettings& cloud) {
  const toml::node* node = table.find("radius");
  if (node == nullptr) return;
  if (node->is_number())
    cloud.radius = table.number("radius", limits::length);
  else if (node->is_string())
    cloud.radii = radii_called(*table.choice("radius", {"auto", "file", "estimate"}));
  else
    table.fail("radius", std::string("expected \"auto\", \"file\", \"estimate\" or a number ") + limits::length.words +
                             ", found " + found_text(*node));
}

CloudSettings load_cloud(const TableReader& table, const MaterialNames& materials, const std::string& scene_file,
                         const CloudsInMemory& in_memory) {
  table.allow_only({"file", "material", "scale", "rotate_deg", "translate", "radius", "normals", "viewpoint", "spacing",
                    "strays", "keep", "crop", "clip", "voxel"});
  CloudSettings cloud;
  cloud.place = table.place();
  const auto given = in_memory.find(table.text("file").value_or(""));
  if (given != in_memory.end()) cloud.points = given->second;
  cloud.file = cloud.points ? given->first : load_file(table, scene_file);
  cloud.material = materials.read(table);
  if (const auto scale = table.number("scale", limits::scale)) cloud.scale = *scale;
  if (const auto rotate = table.vector3("rotate_deg", limits::angle)) cloud.rotate_deg = *rotate;
  if (const auto translate = table.vector3("translate", limits::coordinate)) cloud.translate = *translate;
  load_radius(table, cloud);
  if (const auto normals = table.choice("normals", {"auto", "file", "estimate", "flip"}))
    cloud.normals = normals_called(*normals);
  if (const auto strays = table.choice("strays", {"drop", "shrink", "keep"})) cloud.strays = strays_called(*strays);
  cloud.viewpoint = table.vector3("viewpoint", limits::coordinate);
  if (const auto spacing = table.number("spacing", limits::length)) cloud.spacing = *spacing;
  cloud.selection = load_selection(table);
  return cloud;
}

} // namespace

std::vector<CloudSettings> load_clouds(const TableReader& root, const MaterialNames& materials,
                                       const std::string& scene_file, const CloudsInMemory& in_memory) {
  std::vector<CloudSettings> clouds;
  for (const TableReader& table : root.tables("cloud"))
    clouds.push_back(load_cloud(table, materials, scene_file, in_memory));
  return clouds;
}

} // namespace pointgi
