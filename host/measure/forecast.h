#pragma once
/// What a measured setting would take and give in a picture of another size and with other samples, and the choice of
/// one for a time or an error.
#include "host/measure/noise_model.h"
#include "host/measure/trade.h"

namespace pointgi {

/// A setting but for the samples of its pixels: the light, and what a sample adds to it.
struct LightChoice {
  std::string name;                   ///< of the run that it was measured by, the one of most samples
  std::vector<std::string> overrides; ///< but for render.spp
  double light_seconds = 0.0;         ///< of everything but the picture
  double seconds_a_sample = 0.0;      ///< of a pixel
  Estimate light_error;               ///< relMSE that more samples leave; may be below 0 within its interval
  double noise_a_sample = 0.0;        ///< relMSE of one sample a pixel, as the variances of pixels tell it
  NoiseModel noise;                   ///< what that makes of more samples
};

/// The settings of the trade's runs; of runs that differ in render.spp alone there is one. Those whose surface is
/// another one than the reference's are among them: their error says so.
std::vector<LightChoice> light_choices(const Trade& trade);

/// The model that fits the errors of runs which differ in render.spp alone, by least squares of what they are off by
/// relatively; of two numbers of samples alone the power is 1. What variances tell, where the trade has none.
NoiseModel noise_model(const Trade& trade);

struct PictureChoice {
  LightChoice light;
  int samples = 1; ///< a pixel
  double seconds = 0.0, error = 0.0;
};

/// `pixels` of the picture, 1 or more.
double seconds_of(const LightChoice& light, double pixels, int samples);
double error_of(const LightChoice& light, int samples);

/// The fastest whose error is at most `error` (relMSE, above 0); absent: none reaches it with the samples there can be.
std::optional<PictureChoice> choose_for_error(const std::vector<LightChoice>& lights, double pixels, double error);

/// The most accurate that takes at most `seconds`; absent: none is so fast.
std::optional<PictureChoice> choose_for_time(const std::vector<LightChoice>& lights, double pixels, double seconds);

} // namespace pointgi
