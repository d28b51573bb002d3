#pragma once
/// What a run writes with --stats.
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pointgi::test {

inline nlohmann::json json_of(const std::string& path) {
  std::ifstream file(path);
  return nlohmann::json::parse(file);
}

/// Stages that ran, or that did not.
inline std::vector<std::string> names_of(const nlohmann::json& stages, bool ran) {
  std::vector<std::string> names;
  for (const auto& stage : stages)
    if (stage["ran"] == ran) names.push_back(stage["name"]);
  return names;
}

/// Why a stage did not run; empty when it did.
inline std::string reason_of(const nlohmann::json& stages, const std::string& name) {
  for (const auto& stage : stages)
    if (stage["name"] == name) return stage["reason"];
  return "(no such stage)";
}

} // namespace pointgi::test
