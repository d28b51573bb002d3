#pragma once
/// Pictures of one scene by many settings, and what each cost.
#include "host/api/parts.h"
#include <list>
#include <map>
#include <memory>

namespace pointgi {

struct MadePicture {
  Picture picture;                      ///< its float channels
  double seconds = 0.0;                 ///< from the prepared cloud to the picture, those of a kept light with it
  std::map<std::string, double> stages; ///< seconds of each
  std::uint64_t memory_bytes = 0;       ///< the most that the device held
  int samples = 1;                      ///< a pixel
  std::string method;                   ///< radiosity.method that solved the light; "none": none was asked
  bool compiled = false;                ///< kernels were built or ran for the first time: `seconds` tells little
};

class PictureMaker {
public:
  /// `overrides`: of all pictures. Throws Error(input) for a scene that cannot be read.
  PictureMaker(const api::Context& context, std::string file, std::vector<std::string> overrides);

  /// The scene as its file and the overrides of all pictures have it, its view chosen where it has none; loads it.
  const Scene& scene(const RunControl& run);
  /// The scene's render.seed, which pictures need not have.
  unsigned first_seed() const { return first_seed_; }
  /// Seconds that scene() took to load the clouds and to build the octree, when it did.
  double prepare_seconds() const { return prepare_seconds_; }
  /// Of the octree; loads the scene.
  std::size_t points(const RunControl& run);

  /// Where the scene gives no size, or another is wanted: of all pictures from now on.
  void set_size(int width, int height);

  /// A picture by the scene's settings but for `overrides`, its visibility map made anew. The clouds are loaded, and
  /// the octree is built, before the time begins; they are kept for the next picture that needs the same ones. So are
  /// lights that the device has room for, for pictures whose settings differ in [render] alone: the time that the light
  /// took then is added. Throws what api::Prepared, api::Light and api::Film throw.
  MadePicture make(const std::vector<std::string>& overrides, unsigned seed, const RunControl& run);

  /// Seconds that make() need not take, as the light is kept from an earlier picture; 0: it is not.
  double kept_seconds(const std::vector<std::string>& overrides, unsigned seed) const;

  /// As make(), with the visibility map of an earlier run: one is made and kept before the time begins where there is
  /// none.
  MadePicture make_warm(const std::vector<std::string>& overrides, unsigned seed, const RunControl& run);

  /// A picture by path tracing over the scene's own splats. `samples`: a pixel.
  MadePicture trace(int samples, unsigned seed, const RunControl& run);

private:
  /// Solved light, and what it cost.
  struct KeptLight {
    std::string key;
    std::unique_ptr<api::Light> light;
    MadePicture cost;        ///< all but the picture
    std::uint64_t bytes = 0; ///< that the device holds for it
  };

  api::Prepared& prepared(const std::vector<std::string>& overrides, unsigned seed, const RunControl& run);
  KeptLight solve(const api::Prepared& prepared, bool by_paths, const RunControl& run);
  MadePicture film(const KeptLight& light, const api::FilmOptions& options, const RunControl& run);
  api::FilmOptions film_options(unsigned seed) const;
  std::uint64_t bytes_of_others(const KeptLight* light) const; ///< held for all kept lights but this
  std::string light_key(const std::vector<std::string>& overrides, unsigned seed) const;

  api::Context context_;
  std::string file_;
  std::vector<std::string> overrides_;
  unsigned first_seed_ = 1;
  std::optional<int> width_, height_;
  double prepare_seconds_ = 0.0;
  std::unique_ptr<api::Prepared> own_;   ///< as the scene's own settings prepare it
  std::unique_ptr<api::Prepared> other_; ///< the last of other settings of octree and traversal
  std::string other_key_;
  std::list<KeptLight> lights_; ///< the one used last in front
};

} // namespace pointgi
