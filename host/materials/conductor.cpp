/// Metals: `metal` or `reflectance`, and `roughness`.
#include "host/materials/material_kind.h"
#include <algorithm>
#include <complex>

namespace pointgi {

namespace {

/// Complex indices of refraction for red, green and blue, about 630, 532 and 465 nm.
struct Metal {
  const char* name;
  double eta[3], extinction[3];
};

/// Gold, copper and silver: Johnson and Christy, "Optical Constants of the Noble Metals", Phys. Rev. B 6 (1972), in
/// their usual weighting by the CIE observer; aluminium: Rakic, Applied Optics 34 (1995); iron: Johnson and Christy,
/// Phys. Rev. B 9 (1974).
constexpr Metal metals[] = {
    {"gold", {0.1431, 0.3749, 1.4424}, {3.9831, 2.3857, 1.6032}},
    {"copper", {0.2004, 0.9240, 1.1022}, {3.9129, 2.4528, 2.1421}},
    {"silver", {0.1552, 0.1167, 0.1383}, {4.8283, 3.1222, 2.1470}},
    {"aluminium", {1.3456, 0.9654, 0.6172}, {7.4746, 6.3995, 5.3031}},
    {"iron", {2.9114, 2.9497, 2.5845}, {3.0893, 2.9318, 2.7670}},
};

/// Below this width a float cannot tell the microfacets' normals apart: the surface is smooth.
constexpr double smallest_alpha = 1e-4;

std::vector<std::string> metal_names() {
  std::vector<std::string> names;
  for (const Metal& metal : metals)
    names.push_back(metal.name);
  return names;
}

/// Share of light that is reflected at normal incidence, |(n - 1) / (n + 1)|^2.
double normal_reflectance(double eta, double extinction) {
  const std::complex<double> n(eta, extinction);
  return std::norm((n - 1.0) / (n + 1.0));
}

void load(const TableReader& table, MaterialSettings& material) {
  material.flags |= MATERIAL_SPECULAR;
  const auto reflectance = table.vector3("reflectance", limits::reflectance);
  const auto metal = table.choice("metal", metal_names());
  if (reflectance && metal)
    table.fail("metal", "expected one of metal and reflectance, found both; remove one of the two");
  if (!reflectance && !metal)
    table.fail("metal = \"gold\" or reflectance = [r, g, b] is missing; a conductor needs one of the two");
  if (reflectance) material.specular = *reflectance;
  for (const Metal& known : metals)
    for (int k = 0; metal && *metal == known.name && k < 3; ++k) {
      material.eta[k] = known.eta[k];
      material.extinction[k] = known.extinction[k];
      material.specular[k] = normal_reflectance(known.eta[k], known.extinction[k]);
    }
  const double roughness = table.number("roughness", limits::roughness).value_or(0.0);
  const double alpha = roughness * roughness;
  material.alpha = alpha < smallest_alpha ? 0.0 : alpha;
  if (material.alpha > 0.0) material.flags |= MATERIAL_HAS_LOBE;
}

} // namespace

extern const MaterialKind conductor_kind;
const MaterialKind conductor_kind{{"metal", "reflectance", "roughness"}, load};

} // namespace pointgi
