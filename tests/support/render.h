#pragma once
/// A scene text becomes a picture, the way a user's does: the render command, the EXR file read back.
#include "host/app/commands.h"
#include "host/image/picture_writer.h"
#include "tests/support/temporary_folder.h"
#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <string>

namespace pointgi::test {

/// Renders `toml`; `adjust` may set flags.
template <typename Adjust>
Picture render_text(const std::string& toml, Adjust adjust) {
  const TemporaryFolder folder;
  RenderOptions options;
  options.input = folder.file("scene.toml");
  options.output = folder.file("picture.exr");
  options.quiet = true;
  std::ofstream(options.input) << toml;
  adjust(options);
  const ExitCode code = run_render(options);
  if (code != ExitCode::done) throw std::runtime_error("the picture was not finished");
  return read_exr(options.output);
}

inline Picture render_text(const std::string& toml) {
  return render_text(toml, [](RenderOptions&) {});
}

/// Mean of a channel over the picture.
inline double mean(const Picture& picture, const std::string& channel) {
  double sum = 0.0;
  for (const float value : picture.channels.at(channel))
    sum += value;
  return sum / static_cast<double>(picture.channels.at(channel).size());
}

namespace detail {

/// The value that none comes before; NaN where one is, so that no comparison with a bound holds.
template <typename Before>
double first_of(const Picture& picture, const std::string& channel, Before before) {
  const std::vector<float>& values = picture.channels.at(channel);
  double first = values.at(0);
  for (const double value : values) {
    if (std::isnan(value)) return value;
    if (before(value, first)) first = value;
  }
  return first;
}

} // namespace detail

/// The largest value of a channel; NaN where one is.
inline double largest(const Picture& picture, const std::string& channel) {
  return detail::first_of(picture, channel, [](double a, double b) { return a > b; });
}

/// The smallest value of a channel; NaN where one is.
inline double smallest(const Picture& picture, const std::string& channel) {
  return detail::first_of(picture, channel, [](double a, double b) { return a < b; });
}

} // namespace pointgi::test
