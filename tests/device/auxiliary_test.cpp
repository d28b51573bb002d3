/// What guides a denoiser: albedo and normal of the first diffuse or rough surface, behind mirrors and glass too.
#include "host/api/parts.h"
#include <catch2/catch.hpp>
#include <cmath>

using namespace pointgi;

namespace {

constexpr double albedo[3] = {0.8, 0.1, 0.3}; // of the wall

/// A narrow view from the origin towards -z, which sees one thing alone and meets it at a right angle nearly.
const std::string narrow_view = R"(
version = 1
[render]
size = [16, 12]
spp = 64
[camera]
position = [0.0, 0.0, 0.0]
look_at = [0.0, 0.0, -1.0]
fov_deg = 3.0
[[light]]
type = "directional"
direction = [0.1, -0.2, -1.0]
irradiance = [2.0, 2.0, 2.0]
[[material]]
name = "wall"
type = "diffuse"
albedo = [0.8, 0.1, 0.3]
)";

/// A square across the axis that faces the camera, or looks the way that the camera does.
std::string square(double z, double side, const std::string& material, bool faces_camera = true) {
  const double h = 0.5 * side;
  const auto vector = [](double x, double y, double at) {
    return "[" + std::to_string(x) + ", " + std::to_string(y) + ", " + std::to_string(at) + "]\n";
  };
  return "[[shape]]\ntype = \"quad\"\nspacing = " + std::to_string(side / 20) + "\nmaterial = \"" + material +
         "\"\ncorner = " + vector(-h, -h, z) + "edge_u = " + (faces_camera ? vector(side, 0, 0) : vector(0, side, 0)) +
         "edge_v = " + (faces_camera ? vector(0, side, 0) : vector(side, 0, 0));
}

api::Film film_of(const std::string& scene, bool by_paths, bool auxiliary = true) {
  static const api::Context context;
  const api::Prepared prepared(context, api::Scene::from_text(scene));
  api::LightOptions light;
  light.path_tracing = by_paths;
  api::FilmOptions options;
  options.auxiliary = auxiliary;
  return api::Film(api::Light(prepared, light), options);
}

double mean(const api::Film& film, const std::string& channel) {
  double sum = 0.0;
  for (const float value : film.channel(channel))
    sum += double{value};
  return sum / static_cast<double>(film.channel(channel).size());
}

struct Guides {
  double albedo[3], normal[3], emission[3];
};

Guides guides_of(const std::string& scene, bool by_paths) {
  const api::Film film = film_of(scene, by_paths);
  Guides found{};
  for (int k = 0; k < 3; ++k) {
    found.albedo[k] = mean(film, std::string("Denoise.Albedo.") + "RGB"[k]);
    found.normal[k] = mean(film, std::string("Denoise.N.") + "XYZ"[k]);
    found.emission[k] = mean(film, std::string("Denoise.Emission.") + "RGB"[k]);
  }
  return found;
}

} // namespace

TEST_CASE("a diffuse wall's albedo and normal guide the denoiser as they are", "[long]") {
  const bool by_paths = GENERATE(false, true);
  const Guides found = guides_of(narrow_view + square(-3.0, 1.0, "wall"), by_paths);
  for (int k = 0; k < 3; ++k) {
    CHECK(found.albedo[k] == Approx(albedo[k]).epsilon(1e-4));
    CHECK(found.normal[k] == Approx(k == 2 ? 1.0 : 0.0).margin(1e-3));
    CHECK(found.emission[k] == 0.0);
  }
}

TEST_CASE("behind a mirror the reflected surface guides the denoiser, its albedo dimmed by the mirror's reflectance",
          "[long]") {
  const bool by_paths = GENERATE(false, true);
  const Guides found =
      guides_of(narrow_view + square(-3.0, 1.0, "mirror") + square(2.0, 4.0, "wall", false) +
                    "[[material]]\nname = \"mirror\"\ntype = \"mirror\"\nreflectance = [0.5, 0.75, 1.0]\n",
                by_paths);
  const double reflectance[3] = {0.5, 0.75, 1.0};
  for (int k = 0; k < 3; ++k) {
    CHECK(found.albedo[k] == Approx(reflectance[k] * albedo[k]).epsilon(1e-4));
    CHECK(found.normal[k] == Approx(k == 2 ? -1.0 : 0.0).margin(1e-3)); // the wall's, not the mirror's
  }
}

TEST_CASE("behind glass the surface guides the denoiser, blended with what the glass reflects as its light is",
          "[long]") {
  const bool by_paths = GENERATE(false, true);
  const std::string slab = "[[material]]\nname = \"glass\"\ntype = \"glass\"\nior = 1.5\n[[shape]]\ntype = \"box\"\n"
                           "min = [-0.5, -0.5, -2.2]\nmax = [0.5, 0.5, -2.0]\nspacing = 0.05\nmaterial = \"glass\"\n";
  const Guides found = guides_of(narrow_view + square(-3.0, 4.0, "wall") + slab, by_paths);
  // Both faces reflect 4 %, again and again; behind the camera is nothing, of albedo 1 and without a normal.
  const double r = 0.04, reflected = 2.0 * r / (1.0 + r);
  const double rays = 16 * 12 * 64, deviation = std::sqrt(reflected * (1.0 - reflected) / rays);
  for (int k = 0; k < 3; ++k)
    CHECK(found.albedo[k] == Approx((1.0 - reflected) * albedo[k] + reflected).margin(5.0 * deviation));
  CHECK(found.normal[2] == Approx(1.0 - reflected).margin(5.0 * deviation));
  CHECK(found.normal[0] == Approx(0.0).margin(1e-3));
}

TEST_CASE("a rough surface guides the denoiser itself, with the reflectance of its lobe", "[long]") {
  const bool by_paths = GENERATE(false, true);
  struct Rough {
    std::string keys;
    double albedo[3];
  };
  const Rough all[] = {
      {"type = \"phong\"\nalbedo = [0.2, 0.3, 0.4]\nspecular = [0.5, 0.4, 0.3]\nexponent = 20.0\n", {0.7, 0.7, 0.7}},
      {"type = \"conductor\"\nreflectance = [0.9, 0.6, 0.3]\nroughness = 0.5\n", {0.9, 0.6, 0.3}}};
  for (const Rough& rough : all) {
    CAPTURE(rough.keys);
    const Guides found = guides_of(narrow_view + square(-3.0, 1.0, "rough") + square(2.0, 4.0, "wall", false) +
                                       "[[material]]\nname = \"rough\"\n" + rough.keys,
                                   by_paths);
    for (int k = 0; k < 3; ++k)
      CHECK(found.albedo[k] == Approx(rough.albedo[k]).epsilon(1e-4));
    CHECK(found.normal[2] == Approx(1.0).epsilon(1e-3));
  }
}

TEST_CASE("where nothing is met the albedo is 1, the normal 0, and the sky is emission", "[long]") {
  const bool by_paths = GENERATE(false, true);
  const bool specular = GENERATE(false, true);
  const std::string beside = "[[shape]]\ntype = \"sphere\"\ncentre = [5.0, 0.0, 0.0]\nradius = 0.5\nspacing = 0.2\n"
                             "material = \"" +
                             std::string(specular ? "mirror" : "wall") + "\"\n";
  const Guides found = guides_of(narrow_view + beside +
                                     "[environment]\nradiance = [0.5, 0.25, 2.0]\n"
                                     "[[material]]\nname = \"mirror\"\ntype = \"mirror\"\n",
                                 by_paths);
  const double sky[3] = {0.5, 0.25, 2.0};
  for (int k = 0; k < 3; ++k) {
    CHECK(found.albedo[k] == Approx(1.0));
    CHECK(found.normal[k] == 0.0);
    CHECK(found.emission[k] == Approx(sky[k]).epsilon(1e-5));
  }
}

TEST_CASE("emission is what a lamp sends to the eye, without what the lamp reflects", "[long]") {
  const bool by_paths = GENERATE(false, true);
  const bool specular = GENERATE(false, true);
  const std::string lamp = "[[material]]\nname = \"lamp\"\ntype = \"diffuse\"\nalbedo = [0.5, 0.5, 0.5]\n"
                           "emission = [3.0, 2.0, 1.0]\n";
  std::string scene = narrow_view + lamp + square(-3.0, 1.0, "lamp");
  if (specular) scene += "[[material]]\nname = \"mirror\"\ntype = \"mirror\"\n" + square(9.0, 1.0, "mirror", false);
  const api::Film film = film_of(scene, by_paths);
  const double emission[3] = {3.0, 2.0, 1.0};
  for (int k = 0; k < 3; ++k) {
    const std::string colour(1, "RGB"[k]);
    CHECK(mean(film, "Denoise.Emission." + colour) == Approx(emission[k]).epsilon(1e-5));
    CHECK(mean(film, "Direct." + colour) > 1.1 * emission[k]);
  }
}

TEST_CASE("what guides a denoiser changes no bit of the picture beside it", "[long]") {
  const bool by_paths = GENERATE(false, true);
  const bool specular = GENERATE(false, true);
  std::string scene = narrow_view + square(-3.0, 0.1, "wall") + square(2.0, 4.0, "wall", false) +
                      "[environment]\nradiance = [0.5, 0.25, 2.0]\n";
  if (specular)
    scene += square(-5.0, 4.0, "mirror") + "[[material]]\nname = \"mirror\"\ntype = \"mirror\"\n[caustics]\n"
                                           "photons = 2000\n";
  const api::Film with = film_of(scene, by_paths), without = film_of(scene, by_paths, false);
  CHECK(with.channels().size() == without.channels().size() + 9);
  for (const std::string& channel : without.channels()) {
    CAPTURE(channel, by_paths, specular);
    CHECK(with.channel(channel) == without.channel(channel));
  }
  CHECK(with.point_ids() == without.point_ids());
  CHECK_THROWS(without.channel("Denoise.N.X"));
}
