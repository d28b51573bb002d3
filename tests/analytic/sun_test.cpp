/// The sun and its sky in pictures, against the model that the host computes (method/sky.md).
#include "host/lights/sky_model.h"
#include "host/lights/sun_position.h"
#include "tests/support/number.h"
#include "tests/support/photon_scene.h"
#include "tests/support/render.h"
#include "tests/support/sky.h"
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;

namespace {

constexpr double pi = 3.14159265358979323846;

/// A morning of June at 50 degrees north.
const std::string sun = "[[light]]\ntype = \"sun\"\ndate = \"2024-06-21\"\ntime = \"09:00Z\"\nlatitude = 50.0\n"
                        "longitude = 0.0\nnorth_deg = 160.0\nturbidity = 2.5\n";
const std::string night = "[[light]]\ntype = \"sun\"\ndate = \"2024-06-21\"\ntime = \"00:00Z\"\nlatitude = 50.0\n"
                          "longitude = 0.0\n";

std::string text(const Vector3d& v) {
  return "[" + number(v.x()) + ", " + number(v.y()) + ", " + number(v.z()) + "]";
}

/// A floor of this material, seen by a narrow camera; `more` is appended. Direct light alone.
std::string floor_scene(const std::string& material, const Vector3d& from, const Vector3d& at, const std::string& more,
                        int spp = 64, double fov = 0.2) {
  return "version = 1\n[render]\nsize = [16, 16]\nspp = " + std::to_string(spp) +
         "\n[camera]\nposition = " + text(from) + "\nlook_at = " + text(at) + "\nfov_deg = " + number(fov) +
         "\n[radiosity]\nmethod = \"none\"\n[[material]]\nname = \"floor\"\n" + material +
         "[[shape]]\ntype = \"quad\"\ncorner = [-2.0, 0.0, -2.0]\nedge_u = [0.0, 0.0, 4.0]\n"
         "edge_v = [4.0, 0.0, 0.0]\nspacing = 0.1\nmaterial = \"floor\"\n" +
         more;
}

const std::string diffuse = "type = \"diffuse\"\nalbedo = [0.6, 0.6, 0.6]\n";
const std::string mirror = "type = \"mirror\"\nreflectance = [0.5, 0.5, 0.5]\n";
const Vector3d aside(0.0, 2.0, 2.0);

/// What the scene file's sun becomes.
struct Noon {
  Scene scene;
  Vector3d towards, irradiance, disc; ///< radiance of the disc
  double cosine;

  Noon() {
    const TemporaryFolder folder;
    scene = load_scene(folder.write("sun.toml", floor_scene(diffuse, aside, Vector3d::Zero(), sun)));
    const LightSettings& light = scene.lights.at(0);
    towards = light.vector;
    irradiance = light.strength;
    cosine = towards.y();
    disc = irradiance / (pi * std::pow(std::sin(0.265 * pi / 180.0), 2));
  }

  Vector3d sky(const Vector3d& direction) const {
    const SkyTexel& texel = scene.sky->texels[texel_towards(*scene.sky, direction)];
    return {texel.radiance[0], texel.radiance[1], texel.radiance[2]};
  }
};

auto by(const char* integrator) {
  return [integrator](RenderOptions& options) { options.integrator = integrator; };
}

Vector3d colour(const Picture& picture) {
  return {mean(picture, "R"), mean(picture, "G"), mean(picture, "B")};
}

} // namespace

TEST_CASE("a scene file's sun stands where its place and time have it, in the scene's axes") {
  const Noon noon;
  REQUIRE(noon.scene.sky != nullptr);
  const SunPosition position = sun_position({{2024, 6, 21}, {9, 0, 0.0}, {0}}, 50.0, 0.0, Refraction::standard);
  const Vector3d expected = sky_direction(sky_frame(UpAxis::y, 160.0), position.azimuth_deg, position.elevation_deg);
  CHECK((noon.towards - expected).norm() < 1e-12);
  CHECK(noon.cosine == Approx(std::sin(position.elevation_deg * pi / 180.0)).epsilon(1e-12));
}

TEST_CASE("a date stands in quotes or as TOML has dates") {
  const Vector3d from(0, 1, 1), at(0, 0, 0);
  std::string unquoted = sun;
  unquoted.replace(unquoted.find("\"2024-06-21\""), 12, "2024-06-21");
  const PhotonScene a(floor_scene(diffuse, from, at, sun)), b(floor_scene(diffuse, from, at, unquoted));
  CHECK(a.scene.lights.at(0).vector == b.scene.lights.at(0).vector);
}

TEST_CASE("sun and sky light a floor by radiance, solid angle and cosine", "[long]") {
  const Noon noon;
  const Vector3d exact = 0.6 / pi * (noon.irradiance * noon.cosine + irradiance(*noon.scene.sky, Vector3d::UnitY()));
  const double solid_angle = 4.0 * pi * std::pow(std::sin(0.5 * 0.265 * pi / 180.0), 2);
  CHECK(noon.irradiance.isApprox(noon.disc * solid_angle, 1e-5)); // a cosine over the disc against its solid angle
  for (const char* integrator : {"pointgi", "path"}) {
    const Picture picture = render_text(floor_scene(diffuse, aside, Vector3d::Zero(), sun), by(integrator));
    CAPTURE(integrator);
    // The sun is exact; of the sky, a fifth of the light, 16384 samples.
    CHECK((colour(picture) - exact).norm() < 0.003 * exact.norm());
  }
}

TEST_CASE("the sun's disc is seen, and seen in a mirror, as bright as it is", "[long]") {
  const Noon noon;
  const Vector3d above(0.0, 5.0, 0.0), mirrored(noon.towards.x(), -noon.towards.y(), noon.towards.z());
  for (const char* integrator : {"pointgi", "path"}) {
    CAPTURE(integrator);
    const Vector3d seen = colour(render_text(floor_scene(mirror, above, above + noon.towards, sun, 4), by(integrator)));
    const Vector3d reflected =
        colour(render_text(floor_scene(mirror, -1.5 * mirrored, Vector3d::Zero(), sun, 4), by(integrator)));
    // Behind it lies a sky that is a ten-thousandth as bright, of a few texels.
    CHECK((seen - noon.disc - noon.sky(noon.towards)).norm() < 1e-4 * noon.disc.norm());
    CHECK((reflected - 0.5 * (noon.disc + noon.sky(noon.towards))).norm() < 1e-4 * noon.disc.norm());
    // Half a degree aside is only the sky, by a texel or two.
    const Vector3d beside = (noon.towards + 0.009 * noon.towards.unitOrthogonal()).normalized();
    const Vector3d sky = colour(render_text(floor_scene(mirror, above, above + beside, sun, 4), by(integrator)));
    CHECK((sky - noon.sky(beside)).norm() < 0.1 * sky.norm());
  }
}

TEST_CASE("a blocker takes the sun away and leaves the sky", "[long]") {
  const Noon noon;
  // At a distance of 2 the sun's edge is 0.009 wide, so that a disc of 0.1 hides all of it from the patch, and an
  // 800th of the sky.
  const std::string blocker = "[[shape]]\ntype = \"disc\"\ncentre = " + text(2.0 * noon.towards) +
                              "\nnormal = " + text(noon.towards) +
                              "\nradius = 0.1\nspacing = 0.01\nmaterial = \"floor\"\n";
  const Vector3d sky = 0.6 / pi * irradiance(*noon.scene.sky, Vector3d::UnitY());
  const double hidden = pi * 0.01 / 4.0 * noon.cosine;
  const Vector3d left = sky - 0.6 / pi * hidden * noon.sky(noon.towards);
  for (const char* integrator : {"pointgi", "path"}) {
    CAPTURE(integrator);
    const Picture picture = render_text(floor_scene(diffuse, aside, Vector3d::Zero(), sun + blocker), by(integrator));
    CHECK((colour(picture) - left).norm() < 0.01 * left.norm()); // the disc's bumpy rim hides some sky more
  }
}

TEST_CASE("lobes see the sun by sampled light and by their own rays together as by their own rays alone", "[long]") {
  const Noon noon;
  const Vector3d mirrored(noon.towards.x(), -noon.towards.y(), noon.towards.z());
  const std::string lobes[] = {
      "type = \"phong\"\nalbedo = [0.0, 0.0, 0.0]\nspecular = [0.8, 0.8, 0.8]\nexponent = 20000.0\n",
      "type = \"conductor\"\nreflectance = [0.8, 0.8, 0.8]\nroughness = 0.1\n"};
  for (const std::string& lobe : lobes) {
    CAPTURE(lobe);
    std::string alone = floor_scene(lobe, -1.5 * mirrored, Vector3d::Zero(), sun, 4096);
    const std::string none = "method = \"none\"\n";
    alone.replace(alone.find(none), none.size(), "direct_light = \"radiosity\"\nlight_samples = 1\n");
    const double by_rays = mean(render_text(alone), "G");
    for (const char* integrator : {"pointgi", "path"}) {
      CAPTURE(integrator);
      const Picture both = render_text(floor_scene(lobe, -1.5 * mirrored, Vector3d::Zero(), sun, 256), by(integrator));
      CHECK(mean(both, "G") == Approx(by_rays).epsilon(0.02)); // of a million rays 1 in 100 and more meet the disc
    }
  }
}

TEST_CASE("photons of the sun and its sky carry their flux by way of a mirror", "[long]") {
  const Noon noon;
  const auto flux = [](const std::string& light) {
    const PhotonScene scene("version = 1\n[caustics]\nphotons = 200000\n[[material]]\nname = \"mirror\"\n" + mirror +
                            "[[material]]\nname = \"white\"\n" + diffuse +
                            "[[shape]]\ntype = \"quad\"\ncorner = [-0.5, 0.0, -0.5]\nedge_u = [0.0, 0.0, 1.0]\n"
                            "edge_v = [1.0, 0.0, 0.0]\nmaterial = \"mirror\"\nspacing = 0.05\n"
                            "[[shape]]\ntype = \"quad\"\ncorner = [-2.0, -1.0, -2.0]\nedge_u = [0.0, 0.0, 4.0]\n"
                            "edge_v = [4.0, 0.0, 0.0]\nmaterial = \"white\"\nspacing = 0.2\n" +
                            light);
    const TracedPhotons traced = scene.send();
    const auto& power = traced.ledger.emitted_power;
    return Vector3d(scene.watts(power[0]), scene.watts(power[1]), scene.watts(power[2]));
  };
  // Discs stick out of the mirror: its area is what a directional light finds.
  const double area =
      flux("[[light]]\ntype = \"directional\"\ndirection = [0.0, -1.0, 0.0]\nirradiance = [1.0, 1.0, 1.0]\n").y();
  CHECK(area == Approx(1.0).epsilon(0.1));
  const Vector3d exact = noon.irradiance * noon.cosine + irradiance(*noon.scene.sky, Vector3d::UnitY());
  // 200000 photons, of which those of the sky, a sixth of the light, are not stratified in direction.
  const Vector3d found = flux(sun + "ground_albedo = 0.0\n"); // the mirror's back would receive light of the ground
  CHECK((found - area * exact).norm() < 0.01 * area * exact.norm());
}

TEST_CASE("a sun below the horizon warns and gives no light") {
  const TemporaryFolder folder;
  const std::string scene = floor_scene(diffuse, aside, Vector3d::Zero(), night);
  const Scene loaded = load_scene(folder.write("night.toml", scene));
  REQUIRE(loaded.warnings.size() == 1); // not, besides, that a light is missing
  CHECK_THAT(loaded.warnings[0], Catch::Contains("night.toml:22:1") && Catch::Contains("below the horizon"));
  CHECK(largest(render_text(scene), "R") == 0.0);
}
