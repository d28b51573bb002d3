#pragma once
/// Pictures that get better until they are good enough or the time is over; each of them is a whole file.
#include "host/app/picture_output.h"
#include "host/measure/noise_model.h"

namespace pointgi {

/// When a picture is finished: at its number of samples, or where `until` or `error` is given, by these alone.
struct PictureGoal {
  int samples = 1;               ///< a pixel
  std::optional<double> until;   ///< seconds of the stage log, with the writing of the files
  std::optional<double> error;   ///< relMSE
  double light_error = 0.0;      ///< relMSE that more samples leave
  bool light_error_known = true; ///< else only the noise is told
  NoiseModel noise;              ///< what the pixels' variances mean
  double seconds_a_sample = 0.0; ///< of all pixels, as far as it is known; 0: it is not
  double noise_a_sample = 0.0;   ///< relMSE of one sample a pixel as variances tell it, as far as known; 0: it is not

  bool is_open() const { return until.has_value() || error.has_value(); }
};

struct GrownPicture {
  RenderTotals totals;
  int samples = 0;    ///< a pixel, of the rows that have the fewest
  double noise = 0.0; ///< relMSE that the pixels' variances tell; infinite where they do not
};

/// Adds samples, and writes the picture whenever that costs little, until the goal is reached or the run is to stop.
/// After an interruption the best picture is written that has all of its rows; none where there is none, which leaves
/// `output` as it was. `control`: hears of the stages after the last sample. The stage `render`, `denoise` where asked
/// for, then `image`. Throws as FilmJob::render and PictureOutput::write.
GrownPicture grow_picture(api::Context::Parts& context, api::FilmJob& job, const PictureGoal& goal,
                          PictureOutput& output, const RunControl& control = {});

/// The stage `denoise` of the picture that has begun, where it is to be.
void denoise_in_stage(StageLog& stages, const PixelWindow& window, PictureOutput& output);

/// relMSE of the picture against its own mean by its pixels' variances.
double relative_noise(const GrowingFilm& film, const std::vector<ChannelName>& channels);

/// Samples that a pixel should have next, of `now`: of a goal that is open the least of what its time allows (0: no
/// more) and of what its error needs, in steps of at most as many as there are; whole passes, but for the last. `left`:
/// seconds for samples; `noise`: of the picture now.
int next_samples(const PictureGoal& goal, int now, double left, double noise);

} // namespace pointgi
