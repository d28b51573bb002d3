/// Point lights: `position`, `power_w`; the same intensity in every direction.
#include "host/lights/light_kind.h"

namespace pointgi {

namespace {

void load(const TableReader& table, const LightContext&, LightSettings& light) {
  light.vector = table.need_vector3("position", limits::coordinate);
  light.strength = table.need_vector3("power_w", limits::light) / (4.0 * 3.14159265358979323846);
}

} // namespace

extern const LightKind point_kind;
const LightKind point_kind{{"position", "power_w"}, load, false};

} // namespace pointgi
