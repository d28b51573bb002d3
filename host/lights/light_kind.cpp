#include "host/lights/light_kind.h"
#include <fmt/format.h>

namespace pointgi {

// A kind's file defines `NAME_kind`.
#define DECLARE_KIND(ID, name) extern const LightKind name##_kind;
LIGHT_KINDS(DECLARE_KIND)
#undef DECLARE_KIND

const LightKind& kind_of(LightType type) {
#define KIND(ID, name) &name##_kind,
  static const LightKind* const kinds[] = {LIGHT_KINDS(KIND)};
#undef KIND
  return *kinds[static_cast<std::size_t>(type)];
}

const std::vector<LightType>& light_types() {
#define TYPE(ID, name) LightType::name,
  static const std::vector<LightType> all{LIGHT_KINDS(TYPE)};
#undef TYPE
  return all;
}

const char* name_of(LightType type) {
#define NAME(ID, name) #name,
  static constexpr const char* names[] = {LIGHT_KINDS(NAME)};
#undef NAME
  return names[static_cast<std::size_t>(type)];
}

std::string description_of(const LightSettings& light) {
  const Vector3d v = light.is_far ? -light.vector : light.vector;
  const std::string text = fmt::format("[{:.4g}, {:.4g}, {:.4g}]", v.x(), v.y(), v.z());
  return std::string("the ") + name_of(light.type) + " light " +
         (light.is_far ? "of direction " + text + " (the way that its light travels)" : "at " + text);
}

} // namespace pointgi
