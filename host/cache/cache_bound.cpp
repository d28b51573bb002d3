#include "host/cache/cache_bound.h"
#include "host/error.h"
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <vector>

namespace pointgi {

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t default_bytes = std::uint64_t{2} << 30;

struct KeptFile {
  fs::path path;
  fs::file_time_type used;
  std::uint64_t bytes;
};

/// Whether the name is one that we give: 16 hexadecimal digits and the extension.
bool is_ours(const fs::path& path, const char* extension) {
  const std::string stem = path.stem().string();
  return path.extension() == extension && stem.size() == 16 &&
         std::all_of(stem.begin(), stem.end(), [](unsigned char c) { return std::isxdigit(c) && !std::isupper(c); });
}

void add_files(const fs::path& folder, const char* extension, std::vector<KeptFile>& files) {
  std::error_code failed;
  for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed)) {
    std::error_code gone;
    if (at->is_symlink(gone) || !at->is_regular_file(gone) || !is_ours(at->path(), extension)) continue;
    const KeptFile file{at->path(), at->last_write_time(gone), at->file_size(gone)};
    if (!gone) files.push_back(file);
  }
}

} // namespace

std::uint64_t most_cache_bytes() {
  const char* text = std::getenv("POINTGI_CACHE_BYTES");
  if (text == nullptr || *text == '\0') return default_bytes;
  std::uint64_t bytes = 0;
  const char* end = text + std::strlen(text);
  const auto [stopped, error] = std::from_chars(text, end, bytes);
  if (error != std::errc() || stopped != end)
    throw Error(ErrorKind::usage, "POINTGI_CACHE_BYTES=" + std::string(text) +
                                      ": expected a number of bytes, for example 2147483648; correct it, or unset it");
  return bytes;
}

void mark_as_used(const std::string& path) {
  std::error_code ignored; // a folder of somebody else's
  fs::last_write_time(path, fs::file_time_type::clock::now(), ignored);
}

void bound_cache(const std::string& folder, std::uint64_t most) {
  std::vector<KeptFile> files;
  add_files(fs::path(folder) / "kernels", ".bin", files);
  add_files(fs::path(folder) / "vmaps", ".vmap", files);
  std::uint64_t all = 0;
  for (const KeptFile& file : files)
    all += file.bytes;
  std::sort(files.begin(), files.end(), [](const KeptFile& a, const KeptFile& b) { return a.used < b.used; });
  for (const KeptFile& file : files) {
    if (all <= most) break;
    std::error_code ignored;
    if (fs::remove(file.path, ignored)) all -= file.bytes;
  }
}

} // namespace pointgi
