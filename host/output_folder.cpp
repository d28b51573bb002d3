#include "host/output_folder.h"
#include "host/atomic_file.h"
#include <filesystem>

namespace pointgi {

std::string file_in(const std::string& folder, const std::string& name) {
  return (std::filesystem::path(folder) / name).string();
}

void make_folder(const std::string& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) throw output_error(folder, "create the folder", failed.value());
}

void require_writable(const std::string& folder, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const std::string path = file_in(folder, name);
    make_folder(std::filesystem::path(path).parent_path().string());
    const AtomicFile probe(path);
  }
}

} // namespace pointgi
