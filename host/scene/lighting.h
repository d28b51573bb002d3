#pragma once
/// Camera and lights of a scene as the render kernels take them.
#include "host/scene/splats.h"
#include "octree/view.h"
#include "shared/render_types.h"

namespace pointgi {

/// Radiometric values on the device are world values / scale. A power of two, so that dividing and multiplying back is
/// exact; chosen from the scene's brightest source, so that 1e-20 W and 1e20 W stay inside float.
struct RadianceScale {
  double scale = 1.0;
};

struct DeviceLighting {
  RadianceScale radiance;
  RenderParams params{};                  ///< everything but step_delta
  std::vector<Material> materials;        ///< one a material of the scene
  std::vector<LightSource> light_sources; ///< [[light]]s that shine
  std::vector<Emitter> emitters;          ///< splats of emitting materials
  bool has_environment = false;
  std::shared_ptr<const EnvironmentMap> sky; ///< the environment's map, not yet scaled; null: params.environment alone

  std::vector<std::array<float, 4>> smooth_sky; ///< its coarse twin, scaled (host/lights/smooth_sky.h); empty: it has
                                                ///< bright spots, or there is no map

  bool has_light() const { return !light_sources.empty() || !emitters.empty() || has_environment; }
  /// Whether some splat's material, not only some material, has this flag (MATERIAL_...).
  bool has_flag(pg_uint flag) const { return (flags & flag) != 0; }
  bool has_specular() const { return has_flag(MATERIAL_SPECULAR); }
  pg_uint material_types = 0; ///< bit MATERIAL_<ID>: splats of that kind are there
  pg_uint light_types = 0;    ///< bit LIGHT_<ID>: lights of that kind are
  pg_uint flags = 0;          ///< of the materials of all splats
};

/// `points` is the octree's point pool: emitters refer to it. `clips`: of those points.
DeviceLighting device_lighting(const Scene& scene, const Frame& frame, View<Splat> points,
                               const SplatClips& clips = {});

/// The camera for an image of this size in the frame's cube.
Camera device_camera(const Scene& scene, const Frame& frame);

/// Row-major matrices for row vectors [x y z 1], as OpenEXR's worldToCamera (camera looks down -z) and worldToNDC
/// (0..1 from the lower left corner) have them.
std::array<float, 16> world_to_camera(const Scene& scene);
std::array<float, 16> world_to_ndc(const Scene& scene);

/// The upward direction of the scene.
Vector3d up_of(const Scene& scene);

} // namespace pointgi
