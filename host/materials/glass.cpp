/// Smooth glass: the normals of its splats point out of it.
#include "host/materials/material_kind.h"

namespace pointgi {

namespace {

void load(const TableReader& table, MaterialSettings& material) {
  material.flags |= MATERIAL_SPECULAR | MATERIAL_TRANSMITS;
  material.specular = Vector3d::Ones();
  if (const auto ior = table.number("ior", limits::ior)) material.ior = *ior;
  if (const auto absorption = table.vector3("absorption", limits::absorption)) material.absorption = *absorption;
}

} // namespace

extern const MaterialKind glass_kind;
const MaterialKind glass_kind{{"ior", "absorption"}, load};

} // namespace pointgi
