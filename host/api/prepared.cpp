#include "host/api/parts.h"
#include "host/run.h"

namespace pointgi::api {

Prepared::Prepared(const Context& context, const Scene& scene, const RunControl& run) : parts_(new Parts) {
  const RunScope scope(run);
  Context::Parts& device = *context.parts();
  parts_->context = context.parts();
  parts_->quality = scene.parts()->quality;
  parts_->scene = scene.parts()->description();
  parts_->ready = prepare_scene(device.session, parts_->scene, scene.parts()->document.bare, device.stages);
}

std::size_t Prepared::size() const {
  return parts_->points().size;
}

std::vector<double> Prepared::positions() const {
  std::vector<double> positions;
  positions.reserve(3 * size());
  for (const Splat& s : parts_->points()) {
    const Vector3d p = parts_->ready.frame.to_world({s.position[0], s.position[1], s.position[2]});
    positions.insert(positions.end(), p.data(), p.data() + 3);
  }
  return positions;
}

std::vector<unsigned> Prepared::ids() const {
  return {parts_->ready.ids.begin(), parts_->ready.ids.end()};
}

Camera Prepared::camera() const {
  const CameraSettings& settings = parts_->scene.camera;
  const auto array = [](const Vector3d& v) { return std::array<double, 3>{v.x(), v.y(), v.z()}; };
  Camera camera{array(settings.position), array(settings.look_at), settings.fov_deg, {}};
  if (settings.up) camera.up = array(*settings.up);
  return camera;
}

} // namespace pointgi::api
