#pragma once
/// Pictures of one scene by many settings, and what each cost.
#include "host/api/parts.h"
#include <map>
#include <memory>

namespace pointgi {

struct MadePicture {
  Picture picture;                      ///< its float channels
  double seconds = 0.0;                 ///< from the prepared cloud to the picture
  std::map<std::string, double> stages; ///< seconds of each
  std::uint64_t memory_bytes = 0;       ///< the most that the device held
  std::string method;                   ///< radiosity.method that solved the light; "none": none was asked
  bool compiled = false;                ///< kernels were built or ran for the first time: `seconds` tells little
};

class PictureMaker {
public:
  /// `overrides`: of all pictures. Throws Error(input) for a scene that cannot be read.
  PictureMaker(const api::Context& context, std::string file, std::vector<std::string> overrides);

  /// The scene as its file and the overrides of all pictures have it, its view chosen where it has none; loads it.
  const Scene& scene(const RunControl& run);
  /// Of the octree; loads the scene.
  std::size_t points(const RunControl& run);

  /// Where the scene gives no size, or another is wanted: of all pictures from now on.
  void set_size(int width, int height);

  /// A picture by the scene's settings but for `overrides`, its visibility map made anew. The clouds are loaded, and
  /// the octree is built, before the time begins; they are kept for the next picture that needs the same ones. Throws
  /// what api::Prepared, api::Light and api::Film throw.
  MadePicture make(const std::vector<std::string>& overrides, unsigned seed, const RunControl& run);

  /// A picture by path tracing over the scene's own splats. `samples`: a pixel.
  MadePicture trace(int samples, unsigned seed, const RunControl& run);

private:
  api::Prepared& prepared(const std::vector<std::string>& overrides, const RunControl& run);
  MadePicture film(const api::Prepared& prepared, const api::LightOptions& how, const api::FilmOptions& options,
                   const RunControl& run);

  api::Context context_;
  std::string file_;
  std::vector<std::string> overrides_;
  std::optional<int> width_, height_;
  std::unique_ptr<api::Prepared> own_;   ///< as the scene's own settings prepare it
  std::unique_ptr<api::Prepared> other_; ///< the last of other settings of octree and traversal
  std::string other_key_;
};

} // namespace pointgi
