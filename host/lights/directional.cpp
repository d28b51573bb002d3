/// Directional lights: `direction`, the way that the light travels, and `irradiance` of a surface that faces it.
#include "host/lights/light_kind.h"

namespace pointgi {

namespace {

void load(const TableReader& table, const LightContext&, LightSettings& light) {
  const Vector3d direction = table.need_vector3("direction", limits::coordinate);
  if (direction.norm() < limits::length.low)
    table.fail("direction", "expected the way the light travels, found a vector of no length");
  light.vector = -direction.normalized();
  light.strength = table.need_vector3("irradiance", limits::light);
}

} // namespace

extern const LightKind directional_kind;
const LightKind directional_kind{{"direction", "irradiance"}, load, true};

} // namespace pointgi
