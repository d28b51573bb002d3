#pragma once
/// Which picture it is: what names it in files, and tells whether an earlier run has worked for the same one.
#include "host/api/film.h"
#include "host/stages/prepared_scene.h"
#include <string>

namespace pointgi::api {

/// 16 hexadecimal digits: what the picture depends on, splats, lights, camera and samples, as the device reads them,
/// and how light is computed.
std::string scene_hash(const Pool<OctreePoint>& points, const DeviceLighting& lighting, const pointgi::Scene& scene,
                       const std::string& integrator, const std::string& paths);

/// Everything that the bits of the light of a prepared scene depend on, and those of a film of it, as text: the scene
/// that it was prepared from, the view, the device, the kernels and this program. `film`: null: light alone.
std::string checkpoint_key(const Scene& scene, const Prepared& prepared, const std::string& integrator,
                           const FilmOptions* film);

} // namespace pointgi::api
