#pragma once
/// The presets of --quality: factors of a scene's own settings, kept as data (presets/presets.toml), and what was
/// measured of them (presets/measured.toml, by scripts/presets).
#include "host/embedded_file.h"
#include "host/scene/scene.h"
#include <string>
#include <vector>

namespace pointgi {

struct Preset {
  std::string name;
  double samples = 1.0;         ///< factor of render.spp
  double epsilon = 1.0;         ///< factor of radiosity.epsilon, which gets no coarser than a draft's coarsest
  double directions = 1.0;      ///< factor of radiosity.directions
  int point_light_samples = 64; ///< radiosity.light_samples of a lit cloud, where the scene does not say
  double error = 0.0;           ///< relMSE that pictures keep below, but for promised_error()
};

/// A picture by a preset against its path-traced reference.
struct PresetMeasurement {
  std::string preset, scene;
  std::string kind;                          ///< "room", "statue", "terrain", "foliage", "glass and mirror", "interior"
  bool chosen_by;                            ///< the presets were chosen by it; else it tests them
  double error = 0.0, low = 0.0, high = 0.0; ///< relMSE and its 95 % interval
  double noise = 0.0;                        ///< relMSE of one sample a pixel, by the pixels' variances
  int samples = 0;                           ///< a pixel
  double seconds = 0.0;                      ///< of the picture, on the device of the measurement
};

/// From the least accurate to the most.
const std::vector<Preset>& presets();
const std::vector<PresetMeasurement>& preset_measurements();

/// relMSE that no setting goes below in some scenes of this kind; 0: there are none.
double least_error(const std::string& kind);

/// relMSE that pictures of a scene of this kind keep below: the preset's, and no less than the least error.
double promised_error(const Preset& preset, const std::string& kind);

std::vector<std::string> preset_names();

/// Throws Error(usage) that lists the names, with `what` in front of them.
const Preset& preset_named(const std::string& name, const std::string& what);

/// `samples_given`: render.spp is left as it is.
void apply_preset(const Preset& preset, Scene& scene, bool samples_given = false);

/// Of a lit cloud, which shows the direct light of its points: radiosity.light_samples too, where the scene leaves them
/// open.
void apply_bake_preset(const Preset& preset, Scene& scene);

/// apply_preset as --set takes it: a key and value for all that changes and that the scene's method reads.
std::vector<std::string> preset_overrides(const Preset& preset, const Scene& scene);

/// The files of host/scene/presets/. Written at build time.
const std::vector<EmbeddedFile>& preset_files();

} // namespace pointgi
