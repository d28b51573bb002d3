#pragma once
/// Pictures in memory.
#include "host/api/prepared.h"
#include <cstdint>

namespace pointgi::api {

/// What a film shows; what is left out is as the scene has it.
struct FilmOptions {
  std::optional<Camera> camera;
  std::optional<int> width, height; ///< pixels, 1 or more
  std::optional<int> spp;           ///< samples a pixel, 1 or more
  std::optional<unsigned> seed;     ///< of the samples
  /// {x0, x1, y0, y1}, ends exclusive: only this part of the picture.
  std::optional<std::array<int, 4>> window;
  /// Of path-traced light: the paths that count, e.g. "LDE" (docs/reference.md, --paths); empty: all.
  std::string paths;
  /// Channels that guide a denoiser, too: "Denoise.Albedo.R", "Denoise.N.X", "Denoise.Emission.R", ...
  bool auxiliary = false;
};

/// Named channels of floats: "R", "G", "B" (radiance [W/m²/sr]), "A" (coverage), "Direct.R", "Diffuse.R", "Albedo.R",
/// "N.X" (normal), "P.X" (position), "Z" (depth), ...: those of the EXR files (docs/reference.md).
class Film {
public:
  /// Renders. Throws Error: usage for options that cannot be, input for a camera that sees nothing, device, memory,
  /// interrupted.
  explicit Film(const Light& light, const FilmOptions& options = {}, const RunControl& run = {});

  int width() const;  ///< of the window
  int height() const; ///< of the window

  std::vector<std::string> channels() const;
  /// [height x width], rows downwards. Throws Error(usage), with the names that there are.
  const std::vector<float>& channel(const std::string& name) const;
  /// [height x width]: Prepared::ids() of the point that each pixel shows; 2^32 - 1 where there is none.
  const std::vector<std::uint32_t>& point_ids() const;

  /// All channels, with the attributes of the command line's pictures. Throws Error(output).
  void write_exr(const std::string& file) const;
  /// R, G and B as sRGB bytes, brightened by `exposure` stops. Throws Error(output).
  void write_png(const std::string& file, double exposure = 0.0) const;

private:
  struct Parts;
  std::shared_ptr<const Parts> parts_;
};

} // namespace pointgi::api
