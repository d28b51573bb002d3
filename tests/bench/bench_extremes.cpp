/// What accuracy is left at the extremes: light at points and in pictures against closed forms, on one device.
/// bench_extremes [DEVICE]      writes a line for each case, separated by tabs: extreme, value, light [any unit], and
/// its largest relative error against the closed form. Nothing is timed. scripts/extremes makes docs/method/extremes.md
/// of it.
#include "host/api/prepared.h"
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
constexpr const char* direct_alone = "[radiosity]\nmethod = \"none\"\n";

/// The mean of what was found, and how far it is at most from what is right, relative to that.
struct Found {
  double mean = 0.0, error = 0.0;
};

void tell(const char* extreme, const std::string& value, const Found& found) {
  std::printf("%s\t%s\t%.9g\t%.2g\n", extreme, value.c_str(), found.mean, found.error);
  std::fflush(stdout);
}

std::string power_of_ten(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

using Radiosity = std::function<double(double x, double y, double z)>;

/// Radiosity of the points that `counts`, against `right`.
Found at_points(const api::Context& context, const std::string& scene, const Radiosity& right,
                const std::function<bool(double, double, double)>& counts = {}) {
  const api::Prepared prepared(context, api::Scene::from_text(scene));
  const api::Light light(prepared);
  const std::vector<double> at = prepared.positions();
  const std::vector<float> radiosity = light.radiosity();
  Found found;
  std::size_t points = 0;
  for (std::size_t i = 0; i < prepared.size(); ++i) {
    if (counts && !counts(at[3 * i], at[3 * i + 1], at[3 * i + 2])) continue;
    const double expected = right(at[3 * i], at[3 * i + 1], at[3 * i + 2]), is = radiosity[3 * i];
    found.mean += is;
    // Not std::max, which forgets what is no number.
    const double error = std::fabs(is - expected) / expected;
    if (!(error <= found.error)) found.error = error;
    ++points;
  }
  found.mean /= static_cast<double>(points);
  return found;
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
    tell("scale", power_of_ten(s),
         at_points(context,
                   head + diffuse(0.5) + floor_at(0.0, 0.0, 0.0, s, 0.05 * s) +
                       point_light(0.3 * s, 0.2 * s, 1.5 * s, 100.0 * s * s) + direct_alone,
                   under_light(0.5, 100.0 * s * s, 0.3 * s, 0.2 * s, 1.5 * s)));
}

void offsets(const api::Context& context) {
  for (const double m : {0.0, 1e3, 1e6, 1e9})
    tell("offset over size", power_of_ten(m),
         at_points(context,
                   head + diffuse(0.5) + floor_at(m, m, m, 1.0, 0.05) + point_light(m + 0.3, m + 0.2, m + 1.5, 100.0) +
                       direct_alone,
                   under_light(0.5, 100.0, m + 0.3, m + 0.2, m + 1.5)));
}

void grazing_angles(const api::Context& context) {
  for (const double degrees : {45.0, 80.0, 89.0, 89.9, 89.99}) {
    // Far off, so that all of the floor has about this angle.
    const double far = 1000.0, x = far * std::sin(degrees * pi / 180.0), z = far * std::cos(degrees * pi / 180.0);
    tell("grazing angle", number(degrees),
         at_points(context,
                   head + diffuse(0.5) + floor_at(0.0, 0.0, 0.0, 1.0, 0.1) + point_light(x, 0.0, z, 1e8) + direct_alone,
                   under_light(0.5, 1e8, x, 0.0, z)));
  }
}

void depths(const api::Context& context) {
  for (const int depth : {0, 5, 10, 20, 21})
    tell("depth of the octree", std::to_string(depth),
         at_points(context,
                   head + diffuse(0.5) + floor_at(0.0, 0.0, 0.0, 1.0, 0.05) + floor_at(5.0, 5.0, -3.0, 0.1, 0.05) +
                       point_light(0.3, 0.2, 1.5, 100.0) + direct_alone +
                       "[octree]\nbranching = 2\nleaf_capacity = 4\nmax_depth = " + std::to_string(depth) + "\n",
                   under_light(0.5, 100.0, 0.3, 0.2, 1.5)));
}

/// A floor of fine discs beside one of discs `ratio` times as large.
void radius_ratios(const api::Context& context) {
  for (const double ratio : {1.0, 1e2, 1e4, 1e6}) {
    const double fine = 0.05, coarse = fine * ratio, far = 1.0 + 3.0 * coarse;
    tell("radius ratio", power_of_ten(ratio),
         at_points(context,
                   head + diffuse(0.5) + floor_at(0.0, 0.0, 0.0, 0.5, fine) +
                       floor_at(0.0, 0.0, -far, 3.0 * coarse, coarse) + point_light(0.1, 0.1, 0.9, 10.0) + direct_alone,
                   under_light(0.5, 10.0, 0.1, 0.1, 0.9), [](double, double, double z) { return z > -0.5; }));
  }
}

/// A closed sphere that shines everywhere: B = pi L / (1 - rho).
void albedos(const api::Context& context) {
  for (const double albedo : {0.0, 0.5, 0.9, 0.99, 0.999})
    tell("albedo", number(albedo),
         at_points(context,
                   head + diffuse(albedo, 1.0) +
                       "[[shape]]\ntype = \"sphere\"\ncentre = [0.0, 0.0, 0.0]\nradius = 1.0\ninward = true\n"
                       "spacing = 0.1\nmaterial = \"grey\"\n[radiosity]\nmethod = \"directions\"\ntolerance = 1e-6\n",
                   [=](double, double, double) { return pi / (1.0 - albedo); }));
}

void powers(const api::Context& context) {
  for (const double watts : {1e-20, 1e-7, 1.0, 1e7, 1e20})
    tell("power", power_of_ten(watts),
         at_points(context,
                   head + diffuse(0.5) + floor_at(0.0, 0.0, 0.0, 1.0, 0.05) + point_light(0.3, 0.2, 1.5, watts) +
                       direct_alone,
                   under_light(0.5, watts, 0.3, 0.2, 1.5)));
}

/// The same floor with another one so far away that it is a crumb of the scene.
void distances(const api::Context& context) {
  for (const double far : {1e1, 1e2, 1e3, 1e4, 1e5, 1e6})
    tell("scene over object", power_of_ten(far),
         at_points(context,
                   head + diffuse(0.5) + floor_at(0.0, 0.0, 0.0, 1.0, 0.1) + floor_at(far, far, 0.0, 1.0, 0.1) +
                       point_light(0.3, 0.2, 1.5, 100.0) + direct_alone,
                   under_light(0.5, 100.0, 0.3, 0.2, 1.5),
                   [](double x, double y, double) { return std::fabs(x) <= 1.0 && std::fabs(y) <= 1.0; }));
}

} // namespace

int main(int argc, char** argv) {
  try {
    const api::Context context(argc > 1 ? argv[1] : "");
    std::printf("device\t%s\t\t\n", context.device().c_str());
    for (const auto table : {scales, offsets, grazing_angles, depths, radius_ratios, albedos, powers, distances})
      table(context);
  } catch (const Error& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
