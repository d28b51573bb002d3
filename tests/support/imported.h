#pragma once
/// Scans that the program does not read itself, by way of scripts/import.
#include "tests/support/temporary_folder.h"
#include <cstdlib>
#include <string>
#include <sys/wait.h>

namespace pointgi::test {

/// Whether scripts/import has its Python environment already: tests don't ask the network for it.
inline bool import_is_installed() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  const std::string folder = cache != nullptr && *cache != '\0' ? cache : std::string(home ? home : "") + "/.cache";
  const std::string installed = folder + "/pointgi/import/installed.txt";
  const std::string wanted = POINTGI_SOURCE_DIR "/scripts/import_scan/requirements.txt";
  return std::filesystem::exists(installed) && contents(installed) == contents(wanted);
}

struct ImportRun {
  int code;
  std::string ply; ///< path of what it wrote
  std::string err;
};

inline ImportRun run_import(const std::string& scan, const TemporaryFolder& folder) {
  ImportRun run{0, folder.file("imported.ply"), ""};
  const std::string err = folder.file("import.err");
  const std::string command =
      POINTGI_SOURCE_DIR "/scripts/import '" + scan + "' '" + run.ply + "' 2>'" + err + "' </dev/null";
  const int status = std::system(command.c_str());
  run.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  run.err = contents(err);
  return run;
}

} // namespace pointgi::test
