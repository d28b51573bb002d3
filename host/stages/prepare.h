#pragma once
/// What the commands share on the way from a file to the splats that the device takes.
#include "host/scene/load_scene.h"
#include "host/scene/merge_coincident.h"
#include "host/scene/splats.h"

namespace pointgi {

/// Whether the name is a scene file's (.toml) and not a cloud's.
bool is_scene_file(const std::string& file);

/// A scene file, or a bare cloud with a scene around it.
Scene load_any(const std::string& file, const std::vector<std::string>& overrides);

/// From the points of a cloud's file, or of arrays in memory, to ids.
struct FileOrder {
  std::vector<std::uint32_t> record; ///< by id: the point's number in the file; empty: its id
  std::uint32_t points = 0;          ///< ids of the cloud: those below
  std::vector<MergedSplat> merged;   ///< ids that no splat has, and which stand for them
};

/// The scene's splats as the device takes them.
struct PlacedSplats {
  Frame frame;
  std::vector<Splat> splats;
  SplatClips clips;              ///< of the splats that end at borders
  PatchBends bends;              ///< of the splats; empty where they are discs
  std::vector<std::uint32_t> id; ///< of each splat: its place among the kept points of all clouds and shapes, in order
  std::vector<std::uint32_t> first_ids; ///< id of the first point of each cloud, then of each shape
  std::vector<CloudKind> kinds;         ///< of the clouds
  std::optional<FileOrder> file_order;  ///< of a scene of one cloud and nothing else, whose points are those of a file
};

/// Loads, chooses a view where the scene has none (and, around a bare cloud, lights), places, merges what coincides;
/// logs what was found.
PlacedSplats load_and_place(Scene& scene, bool bare);

} // namespace pointgi
