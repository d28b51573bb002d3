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

inline double largest(const Picture& picture, const std::string& channel) {
  double most = -INFINITY;
  for (const float value : picture.channels.at(channel))
    most = value > most ? value : most;
  return most;
}

} // namespace pointgi::test
