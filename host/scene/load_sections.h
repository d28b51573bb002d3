#pragma once
/// The parts of a scene file, a function each; load_scene() calls them in turn.
#include "host/scene/scene_document.h"
#include "host/scene/toml_reader.h"
#include <string>
#include <unordered_set>
#include <vector>

namespace pointgi {

void load_render(const TableReader& root, RenderSettings& render);

/// Refuses cameras that see nothing or have no upright: position at look_at, or the view along the scene's up.
void load_camera(const TableReader& root, UpAxis up, CameraSettings& camera);

void load_radiosity(const TableReader& root, RadiositySettings& radiosity);
void load_caustics(const TableReader& root, CausticSettings& caustics);
void load_octree(const TableReader& root, OctreeSettings& octree);
void load_traversal(const TableReader& root, TraversalSettings& traversal);

/// Light from all around: of the section, or of a light that brings a sky; of more than one of these, refused. Goes
/// after load_lights(). `scene_file`: a map is relative to its folder.
void load_environment(const TableReader& root, const std::string& scene_file, Scene& scene);

/// Appends to `warnings` where a key will have no effect.
std::vector<MaterialSettings> load_materials(const TableReader& root, std::vector<std::string>& warnings);

/// The names that clouds and shapes may use.
class MaterialNames {
public:
  explicit MaterialNames(const std::vector<MaterialSettings>& materials);

  /// The table's `material`, refused with the nearest known name when there is none of that name.
  std::string read(const TableReader& table) const;

private:
  std::vector<std::string> names_;
  std::unordered_set<std::string> known_;
};

/// `scene_file`: files are relative to its folder, and it cannot be a cloud itself. `in_memory`: clouds that are found
/// there by their `file` and not among the files.
std::vector<CloudSettings> load_clouds(const TableReader& root, const MaterialNames& materials,
                                       const std::string& scene_file, const CloudsInMemory& in_memory);

/// `keep`, `crop`, `clip` and `voxel` of a [[cloud]]. Refuses boxes without an inside and normals of length 0.
Selection load_selection(const TableReader& cloud);

std::vector<ShapeSettings> load_shapes(const TableReader& root, const MaterialNames& materials);
/// Appends to `warnings` where a light gives none.
std::vector<LightSettings> load_lights(const TableReader& root, UpAxis up, std::vector<std::string>& warnings);

} // namespace pointgi
