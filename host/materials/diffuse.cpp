/// Diffuse surfaces: `albedo` or the points' colours, `emission`.
#include "host/materials/material_kind.h"

namespace pointgi {

extern const MaterialKind diffuse_kind;
const MaterialKind diffuse_kind{diffuse_keys(), load_diffuse_keys};

} // namespace pointgi
