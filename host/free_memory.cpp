#include "host/free_memory.h"
#include <fstream>
#include <string>

namespace pointgi {

std::optional<std::uint64_t> free_memory() {
  std::ifstream file("/proc/meminfo");
  std::string key, unit;
  for (std::uint64_t kilobytes = 0; file >> key >> kilobytes; std::getline(file, unit))
    if (key == "MemAvailable:") return 1024 * kilobytes;
  return std::nullopt;
}

} // namespace pointgi
