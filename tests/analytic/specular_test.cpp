/// Mirrors, glass and Phong surfaces in the picture and in the path tracer, against what is known of them (truths.md
/// §1).
#include "tests/support/scene_parts.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;

namespace {

constexpr double pi = 3.14159265358979323846;

void check_sum_of_channels(const Picture& picture) {
  const auto value = [&](const std::string& name, std::size_t i) {
    const auto channel = picture.channels.find(name);
    return channel == picture.channels.end() ? 0.0f : channel->second[i];
  };
  for (const char* colour : {"R", "G", "B"})
    for (std::size_t i = 0; i < picture.channels.at("R").size(); ++i) {
      const std::string c = colour;
      const double sum =
          value("Direct." + c, i) + value("Diffuse." + c, i) + value("Caustic." + c, i) + value("Specular." + c, i);
      REQUIRE(value(c, i) == Approx(sum).epsilon(1e-5).margin(1e-7));
    }
}

} // namespace

TEST_CASE("spheres that lose no light vanish in a uniform environment", "[long]") {
  const std::string type = GENERATE("mirror", "glass");
  const double spacing = GENERATE(0.1, 0.05);
  CAPTURE(type, spacing);
  const std::string scene = head("0.0, 0.0, 4.0", "0.0, 0.0, 0.0", 36.0, 32, "[48, 48]") + environment(1.0) +
                            material("m", type) + sphere("0.0, 0.0, 0.0", 1.0, "m", spacing);
  for (const Picture& picture : {render_text(scene), trace(scene)}) {
    CHECK(mean(picture, "G") == Approx(1.0).epsilon(0.005));
    CHECK(smallest(picture, "G") > 0.95);
    CHECK(largest(picture, "G") < 1.05);
    CHECK(mean(picture, "Specular.G") > 0.3); // the sphere covers half of the picture
    check_sum_of_channels(picture);
  }
}

TEST_CASE("balls of two glasses that overlap vanish in a uniform environment, their seam too", "[long]") {
  // In the seam rays are reflected totally up to hundreds of times before they find their way out.
  const std::string scene = head("0.0, 0.0, 3.0", "0.0, 0.0, 0.0", 40.0, 64, "[80, 60]") + environment(1.0) +
                            material("glass", "glass", "ior = 1.5") + material("water", "glass", "ior = 1.33") +
                            sphere("0.0, 0.0, 0.0", 0.8, "glass", 0.02) + sphere("0.5, 0.0, 0.0", 0.6, "water", 0.02);
  const Picture picture = render_text(scene);
  CHECK(mean(picture, "G") == Approx(1.0).epsilon(0.001));
  CHECK(smallest(picture, "G") > 0.95); // one of 64 samples lost is 0.984
}

TEST_CASE("glass of index 1 is not to be seen", "[long]") {
  const std::string wall = quad("-2.0, -2.0, -1.5", "2.0, 0.0, 0.0", "0.0, 4.0, 0.0", "bright", 0.1) +
                           quad("0.0, -2.0, -1.5", "2.0, 0.0, 0.0", "0.0, 4.0, 0.0", "dim", 0.1);
  const std::string before =
      head("0.3, 0.2, 4.0", "0.0, 0.0, 0.0", 30.0, 32) + lamp("bright", 1.0) + lamp("dim", 0.25) + wall;
  const Picture bare = render_text(before);
  const Picture glazed =
      render_text(before + material("air", "glass", "ior = 1.0") + sphere("0.0, 0.0, 0.0", 1.0, "air", 0.1));
  REQUIRE(mean(glazed, "Specular.R") > 0.2);
  double off = 0.0;
  for (std::size_t i = 0; i < bare.channels.at("R").size(); ++i)
    off += std::fabs(glazed.channels.at("R")[i] - bare.channels.at("R")[i]);
  // Where the wall changes, rays that rounding has turned by 1e-4 may fall on the other side: one of 32 in such a
  // pixel.
  CHECK(off / static_cast<double>(bare.channels.at("R").size()) < 0.002);
}

TEST_CASE("a clear slab reflects 2F/(1+F) of what is before it", "[long]") {
  // Bright before, dark behind; a box has edges, which the narrow view does not meet.
  const std::string scene = head("0.0, 0.0, 3.0", "0.0, 0.0, 0.0", 4.0, 256) + environment(1.0) + lamp("dark", 0.0) +
                            material("glass", "glass", "ior = 1.5") +
                            box("-0.5, -0.5, -0.1", "0.5, 0.5, 0.1", "glass", 0.05) +
                            box("-3.0, -3.0, -3.0", "3.0, 3.0, -2.0", "dark", 0.2);
  // 576 pixels of 256 samples, each either all or nothing: 0.9 % of 0.0769, so that four deviations are 4 %.
  CHECK(mean(render_text(scene), "R") == Approx(0.0769).epsilon(0.04));
}

TEST_CASE("glass absorbs by Beer's law, in the scene's unit of length", "[long]") {
  const double ior = GENERATE(1.0, 1.5);
  const std::string scene = head("0.0, 0.0, 3.0", "0.0, 0.0, 0.0", 4.0, 64) + environment(1.0) +
                            material("glass", "glass", "ior = " + number(ior) + "\nabsorption = [0.0, 1.0, 4.0]") +
                            box("-0.5, -0.5, -0.25", "0.5, 0.5, 0.25", "glass", 0.05);
  const Picture picture = render_text(scene);
  const double f = std::pow((ior - 1.0) / (ior + 1.0), 2);
  for (const auto& [channel, absorption] : {std::pair<const char*, double>{"R", 0.0}, {"G", 1.0}, {"B", 4.0}}) {
    CAPTURE(ior, channel);
    const double a = std::exp(-0.5 * absorption); // of one crossing; F + (1-F)² a (1 + F a) / (1 - F² a²)
    const double truth = f + (1.0 - f) * (1.0 - f) * a * (1.0 + f * a) / (1.0 - f * f * a * a);
    // 1 %: rays cross aslant by up to 2.8 degrees, 0.1 % longer; noise of the choice at the first surface 0.5 %.
    CHECK(mean(picture, channel) == Approx(truth).epsilon(0.01));
  }
}

TEST_CASE("a mirror shows a lamp at the mirrored place, times its reflectance", "[long]") {
  const auto scene = [](const std::string& things) {
    return head("0.0, 0.0, 1.5", "0.0, 0.0, 0.0", 50.0, 32, "[32, 32]") + lamp("lamp", 2.0) +
           material("mirror", "mirror", "reflectance = [0.8, 0.5, 0.2]") + things;
  };
  const Picture mirrored = render_text(scene(quad("-2.0, -2.0, 0.0", "4.0, 0.0, 0.0", "0.0, 4.0, 0.0", "mirror", 0.1) +
                                             quad("0.2, -0.3, 2.0", "0.0, 0.7, 0.0", "0.5, 0.0, 0.0", "lamp", 0.02)));
  const Picture straight = render_text(scene(quad("0.2, -0.3, -2.0", "0.5, 0.0, 0.0", "0.0, 0.7, 0.0", "lamp", 0.02)));
  REQUIRE(mean(straight, "R") > 0.02);
  std::size_t off = 0;
  for (std::size_t i = 0; i < straight.channels.at("R").size(); ++i)
    for (const auto& [channel, reflectance] : {std::pair<const char*, double>{"R", 0.8}, {"G", 0.5}, {"B", 0.2}})
      off += std::fabs(mirrored.channels.at(channel)[i] - reflectance * straight.channels.at(channel)[i]) >
             0.1 * reflectance; // a sample or two of 32 at the rim of the lamp, which is made of discs
  CHECK(off == 0);
  CHECK(mean(mirrored, "R") == Approx(0.8 * mean(straight, "R")).epsilon(0.005));
  CHECK(largest(mirrored, "Direct.R") == 0.0);
}

namespace {

/// Mean over a square picture of fov 60 degrees of reflectance^n: n bounces between mirrors at z = -1 and 1, `half`
/// from their middle to their edges, until the ray leaves them for a sky of radiance 1; the eye stands at z = 0.5. A
/// ray of slope s, the larger of those along x and y, is 1.5 s, 3.5 s, 5.5 s, … aside where it meets them.
double between_mirrors(double reflectance, double half) {
  constexpr int steps = 100'000;
  const double most = std::tan(pi / 6.0);
  double sum = 0.0;
  for (int k = 0; k < steps; ++k) {
    const double s = most * (k + 0.5) / steps; // its density is 2 s / most^2
    const double bounces = std::floor(std::max(0.0, (half / s - 1.5) / 2.0 + 1.0));
    sum += std::pow(reflectance, bounces) * 2.0 * s / most / steps;
  }
  return sum;
}

} // namespace

TEST_CASE("mirrors that face each other end, and lose what they absorb and no more", "[long]") {
  const double reflectance = GENERATE(0.9, 1.0);
  const std::string scene = head("0.0, 0.0, 0.5", "0.0, 0.0, 0.0", 60.0, 32) + environment(1.0) +
                            material("mirror", "mirror", "reflectance = " + grey(reflectance)) +
                            quad("-2.0, -2.0, -1.0", "4.0, 0.0, 0.0", "0.0, 4.0, 0.0", "mirror", 0.1) +
                            quad("-2.0, -2.0, 1.0", "0.0, 4.0, 0.0", "4.0, 0.0, 0.0", "mirror", 0.1);
  for (const Picture& picture : {render_text(scene), trace(scene)}) {
    CHECK(largest(picture, "R") < (reflectance < 1.0 ? 4.0 : 1.5)); // roulette: few survive, with more weight
    CHECK(smallest(picture, "R") >= 0.0);
    CHECK(mean(picture, "R") <= 1.0 + 1e-3);
    // Rims of discs stick out of the mirrors by less than a spacing, so that rays leave later. 1 %: noise of 18432
    // samples 0.3 %, and rays that eye samples give up after 64 bounces, a tenth of a percent of them.
    CHECK(mean(picture, "R") > 0.99 * between_mirrors(reflectance, 2.1));
    CHECK(mean(picture, "R") < 1.01 * between_mirrors(reflectance, 2.0));
  }
}

TEST_CASE("in a closed room that shines all over, glass and mirrors let no light out", "[long]") {
  // Any ray ends on a wall's front, of radiance 1; one that got out through the floor below the glass would read
  // nothing.
  const std::string scene = head("0.2, 1.1, 1.7", "0.0, 0.4, 0.0", 60.0, 32, "[48, 36]") + lamp("wall", 1.0) +
                            material("glass", "glass") + material("water", "glass", "ior = 1.33") +
                            material("mirror", "mirror") + box("-2.0, 0.0, -2.0", "2.0, 2.0, 2.0", "wall", 0.1, true) +
                            sphere("-0.6, 0.4, 0.0", 0.4, "glass", 0.06) +
                            sphere("-0.6, 0.4, 0.0", 0.2, "water", 0.04) +          // in the other
                            box("0.2, 0.0, -0.4", "0.9, 0.7, 0.3", "glass", 0.06) + // on the floor
                            sphere("0.1, 0.15, 0.9", 0.15, "mirror", 0.03);
  for (const Picture& picture : {render_text(scene), trace(scene)}) {
    CHECK(mean(picture, "R") == Approx(1.0).epsilon(0.003));
    CHECK(smallest(picture, "R") > 0.9); // 3 samples of 32
    CHECK(largest(picture, "R") < 1.0 + 0.1);
    CHECK(mean(picture, "Specular.R") > 0.1);
  }
}

TEST_CASE("furnace with glass and mirrors in it: E/(1 - rho), through shadow rays and without", "[long]") {
  const std::string scene = head("0.2, 1.1, 1.7", "0.0, 0.4, 0.0", 60.0, 64, "[32, 24]") +
                            material("wall", "diffuse", "albedo = [0.5, 0.5, 0.5]\nemission = [1.0, 1.0, 1.0]") +
                            material("glass", "glass") + material("mirror", "mirror") +
                            box("-2.0, 0.0, -2.0", "2.0, 2.0, 2.0", "wall", 0.1, true) +
                            sphere("-0.6, 0.5, 0.0", 0.4, "glass", 0.08) + sphere("0.6, 0.5, 0.2", 0.4, "mirror", 0.08);
  const Picture all = trace(scene);
  CHECK(mean(all, "R") == Approx(2.0).epsilon(0.01)); // as without them (path_test.cpp); noise of 49152 paths 0.3 %
  check_sum_of_channels(all);
  // Its classes apart: those with caustics (an S on the light's side of a D) and those without.
  const double without = mean(trace(scene, "LD*S*E"), "R");
  CHECK(without < 1.9);
  CHECK(without + mean(trace(scene, "LD*S+DE,LD*S+DD+E,LD*S+DS+E,LD*S+DD+S+E,LD*S+D+S+D+E,LD*S+D+S+D+S+E"), "R") ==
        Approx(2.0).epsilon(0.02)); // all but what has three stretches of S on the way
}

TEST_CASE("Phong surfaces under a uniform sky and under a point light", "[long]") {
  const double exponent = GENERATE(1.0, 50.0);
  CAPTURE(exponent);
  const std::string surface =
      material("phong", "phong",
               "albedo = [0.3, 0.3, 0.3]\nspecular = [0.5, 0.5, 0.5]\nexponent = " + number(exponent)) +
      quad("-1.0, -1.0, 0.0", "2.0, 0.0, 0.0", "0.0, 2.0, 0.0", "phong", 0.1);
  // A light 30 degrees aside at distance 2. Each light is there in both scenes, so that they share their kernels.
  const auto lights = [](double sky, double power) {
    return environment(sky) + "[[light]]\ntype = \"point\"\nposition = [1.0, 0.0, " + number(std::sqrt(3.0)) +
           "]\npower_w = " + grey(power) + "\n";
  };
  // Straight before it a lobe gives back all that it may: specular; aside less, what falls below the surface is lost.
  const std::string sky = head("0.0, 0.0, 3.0", "0.0, 0.0, 0.0", 2.0, 64) + surface + lights(1.0, 1e-9);
  CHECK(mean(render_text(sky), "R") == Approx(0.8).epsilon(0.01)); // noise of 36864 samples below 0.3 %
  CHECK(mean(trace(sky), "R") == Approx(0.8).epsilon(0.01));
  // f cos I / d², f = 0.3 / pi + 0.5 (n + 2) / (2 pi) cos^n 30.
  const std::string lit = head("0.0, 0.0, 3.0", "0.0, 0.0, 0.0", 0.2, 32) + surface + lights(1e-9, 40.0);
  const double cosine = std::cos(pi / 6.0), irradiance = 40.0 / (4.0 * pi) * cosine / 4.0;
  const double diffuse = 0.3 / pi * irradiance;
  const double highlight = 0.5 * (exponent + 2.0) / (2.0 * pi) * std::pow(cosine, exponent) * irradiance;
  for (const Picture& picture : {render_text(lit), trace(lit)}) {
    CHECK(mean(picture, "Direct.R") == Approx(diffuse).epsilon(0.005)); // no noise; 0.1 degrees of view
    CHECK(mean(picture, "Specular.R") == Approx(highlight).epsilon(0.01));
  }
  CHECK(mean(trace(lit, "LDE"), "R") == Approx(diffuse).epsilon(0.005));
  CHECK(mean(trace(lit, "LSE"), "R") == Approx(highlight).epsilon(0.01));
}

TEST_CASE("the picture of a room with mirror, glass and a glossy floor is the path tracer's, caustics too", "[long]") {
  struct Room {
    const char* name;
    bool mirror, glass;
    std::string floor;
  };
  const Room rooms[] = {{"mirror", true, false, "white"},
                        {"glass", false, true, "white"},
                        {"mirror, glass and a glossy floor", true, true, "floor"}};
  for (const Room& room : rooms) {
    CAPTURE(room.name);
    const std::string scene =
        head("0.1, 1.0, 3.4", "0.0, 0.8, 0.0", 40.0, 128, "[32, 24]") +
        material("white", "diffuse", "albedo = [0.7, 0.7, 0.7]") +
        material("red", "diffuse", "albedo = [0.7, 0.1, 0.1]") +
        material("floor", "phong", "albedo = [0.4, 0.4, 0.4]\nspecular = [0.3, 0.3, 0.3]\nexponent = 40.0") +
        material("mirror", "mirror", "reflectance = [0.9, 0.9, 0.9]") + material("glass", "glass") + lamp("lamp", 9.0) +
        quad("-1.0, 0.0, -1.0", "0.0, 0.0, 2.0", "2.0, 0.0, 0.0", room.floor, 0.08) +
        quad("-1.0, 2.0, -1.0", "2.0, 0.0, 0.0", "0.0, 0.0, 2.0", "white", 0.08) +
        quad("-1.0, 0.0, -1.0", "2.0, 0.0, 0.0", "0.0, 2.0, 0.0", "white", 0.08) +
        quad("-1.0, 0.0, -1.0", "0.0, 2.0, 0.0", "0.0, 0.0, 2.0", "red", 0.08) +
        quad("1.0, 0.0, -1.0", "0.0, 0.0, 2.0", "0.0, 2.0, 0.0", "white", 0.08) +
        (room.mirror ? sphere("-0.4, 0.45, -0.2", 0.35, "mirror", 0.06) : "") +
        (room.glass ? sphere("0.4, 0.35, 0.3", 0.3, "glass", 0.06) : "") +
        "[[shape]]\ntype = \"disc\"\ncentre = [0.0, 1.95, 0.0]\nnormal = [0.0, -1.0, 0.0]\nradius = 0.3\n"
        "spacing = 0.015\nmaterial = \"lamp\"\n[radiosity]\n[caustics]\nphotons = 200000\n";
    const Picture picture = render_text(scene);
    check_sum_of_channels(picture);
    CHECK(largest(picture, "Diffuse.G") > 0.0);
    // LD+, seen directly or by way of specular surfaces, and caustics: not what these or mirrors pass on once more. Of
    // 3 %, 1 % is radiosity's own error (radiosity_test.cpp) and 1 % the noise of the path tracer.
    const Picture truth = trace(scene, "LD*S*E,LS+DS*E", 256);
    check_sum_of_channels(truth);
    for (const char* channel : {"R", "G", "B", "Direct.G", "Specular.G"}) {
      CAPTURE(channel);
      CHECK(mean(picture, channel) == Approx(mean(truth, channel)).epsilon(0.03));
    }
    const Picture without = trace(scene, "LD*S*E", 256);
    CHECK(mean(picture, "Diffuse.G") == Approx(mean(without, "Diffuse.G")).epsilon(0.03));
    // A few hundredths of the light, so looked at apart. 5 %: noise of paths that find them by chance 2 %; the lamp's
    // discs are small, for these paths meet rims that stick out of the lamp (of 0.05: 4 %), and no photon leaves there.
    CHECK(mean(picture, "Caustic.G") == Approx(mean(trace(scene, "LS+DE", 1024), "G")).epsilon(0.05));
  }
}
