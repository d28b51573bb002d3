#pragma once
/// A scene text becomes a lit cloud, the way a user's does: the bake command, the PLY file read back.
#include "host/app/commands.h"
#include "tests/support/temporary_folder.h"
#include <Eigen/Core>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

namespace pointgi::test {

/// One point of the file, as bytes lie there.
struct LitPoint {
  Eigen::Vector3d position;
  Eigen::Vector3f normal;
  unsigned char colour[3];
  float radiosity[3];
};

/// Bakes the scene text with these overrides.
inline std::vector<LitPoint> bake(const std::string& scene, const std::vector<std::string>& set = {},
                                  const std::string& quality = "normal") {
  const TemporaryFolder folder;
  BakeOptions options;
  options.input = folder.write("scene.toml", scene);
  options.output = folder.file("lit.ply");
  options.overrides = set;
  options.quality = quality;
  options.quiet = true;
  if (run_bake(options) != ExitCode::done) throw std::runtime_error("the cloud was not finished");
  const std::string text = contents(options.output);
  constexpr std::size_t size = 55; // double position, float normal, bytes of colour, float radius and radiosity
  std::vector<LitPoint> points;
  for (std::size_t at = text.find("end_header\n") + 11; at + size <= text.size(); at += size) {
    LitPoint& p = points.emplace_back();
    std::memcpy(p.position.data(), &text[at], 24);
    std::memcpy(p.normal.data(), &text[at + 24], 12);
    std::memcpy(p.colour, &text[at + 36], 3);
    std::memcpy(p.radiosity, &text[at + 43], 12);
  }
  return points;
}

} // namespace pointgi::test
