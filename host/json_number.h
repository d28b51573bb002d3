#pragma once
#include <cmath>
#include <nlohmann/json.hpp>

namespace pointgi {

/// JSON has no infinity and no NaN: null.
inline nlohmann::json json_number(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

} // namespace pointgi
