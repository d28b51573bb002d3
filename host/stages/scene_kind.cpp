#include "host/stages/scene_kind.h"
#include <algorithm>

namespace pointgi {

namespace {

bool is_specular_alone(const MaterialSettings& m) {
  return (m.flags & MATERIAL_SPECULAR) != 0 && (m.flags & MATERIAL_REFLECTS_DIFFUSELY) == 0;
}

bool camera_is_among(const Scene& scene, const PreparedScene& ready) {
  Eigen::Vector3f low = Eigen::Vector3f::Constant(1.0f), high = Eigen::Vector3f::Zero();
  for (const OctreePoint& point : ready.points) {
    const Eigen::Vector3f at(point.position[0], point.position[1], point.position[2]);
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
  }
  const Eigen::Vector3f camera = ready.frame.to_cube(scene.camera.position);
  return (camera.array() > low.array()).all() && (camera.array() < high.array()).all();
}

} // namespace

std::string kind_of_scene(const Scene& scene, const PreparedScene& ready) {
  if (std::any_of(scene.materials.begin(), scene.materials.end(), is_specular_alone)) return "glass and mirror";
  const auto has = [&](CloudKind kind) {
    return std::find(ready.kinds.begin(), ready.kinds.end(), kind) != ready.kinds.end();
  };
  if (has(CloudKind::foliage)) return "foliage";
  if (has(CloudKind::terrain)) return "terrain";
  if (has(CloudKind::room) || has(CloudKind::station) || has(CloudKind::map) || has(CloudKind::depth_frame))
    return "interior";
  return camera_is_among(scene, ready) ? "room" : "statue";
}

} // namespace pointgi
