/// Smooth mirrors of one reflectance at every angle.
#include "host/materials/material_kind.h"

namespace pointgi {

namespace {

void load(const TableReader& table, MaterialSettings& material) {
  material.flags |= MATERIAL_SPECULAR;
  material.specular = table.vector3("reflectance", limits::reflectance).value_or(Vector3d::Ones());
}

} // namespace

extern const MaterialKind mirror_kind;
const MaterialKind mirror_kind{{"reflectance"}, load};

} // namespace pointgi
