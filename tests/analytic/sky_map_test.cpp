/// Environment maps in pictures, against sums over their texels (method/sky.md).
#include "tests/support/number.h"
#include "tests/support/photon_scene.h"
#include "tests/support/scene_parts.h"
#include "tests/support/sky.h"
#include "tests/support/statistics.h"
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;

namespace {

constexpr double pi = 3.14159265358979323846;

/// A map in a file, and as the host knows it.
class MapFile {
public:
  explicit MapFile(const RgbImage& image, double rotate_deg = 0.0)
      : rotate_(rotate_deg), map_(make_environment_map(image, sky_frame(UpAxis::y, rotate_deg), 1.0, "map")) {
    write_exr(folder_.file("map.exr"), image);
  }

  std::string section() const {
    return "[environment]\nmap = \"" + folder_.file("map.exr") + "\"\nrotate_deg = " + number(rotate_) + "\n";
  }
  const EnvironmentMap& operator*() const { return map_; }

private:
  TemporaryFolder folder_;
  double rotate_;
  EnvironmentMap map_;
};

/// Black but for one pixel of 100 W/m²/sr.
RgbImage one_pixel(int column, int row) {
  return grey_image(64, 32, [&](int x, int y) { return x == column && y == row ? 100.0f : 0.0f; });
}

/// A floor of this material, a small patch of it seen from above and aside. Direct light alone.
std::string floor_scene(const std::string& material, const std::string& light, int spp = 64) {
  return "version = 1\n[render]\nsize = [16, 16]\nspp = " + std::to_string(spp) +
         "\n[camera]\nposition = [0.0, 2.0, 2.0]\nlook_at = [0.0, 0.0, 0.0]\nfov_deg = 0.5\n"
         "[radiosity]\nmethod = \"none\"\n[[material]]\nname = \"floor\"\n" +
         material +
         "[[shape]]\ntype = \"quad\"\ncorner = [-2.0, 0.0, -2.0]\nedge_u = [0.0, 0.0, 4.0]\n"
         "edge_v = [4.0, 0.0, 0.0]\nspacing = 0.1\nmaterial = \"floor\"\n" +
         light;
}

const std::string diffuse = "type = \"diffuse\"\nalbedo = [0.6, 0.6, 0.6]\n";

auto by(const char* integrator) {
  return [integrator](RenderOptions& options) { options.integrator = integrator; };
}

/// Even but for a slow swing, in colours that differ: between 0.5 and 1.5.
RgbImage smooth_image() {
  RgbImage image = grey_image(64, 32, [](int x, int y) {
    return static_cast<float>(1.0 + 0.3 * std::sin(2.0 * pi * (x + 0.5) / 64.0) +
                              0.2 * std::cos(pi * (y + 0.5) / 16.0));
  });
  for (std::size_t i = 0; i < image.rgb.size(); i += 3)
    image.rgb[i] *= 0.5f;
  return image;
}

/// Root mean square of the pixels' distance from a value, relative to it.
double deviation(const Picture& picture, const std::string& channel, double from) {
  double square = 0.0;
  for (const float value : picture.channels.at(channel))
    square += std::pow(value / from - 1.0, 2);
  return std::sqrt(square / static_cast<double>(picture.channels.at(channel).size()));
}

Vector3d along(const EnvironmentMap& map, int column, int row) {
  return sky_direction(map.frame, 360.0 * ((column + 0.5) / map.width - 0.5), 90.0 - 180.0 * (row + 0.5) / map.height);
}

} // namespace

TEST_CASE("one bright pixel of a map lights a floor by its radiance, solid angle and cosine", "[long]") {
  struct Place {
    int column, row;
    double rotate_deg;
  };
  for (const Place& p :
       {Place{10, 0, 0.0}, Place{40, 3, 25.0}, Place{0, 9, 0.0}, Place{63, 14, 200.0}, Place{20, 15, 0.0}}) {
    const MapFile map(one_pixel(p.column, p.row), p.rotate_deg);
    const double exact = 0.6 / pi * irradiance(*map, Vector3d::UnitY()).x();
    const double middle = 0.6 / pi * 100.0 *
                          static_cast<double>((*map).rows[static_cast<std::size_t>(p.row)].solid_angle) *
                          along(*map, p.column, p.row).y();
    // The cosine at the pixel's middle instead of over it: less than the square of its width, 0.0024.
    CHECK(exact == Approx(middle).epsilon(0.0025));
    for (const char* integrator : {"pointgi", "path"}) {
      CAPTURE(p.column, p.row, integrator);
      const Picture picture = render_text(floor_scene(diffuse, map.section()), by(integrator));
      // 16384 samples. The cosine over the pixel has a deviation of 2 % of itself, beside the horizon of 60 %.
      CHECK(mean(picture, "R") == Approx(exact).epsilon(p.row < 14 ? 0.002 : 0.01));
      // Of 64 samples, each pixel: besides, a tenth of them meet the bright pixel by the cosine, too, once: 1/64.
      CHECK(deviation(picture, "R", exact) < (p.row < 14 ? 0.01 : p.row < 15 ? 0.03 : 0.09));
    }
  }
}

TEST_CASE("a pixel of the map below the floor's horizon gives it nothing") {
  const MapFile map(one_pixel(20, 17));
  CHECK(largest(render_text(floor_scene(diffuse, map.section())), "R") == 0.0);
}

TEST_CASE("a constant map gives the picture of its radiance, bit-identical", "[long]") {
  const MapFile map(grey_image(8, 4, [](int, int) { return 0.7f; }));
  const std::string material =
      "type = \"phong\"\nalbedo = [0.3, 0.3, 0.3]\nspecular = [0.4, 0.4, 0.4]\nexponent = 20\n";
  for (const char* integrator : {"pointgi", "path"}) {
    const Picture one = render_text(floor_scene(material, map.section(), 8), by(integrator));
    const Picture other =
        render_text(floor_scene(material, "[environment]\nradiance = [0.7, 0.7, 0.7]\n", 8), by(integrator));
    CHECK(mean(one, "R") > 0.1);
    CHECK(one.channels == other.channels);
  }
}

TEST_CASE("a smooth map lights a floor by the sum over its texels, with little noise") {
  const MapFile map(smooth_image(), 40.0);
  const Vector3d exact = 0.6 / pi * irradiance(*map, Vector3d::UnitY());
  for (const char* integrator : {"pointgi", "path"}) {
    CAPTURE(integrator);
    const Picture picture = render_text(floor_scene(diffuse, map.section()), by(integrator));
    CHECK(mean(picture, "R") == Approx(exact.x()).epsilon(0.005));
    CHECK(mean(picture, "G") == Approx(exact.y()).epsilon(0.005));
    // The cosine alone would leave a deviation of 0.2 a sample, the map alone one of 1.2: of 64 samples 0.025 and 0.15.
    CHECK(deviation(picture, "G", exact.y()) < 0.05);
  }
}

TEST_CASE("points of the exchange receive a map's light as the path tracer finds it") {
  const MapFile map(smooth_image());
  std::string scene = "version = 1\n[render]\nsize = [16, 12]\nspp = 256\n[camera]\nposition = [0.0, 1.5, 3.0]\n"
                      "look_at = [0.0, 0.4, 0.0]\nfov_deg = 40.0\n[[material]]\nname = \"white\"\n"
                      "type = \"diffuse\"\nalbedo = [0.8, 0.8, 0.8]\n"
                      "[[shape]]\ntype = \"quad\"\ncorner = [-1.0, 0.0, -1.0]\nedge_u = [0.0, 0.0, 2.0]\n"
                      "edge_v = [2.0, 0.0, 0.0]\nspacing = 0.05\nmaterial = \"white\"\n"
                      "[[shape]]\ntype = \"quad\"\ncorner = [-1.0, 0.0, -1.0]\nedge_u = [2.0, 0.0, 0.0]\n"
                      "edge_v = [0.0, 1.5, 0.0]\nspacing = 0.05\nmaterial = \"white\"\n" +
                      map.section();
  const Picture ours = render_text(scene), truth = render_text(scene, by("path"));
  CHECK(mean(ours, "Diffuse.G") > 0.05);
  const LightTest test = test_of_light(ours, truth, 0.005); // the solver's epsilon
  CAPTURE(test.part, test.off);
  CHECK(test.p > significance);
  CHECK(mean(ours, "Diffuse.G") == Approx(mean(truth, "Diffuse.G")).epsilon(0.03)); // its own noise and clusters'
}

TEST_CASE("the background and a mirror show the texels that rays lead to", "[long]") {
  const MapFile map(spotted_image(16, 8));
  const auto colours = [](const Picture& picture) {
    return Vector3d(mean(picture, "R"), mean(picture, "G"), mean(picture, "B"));
  };
  for (const int row : {1, 2, 3}) {
    const int column = row == 1 ? 1 : 10;
    const Vector3d d = along(*map, column, row);
    const SkyTexel& texel = (*map).texels[static_cast<std::size_t>(row * 16 + column)];
    const Vector3d radiance(texel.radiance[0], texel.radiance[1], texel.radiance[2]);
    const auto camera_at = [&](const Vector3d& from, const Vector3d& at) {
      const auto text = [](const Vector3d& v) {
        return "[" + number(v.x()) + ", " + number(v.y()) + ", " + number(v.z()) + "]";
      };
      std::string scene = floor_scene("type = \"mirror\"\nreflectance = [0.5, 0.5, 0.5]\n", map.section(), 4);
      const std::size_t begin = scene.find("position"), end = scene.find("fov_deg");
      return scene.replace(begin, end - begin, "position = " + text(from) + "\nlook_at = " + text(at) + "\n");
    };
    const Vector3d above(0.0, 5.0, 0.0), mirrored(d.x(), -d.y(), d.z());
    for (const char* integrator : {"pointgi", "path"}) {
      CAPTURE(row, integrator);
      const Picture sky = render_text(camera_at(above, above + d), by(integrator));
      CHECK((colours(sky) - radiance).norm() <= 1e-5 * radiance.norm());
      const Picture mirror = render_text(camera_at(-1.5 * mirrored, Vector3d::Zero()), by(integrator));
      CHECK((colours(mirror) - 0.5 * radiance).norm() <= 1e-5 * radiance.norm());
    }
  }
}

TEST_CASE("lobes see a map by sampled light and by their own rays together as by their own rays alone", "[long]") {
  RgbImage image = smooth_image();
  for (std::size_t k = 0; k < 3; ++k) // a bright pixel near where the camera's ray is mirrored to, 45 degrees ahead
    image.rgb[3 * (8 * 64 + 33) + k] = 60.0f;
  const MapFile map(image);
  const std::string lobes[] = {
      "type = \"phong\"\nalbedo = [0.0, 0.0, 0.0]\nspecular = [0.8, 0.8, 0.8]\nexponent = 12.0\n",
      "type = \"conductor\"\nreflectance = [0.8, 0.8, 0.8]\nroughness = 0.4\n"};
  for (const std::string& lobe : lobes) {
    CAPTURE(lobe);
    std::string alone = floor_scene(lobe, map.section(), 4096);
    const std::string none = "method = \"none\"\n";
    alone.replace(alone.find(none), none.size(), "direct_light = \"radiosity\"\nlight_samples = 1\n");
    const Picture by_rays = render_text(alone);
    for (const char* integrator : {"pointgi", "path"}) {
      CAPTURE(integrator);
      const Picture both = render_text(floor_scene(lobe, map.section(), 1024), by(integrator));
      // A million rays of which one in a hundred meets a pixel sixty times as bright: 0.6 % of deviation, and less.
      CHECK(mean(both, "G") == Approx(mean(by_rays, "G")).epsilon(0.01));
      CHECK(mean(both, "G") > 1.0);
    }
  }
}

TEST_CASE("photons of a map carry its flux by way of a mirror", "[long]") {
  const MapFile map(one_pixel(32, 8)); // ahead of the camera, to -z, 42 degrees high: its light travels towards +z
  const auto sent = [](const std::string& light) {
    const PhotonScene scene("version = 1\n[caustics]\nphotons = 200000\n"
                            "[[material]]\nname = \"mirror\"\ntype = \"mirror\"\nreflectance = [1.0, 1.0, 1.0]\n"
                            "[[material]]\nname = \"white\"\ntype = \"diffuse\"\nalbedo = [0.5, 0.5, 0.5]\n"
                            "[[shape]]\ntype = \"quad\"\ncorner = [-0.5, 0.0, -0.5]\nedge_u = [0.0, 0.0, 1.0]\n"
                            "edge_v = [1.0, 0.0, 0.0]\nmaterial = \"mirror\"\nspacing = 0.05\n"
                            "[[shape]]\ntype = \"quad\"\ncorner = [-2.0, -0.5, 1.5]\nedge_u = [0.0, 4.0, 0.0]\n"
                            "edge_v = [4.0, 0.0, 0.0]\nmaterial = \"white\"\nspacing = 0.1\n" +
                            light);
    const PhotonLedger ledger = scene.send().ledger;
    return std::pair(scene.watts(ledger.emitted_power[1]), scene.watts(ledger.stored_power[1]));
  };
  // Discs stick out of the mirror: its area is what a directional light finds.
  const double area =
      sent("[[light]]\ntype = \"directional\"\ndirection = [0.0, -1.0, 0.0]\nirradiance = [1.0, 1.0, 1.0]\n").first;
  CHECK(area == Approx(1.0).epsilon(0.1));
  const auto [emitted, stored] = sent(map.section());
  CHECK(emitted == Approx(area * irradiance(*map, Vector3d::UnitY()).x()).epsilon(0.005)); // as of a beam
  CHECK(stored == Approx(emitted).epsilon(1e-3));                                          // all of it meets the wall
}

TEST_CASE("a glass ball throws the light of a map onto a floor as paths find it", "[long]") {
  // A patch of sky 22 degrees wide, which paths meet by chance often enough to be compared with.
  const MapFile map(
      grey_image(32, 16, [](int x, int y) { return x >= 15 && x < 17 && y >= 3 && y < 5 ? 50.0f : 0.2f; }));
  const std::string scene = "version = 1\n[render]\nsize = [24, 18]\nspp = 16\n[camera]\nposition = [0.0, 1.6, 2.6]\n"
                            "look_at = [0.0, 0.1, 0.2]\nfov_deg = 35.0\n[radiosity]\nmethod = \"none\"\n"
                            "[caustics]\nphotons = 400000\n"
                            "[[material]]\nname = \"glass\"\ntype = \"glass\"\nior = 1.5\n"
                            "[[material]]\nname = \"white\"\ntype = \"diffuse\"\nalbedo = [0.6, 0.6, 0.6]\n"
                            "[[shape]]\ntype = \"sphere\"\ncentre = [0.0, 0.45, 0.0]\nradius = 0.35\n"
                            "material = \"glass\"\nspacing = 0.03\n"
                            "[[shape]]\ntype = \"quad\"\ncorner = [-1.5, 0.0, -1.5]\nedge_u = [0.0, 0.0, 3.0]\n"
                            "edge_v = [3.0, 0.0, 0.0]\nmaterial = \"white\"\nspacing = 0.06\n" +
                            map.section();
  const Picture ours = render_text(scene);
  const Picture caustic = trace(scene, "LS+DE", 1024);
  // Paths: 442368 of which one in a hundred ends in the patch, 2 %; photons spread by their gathering, 1 %.
  CHECK(mean(ours, "Caustic.G") == Approx(mean(caustic, "G")).epsilon(0.06));
}
