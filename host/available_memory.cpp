#include "host/available_memory.h"
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string>
#include <sys/resource.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace pointgi {

namespace {

std::optional<std::uint64_t> number_in(const char* path) {
  std::ifstream file(path);
  std::uint64_t number = 0;
  return file >> number ? std::optional(number) : std::nullopt; // "max": no limit
}

std::optional<std::uint64_t> left_of_machine() {
  std::ifstream file("/proc/meminfo");
  std::string key, unit;
  for (std::uint64_t kilobytes = 0; file >> key >> kilobytes; std::getline(file, unit))
    if (key == "MemAvailable:") return 1024 * kilobytes;
  return std::nullopt;
}

/// Pages of files in a group's use, which make room when it is needed.
std::uint64_t file_pages(const char* path, const std::string& prefix) {
  std::ifstream file(path);
  std::uint64_t bytes = 0, number = 0;
  for (std::string key; file >> key >> number;)
    if (key == prefix + "inactive_file" || key == prefix + "active_file") bytes += number;
  return bytes;
}

/// Of a container, by the second version of control groups or by the first.
std::optional<std::uint64_t> left_of_group() {
  constexpr const char* groups[][4] = {
      {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory.current", "/sys/fs/cgroup/memory.stat", ""},
      {"/sys/fs/cgroup/memory/memory.limit_in_bytes", "/sys/fs/cgroup/memory/memory.usage_in_bytes",
       "/sys/fs/cgroup/memory/memory.stat", "total_"}};
  for (const auto& [limit_file, use_file, stat_file, prefix] : groups) {
    const auto limit = number_in(limit_file), use = number_in(use_file);
    if (!limit || !use) continue;
    const std::uint64_t held = *use - std::min(*use, file_pages(stat_file, prefix));
    return *limit - std::min(*limit, held);
  }
  return std::nullopt;
}

} // namespace

std::optional<std::uint64_t> available_memory() {
  const auto machine = left_of_machine(), group = left_of_group();
  if (!machine || !group) return machine ? machine : group;
  return std::min(*machine, *group);
}

std::uint64_t process_peak_bytes() {
  rusage usage{};
  return getrusage(RUSAGE_SELF, &usage) == 0 ? static_cast<std::uint64_t>(usage.ru_maxrss) * 1024u : 0;
}

void release_freed_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

} // namespace pointgi
