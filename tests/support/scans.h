#pragma once
/// Real scans lie beside the project, not in it: tests use them where they are.
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace pointgi::test {

/// Set when a case had to be skipped: the program then returns what CTest calls "skipped".
inline bool something_skipped = false;

/// The path of a scan, or nothing: then the test says that it was skipped.
inline std::optional<std::string> scan_path(const std::string& name) {
  const char* folder = std::getenv("POINTGI_SCANS");
  const std::filesystem::path path =
      std::filesystem::path(folder != nullptr ? folder : POINTGI_SOURCE_DIR "/../shared/scans") / name;
  if (std::filesystem::exists(path)) return path.string();
  something_skipped = true;
  return std::nullopt;
}

} // namespace pointgi::test
