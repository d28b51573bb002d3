/// What accuracy is left at the extremes: light at points and in pictures against closed forms, on one device.
/// bench_extremes [DEVICE]      writes a line for each case, separated by tabs: extreme, value, then mean [any unit]
/// and largest relative error against the closed form of the light at the points, and of that in a picture, by eye and
/// shadow rays. Nothing is timed. scripts/extremes makes docs/method/extremes.md of it.
#include "host/api/film.h"
#include "host/error.h"
#include "tests/support/number.h"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

using namespace pointgi;
using test::number;

namespace {

constexpr double pi = 3.14159265358979323846;

std::string triple(double x, double y, double z) {
  return "[" + number(x) + ", " + number(y) + ", " + number(z) + "]";
}

std::string diffuse(double albedo, double emission = 0.0) {
  return "[[material]]\nname = \"grey\"\ntype = \"diffuse\"\nalbedo = " + triple(albedo, albedo, albedo) +
         "\nemission = " + triple(emission, emission, emission) + "\n";
}

std::string point_light(double x, double y, double z, double watts) {
  return "[[light]]\ntype = \"point\"\nposition = " + triple(x, y, z) + "\npower_w = " + triple(watts, watts, watts) +
         "\n";
}

/// A square floor in the plane z = `height`, of the given half side about (x, y), facing up.
std::string floor_at(double x, double y, double height, double half, double spacing) {
  return "[[shape]]\ntype = \"quad\"\ncorner = " + triple(x - half, y - half, height) +
         "\nedge_u = " + triple(2.0 * half, 0.0, 0.0) + "\nedge_v = " + triple(0.0, 2.0 * half, 0.0) +
         "\nspacing = " + number(spacing) + "\nmaterial = \"grey\"\n";
}

constexpr const char* head = "version = 1\nup = \"z\"\n";
/// Of pixels by rays, and not by what the points know.
constexpr const char* direct_alone = "[radiosity]\nmethod = \"none\"\ndirect_light = \"shadow_rays\"\n";

/// The mean of what was found, and how far it is at most from what is right, relative to that.
struct Found {
  double mean = 0.0, error = 0.0;
};

std::string text_of(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

using Radiosity = std::function<double(double x, double y, double z)>;

void count(double is, double expected, Found& found) {
  found.mean += is;
  // Not std::max, which forgets what is no number.
  const double error = std::fabs(is - expected) / expected;
  if (!std::isnan(found.error) && !(error <= found.error)) found.error = error;
}

/// A case: a scene, the radiosity that its points have, and a camera that sees some of them in small pixels.
struct Case {
  std::string scene;
  Radiosity right;
  api::Camera camera;
  std::function<bool(double, double, double)> counts = {}; ///< of a point; empty: all do
};

Found at_points(const Case& of, const api::Prepared& prepared, const api::Light& light) {
  const std::vector<double> at = prepared.positions();
  const std::vector<float> radiosity = light.radiosity();
  Found found;
  std::size_t points = 0;
  for (std::size_t i = 0; i < prepared.size(); ++i) {
    if (of.counts && !of.counts(at[3 * i], at[3 * i + 1], at[3 * i + 2])) continue;
    count(radiosity[3 * i], of.right(at[3 * i], at[3 * i + 1], at[3 * i + 2]), found);
    ++points;
  }
  found.mean /= static_cast<double>(points);
  return found;
}

/// Radiance times pi, against the radiosity of the place that the camera looks at.
Found in_picture(const Case& of, const api::Light& light) {
  api::FilmOptions options;
  options.camera = of.camera;
  options.width = options.height = 16;
  options.spp = 32;
  const api::Film film(light, options);
  const auto& [x, y, z] = of.camera.look_at;
  Found found;
  for (const float red : film.channel("R"))
    count(pi * red, of.right(x, y, z), found);
  found.mean /= static_cast<double>(film.channel("R").size());
  return found;
}

void tell(const api::Context& context, const char* extreme, const std::string& value, const Case& of) {
  const api::Prepared prepared(context, api::Scene::from_text(of.scene));
  const api::Light light(prepared);
  const Found points = at_points(of, prepared, light), picture = in_picture(of, light);
  std::printf("%s\t%s\t%.9g\t%.2g\t%.9g\t%.2g\n", extreme, value.c_str(), points.mean, points.error, picture.mean,
              picture.error);
  std::fflush(stdout);
}

/// From above onto a place a little beside the middle of a floor at (m, m, m), of half side s, so narrow that the light
/// of all that is seen is alike to 1e-5.
api::Camera above(double m = 0.0, double s = 1.0) {
  return {{m + 0.11 * s, m + 0.07 * s, m + 1.2 * s}, {m + 0.1 * s, m + 0.06 * s, m}, 0.001, {{0.0, 1.0, 0.0}}};
}

/// rho P cos / (4 pi d^2) of a floor at `height` under a light of P watts at (lx, ly, lz).
Radiosity under_light(double albedo, double watts, double lx, double ly, double lz) {
  return [=](double x, double y, double z) {
    const double dx = x - lx, dy = y - ly, dz = z - lz, d2 = dx * dx + dy * dy + dz * dz;
    return albedo * watts * std::fabs(dz) / (4.0 * pi * d2 * std::sqrt(d2));
  };
}

void scales(const api::Context& context) {
  for (const double s : {1e-6, 1e-3, 1.0, 1e3, 1e6})
    tell(context, "scale", text_of(s),
         {head + diffuse(0.5) + floor_at(0.0, 0.0, 0.0, s, 0.05 * s) +
              point_light(0.3 * s, 0.2 * s, 1.5 * s, 100.0 * s * s) + direct_alone,
          under_light(0.5, 100.0 * s * s, 0.3 * s, 0.2 * s, 1.5 * s), above(0.0, s)});
}

void offsets(const api::Context& context) {
  for (const double m : {0.0, 1e3, 1e6, 1e9})
    tell(context, "offset over size", text_of(m),
         {head + diffuse(0.5) + floor_at(m, m, m, 1.0, 0.05) + point_light(m + 0.3, m + 0.2, m + 1.5, 100.0) +
              direct_alone,
          under_light(0.5, 100.0, m + 0.3, m + 0.2, m + 1.5), above(m)});
}

/// Of the light, and of the eye rays.
void grazing_angles(const api::Context& context) {
  for (const double degrees : {45.0, 80.0, 89.0, 89.9, 89.99}) {
    // Far off, so that all of the floor has about this angle.
    const double far = 1000.0, x = far * std::sin(degrees * pi / 180.0), z = far * std::cos(degrees * pi / 180.0);
    const api::Camera camera{{-x / 500.0, 0.0, z / 500.0}, {0.0, 0.0, 0.0}, 1e-5, {{0.0, 1.0, 0.0}}};
    tell(context, "grazing angle", text_of(degrees),
         {head + diffuse(0.5) + floor_at(0.0, 0.0, 0.0, 1.0, 0.1) + point_light(x, 0.0, z, 1e8) + direct_alone,
          under_light(0.5, 1e8, x, 0.0, z), camera});
  }
}

void depths(const api::Context& context) {
  for (const int depth : {0, 5, 10, 20, 21})
    tell(context, "depth of the octree", std::to_string(depth),
         {head + diffuse(0.5) + floor_at(0.0, 0.0, 0.0, 1.0, 0.05) + floor_at(5.0, 5.0, -3.0, 0.1, 0.05) +
              point_light(0.3, 0.2, 1.5, 100.0) + direct_alone +
              "[octree]\nbranching = 2\nleaf_capacity = 4\nmax_depth = " + std::to_string(depth) + "\n",
          under_light(0.5, 100.0, 0.3, 0.2, 1.5), above()});
}

/// A floor of fine discs above one of discs `ratio` times as large.
void radius_ratios(const api::Context& context) {
  for (const double ratio : {1.0, 1e2, 1e4, 1e6}) {
    const double fine = 0.05, coarse = fine * ratio, far = 1.0 + 3.0 * coarse;
    tell(context, "radius ratio", text_of(ratio),
         {head + diffuse(0.5) + floor_at(0.0, 0.0, 0.0, 0.5, fine) + floor_at(0.0, 0.0, -far, 3.0 * coarse, coarse) +
              point_light(0.3, 0.2, 1.5, 10.0) + direct_alone,
          under_light(0.5, 10.0, 0.3, 0.2, 1.5), above(), [](double, double, double z) { return z > -0.5; }});
  }
}

/// A closed sphere that shines everywhere: B = pi L / (1 - rho).
void albedos(const api::Context& context) {
  for (const double albedo : {0.0, 0.5, 0.9, 0.99, 0.999})
    tell(context, "albedo", text_of(albedo),
         {head + diffuse(albedo, 1.0) +
              "[[shape]]\ntype = \"sphere\"\ncentre = [0.0, 0.0, 0.0]\nradius = 1.0\ninward = true\n"
              "spacing = 0.1\nmaterial = \"grey\"\n[radiosity]\nmethod = \"directions\"\ntolerance = 1e-6\n",
          [=](double, double, double) { return pi / (1.0 - albedo); },
          {{0.1, 0.2, 0.3}, {1.0, 0.1, 0.2}, 20.0, {{0.0, 0.0, 1.0}}}});
}

void powers(const api::Context& context) {
  for (const double watts : {1e-20, 1e-7, 1.0, 1e7, 1e20})
    tell(context, "power", text_of(watts),
         {head + diffuse(0.5) + floor_at(0.0, 0.0, 0.0, 1.0, 0.05) + point_light(0.3, 0.2, 1.5, watts) + direct_alone,
          under_light(0.5, watts, 0.3, 0.2, 1.5), above()});
}

/// The same floor with another one so far away that it is a crumb of the scene.
void distances(const api::Context& context) {
  for (const double far : {1e1, 1e2, 1e3, 1e4, 1e5, 1e6})
    tell(context, "scene over object", text_of(far),
         {head + diffuse(0.5) + floor_at(0.0, 0.0, 0.0, 1.0, 0.1) + floor_at(far, far, 0.0, 1.0, 0.1) +
              point_light(0.3, 0.2, 1.5, 100.0) + direct_alone,
          under_light(0.5, 100.0, 0.3, 0.2, 1.5), above(),
          [](double x, double y, double) { return std::fabs(x) <= 1.0 && std::fabs(y) <= 1.0; }});
}

} // namespace

int main(int argc, char** argv) {
  try {
    const api::Context context(argc > 1 ? argv[1] : "");
    std::printf("device\t%s\n", context.device().c_str());
    for (const auto table : {scales, offsets, grazing_angles, depths, radius_ratios, albedos, powers, distances})
      table(context);
  } catch (const Error& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
