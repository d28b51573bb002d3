#pragma once
/// Scenes that are the same picture at every size, place and power.
#include "tests/support/number.h"
#include "tests/support/render.h"
#include <cmath>
#include <cstdio>

namespace pointgi::test {

inline std::string numbers(double x, double y, double z) {
  char text[120];
  std::snprintf(text, sizeof text, "[%.17g, %.17g, %.17g]", x, y, z);
  return text;
}

/// A ball on a floor under a point light and a lamp, the whole scaled by s about the origin and then moved by m on
/// every axis; the point light's power goes with s², so that the picture stays the same.
inline std::string ball_scene(double s, double m = 0.0, double power = 30.0, const std::string& more = "") {
  const auto at = [&](double x, double y, double z) { return numbers(s * x + m, s * y + m, s * z + m); };
  const auto along = [&](double x, double y, double z) { return numbers(s * x, s * y, s * z); };
  return "version = 1\n[render]\nsize = [64, 48]\nspp = 32\n" + more + "[camera]\nposition = " + at(0.3, 1.2, 3.0) +
         "\nlook_at = " + at(0.0, 0.4, 0.0) +
         "\nfov_deg = 40.0\n"
         "[[material]]\nname = \"grey\"\ntype = \"diffuse\"\nalbedo = [0.6, 0.6, 0.6]\n"
         "[[shape]]\ntype = \"sphere\"\ncentre = " +
         at(0.0, 0.5, 0.0) + "\nradius = " + number(0.5 * s) + "\nspacing = " + number(0.04 * s) +
         "\nmaterial = \"grey\"\n[[shape]]\ntype = \"quad\"\ncorner = " + at(-1.5, 0.0, -1.5) +
         "\nedge_u = " + along(0.0, 0.0, 3.0) + "\nedge_v = " + along(3.0, 0.0, 0.0) +
         "\nspacing = " + number(0.05 * s) +
         "\nmaterial = \"grey\"\n[[light]]\ntype = \"point\"\nposition = " + at(0.7, 1.9, 0.8) +
         "\npower_w = " + numbers(power * s * s, power * s * s, power * s * s) + "\n";
}

/// Share of the samples' weight that changed: mean |a - b| over mean b. A rounded coordinate may move a sample across a
/// shadow's edge, which a mean forgives and a largest difference does not.
inline double mean_difference(const Picture& a, const Picture& b) {
  double sum = 0.0;
  const auto &x = a.channels.at("R"), &y = b.channels.at("R");
  for (std::size_t i = 0; i < x.size(); ++i)
    sum += std::fabs(static_cast<double>(x[i]) - y[i]);
  return sum / static_cast<double>(x.size()) / mean(b, "R");
}

/// Where a cloud lies that is else of size 1 about the origin.
struct Place {
  double size = 1.0;
  double x = 0.0, y = 0.0, z = 0.0;
};

/// A sphere with normals, of radius 1 at the origin or in its place, as an ascii PLY, and more lines behind its points.
inline std::string sphere_ply(int count, const std::vector<std::string>& more, const Place& place = {}) {
  std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(count + static_cast<int>(more.size())) +
                     "\nproperty double x\nproperty double y\nproperty double z\nproperty float nx\nproperty float ny\n"
                     "property float nz\nend_header\n";
  for (int i = 0; i < count; ++i) {
    const double z = 1.0 - 2.0 * (i + 0.5) / count, r = std::sqrt(1.0 - z * z), a = 2.399963229728653 * i;
    const double n[3] = {r * std::cos(a), r * std::sin(a), z};
    text += number(place.x + place.size * n[0]) + " " + number(place.y + place.size * n[1]) + " " +
            number(place.z + place.size * n[2]) + " " + number(n[0]) + " " + number(n[1]) + " " + number(n[2]) + "\n";
  }
  for (const std::string& line : more)
    text += line + "\n";
  return text;
}

inline Picture render_ply(const std::string& text, const Place& place = {},
                          const std::vector<std::string>& more_overrides = {}) {
  const TemporaryFolder folder;
  RenderOptions options;
  options.input = folder.write("cloud.ply", text);
  options.output = folder.file("cloud.exr");
  options.size = "64x48";
  options.quiet = true;
  options.overrides = {"camera.position=" + numbers(place.x, place.y, place.z + 5.0 * place.size),
                       "camera.look_at=" + numbers(place.x, place.y, place.z), "environment.radiance=[1.0, 1.0, 1.0]"};
  options.overrides.insert(options.overrides.end(), more_overrides.begin(), more_overrides.end());
  if (run_render(options) != ExitCode::done) throw std::runtime_error("the picture was not finished");
  return read_exr(options.output);
}

} // namespace pointgi::test
