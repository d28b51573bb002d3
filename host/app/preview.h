#pragma once
/// A first picture, long before the one that was asked for.
#include "host/app/picture_output.h"

namespace pointgi {

/// What it cost, for what comes after it.
struct PreviewCost {
  double seconds_a_sample = 0.0;    ///< of all pixels
  double seconds_a_direction = 0.0; ///< of the light between surfaces; infinite: too long to be tried
};

/// Direct light, and light between surfaces by as few directions as fit into `seconds`; no caustics, next to no
/// samples. The stage `preview`. Throws as Light, FilmJob::render and PictureOutput::write.
PreviewCost write_preview(const api::Context& context, const api::Prepared& prepared, const api::FilmOptions& film,
                          double seconds, PictureOutput& output, const RunControl& run);

} // namespace pointgi
