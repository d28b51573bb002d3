#pragma once
/// The kinds of [[light]], as the scene file has them: one file of this folder a kind, one row in
/// kernels/shared/light_kinds.h. How the device samples them stands in kernels/lights.
#include "host/scene/toml_reader.h"
#include <string>
#include <vector>

namespace pointgi {

/// What of the scene a kind may need, and where it says what the user should know.
struct LightContext {
  UpAxis up;
  std::vector<std::string>& warnings;
};

struct LightKind {
  std::vector<std::string> keys; ///< beside `type`
  /// Reads these keys into everything of `light` but its type, place and distance. Throws Error(input).
  void (*load)(const TableReader& table, const LightContext& context, LightSettings& light);
  bool is_far; ///< parallel light from outside the scene
};

/// The row of a kind.
const LightKind& kind_of(LightType type);

/// Every kind, in the order of its number.
const std::vector<LightType>& light_types();

/// "the point light at [0, 1.9, 0]", for messages.
std::string description_of(const LightSettings& light);

} // namespace pointgi
