/// A pixel through whose middle an edge runs is covered by half, whatever the number of samples.
#include "tests/support/number.h"
#include "tests/support/render.h"
#include <catch2/catch.hpp>
#include <cmath>

using namespace pointgi;
using namespace pointgi::test;

namespace {

constexpr int pixels = 17; ///< along the edge, and across

/// One disc of radius 1, so large that its rim is a straight edge: 17 pixels along it, it bends off by 0.7 % of a
/// pixel.
std::string rim_scene(const std::string& cloud, bool horizontal, double distance, int spp, int seed) {
  const std::string rim = horizontal ? "0.0, 1.0, " : "1.0, 0.0, ";
  const double pixel = 2e-4, fov_deg = 2.0 * std::atan(0.5 * pixels * pixel / distance) * 180.0 / 3.14159265358979;
  return "version = 1\n[render]\nsize = [17, 17]\nspp = " + std::to_string(spp) + "\nseed = " + std::to_string(seed) +
         "\n[camera]\nposition = [" + rim + number(distance) + "]\nlook_at = [" + rim +
         "0.0]\nfov_deg = " + number(fov_deg) +
         "\n[[material]]\nname = \"white\"\ntype = \"diffuse\"\n[[cloud]]\nfile = \"" + cloud +
         "\"\nmaterial = \"white\"\n[environment]\nradiance = [1.0, 1.0, 1.0]\n[radiosity]\nmethod = \"none\"\n";
}

/// Mean coverage of the pixels that the edge runs through.
double edge_coverage(const Picture& picture, bool horizontal) {
  const std::vector<float>& coverage = picture.channels.at("A");
  double sum = 0.0;
  for (int i = 0; i < pixels; ++i)
    sum += coverage.at(static_cast<std::size_t>(horizontal ? pixels / 2 * pixels + i : i * pixels + pixels / 2));
  return sum / pixels;
}

} // namespace

TEST_CASE("an edge through a pixel's middle covers half of it, at every number of samples", "[long]") {
  const TemporaryFolder folder;
  std::ofstream(folder.file("disc.ply"))
      << "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nproperty "
         "float "
         "nx\nproperty float ny\nproperty float nz\nproperty float radius\nend_header\n0 0 0 0 0 1 1\n";
  // From far off rays start where they enter the root cube, each traced on its own.
  const double distance = GENERATE(2.0, 20.0);
  const bool horizontal = GENERATE(true, false);
  const int spp = GENERATE(1, 3, 5, 12, 16, 20, 24, 25, 32, 48, 50, 100);
  constexpr int seeds = 4;
  double sum = 0.0;
  for (int seed = 1; seed <= seeds; ++seed)
    sum += edge_coverage(render_text(rim_scene(folder.file("disc.ply"), horizontal, distance, spp, seed)), horizontal);
  CAPTURE(distance, horizontal, spp);
  // A pass has as many samples below the middle as above, but for one that falls on either side: 3 sigma of that, and 2
  // % of a pixel for the bend of the rim and the rounding of positions, 1e-7 of a pixel's 1e-4 in root cubes, times the
  // distance.
  const double sigma = 0.5 / spp / std::sqrt(static_cast<double>(pixels * seeds));
  CHECK(std::fabs(sum / seeds - 0.5) < 3.0 * sigma + 0.02);
}
