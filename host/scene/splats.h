#pragma once
/// From a scene's description to its splats: clouds loaded, completed and placed, shapes sampled, one list in world
/// units.
#include "host/scene/frame.h"
#include "host/scene/scene.h"
#include "octree/splat.h"
#include "octree/view.h"

namespace pointgi {

/// All splats of a scene. `cloud` has every attribute but triangles; `colour` is the diffuse reflectance, linear RGB.
struct WorldSplats {
  PointCloud cloud;
  std::vector<std::uint32_t> material; ///< index into Scene::materials, one a point
  std::vector<CloudReport> reports;    ///< one a [[cloud]], in the scene's order
  std::vector<std::uint32_t> record;   ///< of the first cloud's points: their numbers in its file; empty: their own
  std::vector<ClippedPoint> clipped;   ///< points that end at borders, ascending
  std::vector<std::uint32_t> first;    ///< point of each object: of the clouds, then the shapes, in the scene's order
};

/// Reads a cloud or mesh (anything else that assimp knows; sampled) and completes it, with what the scene's camera,
/// lamps and up say of its sides; the file's own coordinates. `fields`: names of those of the file that are wanted.
PointCloud load_cloud(const CloudSettings& settings, const Scene& scene, CloudReport& report,
                      const std::vector<std::string>& fields = {});

/// Loads, samples and places everything. Throws Error(input), or Error(memory).
WorldSplats load_splats(const Scene& scene);

/// One more object: a complete cloud in world units, of the scene's material of that `number`.
void append_cloud(WorldSplats& splats, PointCloud&& cloud, const MaterialSettings& material, std::uint32_t number);

/// How a cloud is turned.
Eigen::Matrix3d rotation_of(const CloudSettings& settings);

/// The clips of splats that were placed in the frame's cube; id[k]: the point that splat k came from.
SplatClips clips_in_cube(const WorldSplats& splats, const Frame& frame, View<Splat> placed, View<std::uint32_t> id);

/// The device's points in the frame's cube.
std::vector<Splat> place_in_cube(const WorldSplats& splats, const Frame& frame);

} // namespace pointgi
