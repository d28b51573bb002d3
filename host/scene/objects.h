#pragma once
/// The clouds and shapes of a scene, as messages name them.
#include "host/scene/scene.h"
#include <string>

namespace pointgi {

/// An object of a scene by its number: the clouds, then the shapes, each in the scene's order.
struct SceneObject {
  std::string name;        ///< "cloud.0 (statue.ply)", "shape.2 (quad, room.toml:31:1)": as --set and the file have it
  std::string how_to_turn; ///< what to change so that it faces the other way: "swap edge_u and edge_v"
  std::string material;    ///< name of its material
  bool is_cloud = false;
};

/// `object`: below the number of clouds and shapes.
SceneObject object_of(const Scene& scene, std::size_t object);

} // namespace pointgi
