#pragma once
/// From a prepared scene to the files of its picture, at once or getting better.
#include "host/app/grow_picture.h"
#include "host/app/preview.h"
#include "host/cache/checkpoint.h"
#include <memory>

namespace pointgi {

struct PictureRun {
  const api::Context& context;
  const api::Prepared& prepared;
  const api::FilmOptions& film;
  bool by_paths;
  double pixels; ///< of its window
  const RunControl& control;
  Checkpoint* checkpoint = nullptr; ///< of the light and the film; null: nothing is kept
};

struct MadePictureFiles {
  std::unique_ptr<api::Light> light; ///< null: what was written is a first picture without it
  RenderTotals totals;
  bool interrupted = false;
  std::string told; ///< how far it is where it was interrupted, or how good it is, in a sentence; may be empty
};

/// Row after row straight into the files. Throws Error(interrupted) when that comes before a row is finished, which
/// leaves older files alone, and as Light, FilmJob and PictureOutput.
MadePictureFiles make_picture_at_once(const PictureRun& run, PictureOutput& output);

/// Is called after the preview, if given: may change the goal and the settings of the prepared scene's light.
using BeforeLight = std::function<void(PictureGoal& goal, const PreviewCost& preview)>;

/// Whether the machine can hold the film of a picture that gets better; of an open goal a second one besides, as
/// samples that are less than a pass are replaced by others; of a picture that is `denoised` what that takes.
bool film_fits(const api::Prepared& prepared, double pixels, bool has_open_goal, bool denoised);

/// A preview, then the picture whenever it is better (host/app/grow_picture.h). Throws Error(interrupted) when that
/// comes before the preview, Error(memory) where its film does not fit beside what the machine holds, and as Light,
/// FilmJob and PictureOutput.
MadePictureFiles make_growing_picture(const PictureRun& run, PictureGoal goal, const BeforeLight& before_light,
                                      PictureOutput& output);

} // namespace pointgi
