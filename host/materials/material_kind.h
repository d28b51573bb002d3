#pragma once
/// The kinds of material, as the scene file has them: one file of this folder a kind, one row in
/// kernels/shared/material_kinds.h. What rays do on them stands in kernels/materials.
#include "host/scene/toml_reader.h"
#include <string>
#include <vector>

namespace pointgi {

struct MaterialKind {
  std::vector<std::string> keys; ///< beside `name` and `type`
  /// Reads these keys and sets the flags (MATERIAL_..., shared/material_kinds.h). `material` has its name, type and
  /// place. Throws Error(input).
  void (*load)(const TableReader& table, MaterialSettings& material);
};

/// The row of a kind.
const MaterialKind& kind_of(MaterialType type);

/// Every kind, in the order of its number.
const std::vector<MaterialType>& material_types();

/// Keys of all kinds that reflect diffusely, and what reads them.
const std::vector<std::string>& diffuse_keys();
void load_diffuse_keys(const TableReader& table, MaterialSettings& material);

/// `first` and `second` in one list.
std::vector<std::string> joined(const std::vector<std::string>& first, const std::vector<std::string>& second);

} // namespace pointgi
