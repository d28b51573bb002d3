#pragma once
/// Parts of scenes as text, and their picture by path tracing.
#include "tests/support/number.h"
#include "tests/support/render.h"

namespace pointgi::test {

inline std::string grey(double value) {
  return "[" + number(value) + ", " + number(value) + ", " + number(value) + "]";
}

inline std::string head(const std::string& position, const std::string& look_at, double fov, int spp,
                        const std::string& size = "[24, 24]") {
  return "version = 1\n[render]\nsize = " + size + "\nspp = " + std::to_string(spp) + "\n[camera]\nposition = [" +
         position + "]\nlook_at = [" + look_at + "]\nfov_deg = " + number(fov) + "\n";
}

inline std::string environment(double radiance) {
  return "[environment]\nradiance = " + grey(radiance) + "\n";
}

inline std::string material(const std::string& name, const std::string& type, const std::string& more = "") {
  return "[[material]]\nname = \"" + name + "\"\ntype = \"" + type + "\"\n" + more + "\n";
}

/// Shines with that radiance and reflects nothing.
inline std::string lamp(const std::string& name, double radiance) {
  return material(name, "diffuse", "albedo = [0.0, 0.0, 0.0]\nemission = " + grey(radiance));
}

inline std::string quad(const std::string& corner, const std::string& u, const std::string& v, const std::string& of,
                        double spacing) {
  return "[[shape]]\ntype = \"quad\"\ncorner = [" + corner + "]\nedge_u = [" + u + "]\nedge_v = [" + v +
         "]\nspacing = " + number(spacing) + "\nmaterial = \"" + of + "\"\n";
}

inline std::string sphere(const std::string& centre, double radius, const std::string& of, double spacing) {
  return "[[shape]]\ntype = \"sphere\"\ncentre = [" + centre + "]\nradius = " + number(radius) +
         "\nspacing = " + number(spacing) + "\nmaterial = \"" + of + "\"\n";
}

inline std::string box(const std::string& low, const std::string& high, const std::string& of, double spacing,
                       bool inward = false) {
  return "[[shape]]\ntype = \"box\"\nmin = [" + low + "]\nmax = [" + high + "]\nspacing = " + number(spacing) +
         "\nmaterial = \"" + of + "\"\n" + (inward ? "inward = true\n" : "");
}

inline Picture trace(const std::string& scene, const std::string& paths = "", int spp = 0) {
  return render_text(scene, [&](RenderOptions& options) {
    options.integrator = "path";
    options.paths = paths;
    if (spp > 0) options.spp = spp;
  });
}

} // namespace pointgi::test
