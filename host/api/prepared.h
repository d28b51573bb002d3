#pragma once
/// A scene on the device, and the light in it.
#include "host/api/context.h"
#include "host/api/scene.h"
#include "host/run_control.h"
#include <array>
#include <optional>

namespace pointgi::api {

/// Where a picture is taken from.
struct Camera {
  std::array<double, 3> position{};
  std::array<double, 3> look_at{};
  double fov_deg = 40.0;                        ///< vertical, above 0 and below 180
  std::optional<std::array<double, 3>> up = {}; ///< absent: the scene's axis
};

/// Clouds loaded and completed, shapes sampled, all of them in an octree on the device.
class Prepared {
public:
  /// Loads and uploads; the scene may go or change afterwards. What the log hears: where normals and radii come from,
  /// what was merged, warnings. Throws Error: input, device, memory, interrupted.
  Prepared(const Context& context, const Scene& scene, const RunControl& run = {});

  /// Number of the points of the octree: those of all clouds and shapes, less those that were dropped or merged;
  /// both sides of what is two-sided, the front before the back.
  std::size_t size() const;
  /// [size x 3], world units, within 1e-7 of the scene's size; in the octree's order.
  std::vector<double> positions() const;
  /// [size]: the place of each among the kept points of all clouds, then shapes, in the scene's order. A mesh's vertex
  /// at a sharp edge is a point for each face: what was added follows its cloud's vertices.
  std::vector<unsigned> ids() const;

  /// The scene's, or the one that was chosen because the scene has none.
  Camera camera() const;

  struct Parts; ///< for the library itself
  const std::shared_ptr<Parts>& parts() const { return parts_; }

private:
  std::shared_ptr<Parts> parts_;
};

/// What a lit cloud's file shows besides the points.
struct LitFileOptions {
  std::optional<double> exposure = 0.0; ///< brightens the colours, in stops; absent: chosen from the points
  bool sky = false; ///< scalar_sky: as of Light::sky(); a scene without any light then has nothing else
};

struct LightOptions {
  /// Whether photons bring the light that mirrors and glass pass on. They change pictures, and radiosities where the
  /// scene says caustics.feedback or caustics.indirect.
  bool photons = true;
  /// Nothing is solved: films are path traced, slowly and without bias.
  bool path_tracing = false;
  /// "LIT.ply": where radiosity.method has passes ("gather"), the lit cloud as it is after each is written to
  /// LIT.pass-001.ply and so on, with what `pass_content` says. Empty: none is. Without photons only.
  std::string pass_file = {};
  LitFileOptions pass_content = {};
};

/// The solved light of a prepared scene. It does not depend on a camera: any number of films may be made by it.
class Light {
public:
  /// Throws Error: input where settings of the scene do not go together, device, memory, interrupted.
  explicit Light(const Prepared& prepared, const LightOptions& options = {}, const RunControl& run = {});

  /// [size x 3, W/m²], RGB, in the order of Prepared::positions(): what leaves the front of each point after emission
  /// or diffuse reflection of direct light and of light from surfaces; 0 of mirrors, metals and glass.
  /// Throws Error(device), and Error(usage) for light that was not solved (path_tracing).
  std::vector<float> radiosity(const RunControl& run = {}) const;

  /// [size], 0 to 1, in the order of Prepared::positions(): the share of the sky that the front of each point sees, its
  /// directions weighted by their cosine to the normal; whatever lights there are. Of four times as many rays a point
  /// as radiosity.light_samples. Throws Error(device).
  std::vector<float> sky(const RunControl& run = {}) const;

  /// The points with their normals, radii, radiosity and colours as a PLY file, as `pointgi bake` writes it: a scene of
  /// one cloud and nothing else gives back the cloud's own points, in their order and with all that they had, and the
  /// results beside them. Throws as radiosity() and sky(), and Error(output).
  void write_ply(const std::string& file, const LitFileOptions& options = {}, const RunControl& run = {}) const;
  /// The same as a LAS file with extra bytes, of a scene of one LAS file and nothing else. Throws as write_ply(), and
  /// Error(usage) for other scenes.
  void write_las(const std::string& file, const LitFileOptions& options = {}, const RunControl& run = {}) const;

  struct Parts; ///< for the library itself
  const std::shared_ptr<Parts>& parts() const { return parts_; }

private:
  std::shared_ptr<Parts> parts_;
};

} // namespace pointgi::api
