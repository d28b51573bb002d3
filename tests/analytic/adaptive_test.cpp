/// Adaptive samples and light through shafts against all samples and path tracing: the same mean, for less work.
#include "tests/support/scene_parts.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;

namespace {

constexpr int seeds = 24;

/// A clear summer's morning: an even sky is darker opposite to the sun.
const std::string sun = "[[light]]\ntype = \"sun\"\ndate = \"2024-06-21\"\ntime = \"09:00Z\"\nlatitude = 50.0\n"
                        "longitude = 0.0\nturbidity = 2.5\n";

/// A box on a floor below a lamp and a sky: edges, borders of albedo, penumbra, umbra, plain floor and a step less than
/// half a disc's radius high.
std::string yard(int spp, const std::string& sky = environment(0.3)) {
  return head("0.6, 1.4, 2.0", "0.0, 0.15, 0.0", 40.0, spp, "[24, 20]") + sky +
         material("floor", "diffuse", "albedo = [0.7, 0.6, 0.2]") +
         material("dark", "diffuse", "albedo = [0.1, 0.2, 0.5]") + lamp("lamp", 20.0) +
         quad("-1.0, 0.0, -1.0", "0.0, 0.0, 2.0", "1.2, 0.0, 0.0", "floor", 0.05) +
         quad("0.2, 0.0, -1.0", "0.0, 0.0, 2.0", "0.8, 0.0, 0.0", "dark", 0.05) +
         quad("0.35, 0.015, 0.0", "0.0, 0.0, 0.3", "0.3, 0.0, 0.0", "dark", 0.05) +
         box("-0.3, 0.0, -0.2", "0.1, 0.4, 0.2", "floor", 0.04) +
         quad("-0.15, 1.6, -0.15", "0.3, 0.0, 0.0", "0.0, 0.0, 0.3", "lamp", 0.03);
}

/// Mean and variance of the mean of each pixel's green over pictures of several seeds.
struct Means {
  std::vector<double> mean, variance;
};

Means means_of(const std::string& scene, const char* adaptive, int first_seed) {
  Means m;
  std::vector<double> squares;
  for (int seed = first_seed; seed < first_seed + seeds; ++seed) {
    const Picture picture = render_text(scene, [&](RenderOptions& o) {
      o.seed = static_cast<unsigned>(seed);
      o.overrides.push_back(std::string("render.adaptive=") + adaptive);
    });
    const std::vector<float>& g = picture.channels.at("G");
    m.mean.resize(g.size()), squares.resize(g.size());
    for (std::size_t i = 0; i < g.size(); ++i)
      m.mean[i] += g[i] / double{seeds}, squares[i] += double{g[i]} * g[i] / seeds;
  }
  for (std::size_t i = 0; i < squares.size(); ++i)
    m.variance.push_back(std::max(0.0, squares[i] - m.mean[i] * m.mean[i]) / (seeds - 1));
  return m;
}

} // namespace

TEST_CASE("few samples of pixels in which nothing changes do not bias the mean", "[long]") {
  // A grid; a whole one; one and a part of one; one and a pass that is no grid.
  const int spp = GENERATE(16, 32, 40, 50);
  const std::string rest = "[radiosity]\nmethod = \"none\"\n";
  // Seeds of their own: of the same ones the differences would be less than both variances say.
  const Means few = means_of(yard(spp) + rest, "true", 1), all = means_of(yard(spp) + rest, "false", 1 + seeds);
  double sum = 0.0, squares = 0.0, off = 0.0, level = 0.0;
  std::size_t noisy = 0;
  for (std::size_t i = 0; i < few.mean.size(); ++i) {
    const double difference = few.mean[i] - all.mean[i], variance = few.variance[i] + all.variance[i];
    off += difference, level += all.mean[i];
    if (variance < 1e-10 * level * level / static_cast<double>((i + 1) * (i + 1))) continue; // of what has no noise
    const double z = difference / std::sqrt(variance);
    sum += z, squares += z * z;
    ++noisy;
  }
  CAPTURE(spp, noisy, sum / static_cast<double>(noisy), off / level);
  REQUIRE(noisy > 100);
  // Student's t of 46 degrees of freedom has variance 46/44; 4 sigma of the mean and of the mean square of as many.
  CHECK(std::fabs(sum / static_cast<double>(noisy)) < 4.0 / std::sqrt(static_cast<double>(noisy)));
  CHECK(squares / static_cast<double>(noisy) < 1.05 + 4.0 * std::sqrt(2.2 / static_cast<double>(noisy)));
  CHECK(std::fabs(off / level) < 1e-3);
}

TEST_CASE("light that shafts and directions tell is that of the path tracer", "[long]") {
  const std::string sky = GENERATE(environment(0.3), sun);
  const std::string scene = yard(256, sky) + "[radiosity]\nmethod = \"directions\"\ndirections = 256\n";
  const Picture picture = render_text(scene), truth = trace(scene, "", 1024);
  // Noise of both: 0.2 % of the mean; light that points interpolate: 0.5 %.
  for (const char* channel : {"R", "G", "B"}) {
    CAPTURE(channel);
    CHECK(mean(picture, channel) == Approx(mean(truth, channel)).epsilon(0.01));
  }
  const Picture direct = trace(yard(256, sky), "LE,LDE", 1024);
  // Direct light, the sky's from the points, alone.
  CHECK(mean(picture, "Direct.G") == Approx(mean(direct, "G")).epsilon(0.01));
}
