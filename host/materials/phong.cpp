/// Diffuse surfaces with a specular lobe.
#include "host/materials/material_kind.h"

namespace pointgi {

namespace {

/// What a surface gives back of the light that meets it, diffusely and specularly together, is at most all of it.
void check_energy(const TableReader& table, const MaterialSettings& material) {
  constexpr double rounding = 1e-9; // 0.7 + 0.3 written in decimals must pass
  if (!material.albedo) return;
  const double most = (*material.albedo + material.specular).maxCoeff();
  if (most > 1.0 + rounding)
    table.fail("specular", "albedo + specular is above 1 in a channel, expected at most 1 (above 1 it would create "
                           "energy)");
}

void load(const TableReader& table, MaterialSettings& material) {
  load_diffuse_keys(table, material);
  material.flags |= MATERIAL_SPECULAR | MATERIAL_HAS_LOBE;
  if (const auto specular = table.vector3("specular", limits::reflectance)) material.specular = *specular;
  if (const auto exponent = table.number("exponent", limits::exponent)) material.exponent = *exponent;
  check_energy(table, material);
}

} // namespace

extern const MaterialKind phong_kind;
const MaterialKind phong_kind{joined(diffuse_keys(), {"specular", "exponent"}), load};

} // namespace pointgi
