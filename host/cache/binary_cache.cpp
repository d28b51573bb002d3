#include "host/cache/binary_cache.h"
#include "host/atomic_file.h"
#include "host/cache/cache_bound.h"
#include "host/error.h"
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace pointgi {

namespace {

constexpr char magic[8] = {'p', 'g', 'i', 'k', 'b', 'i', 'n', '2'};

struct Header {
  char magic_word[8];
  std::uint64_t key_size;
  std::uint64_t binary_size;
  std::uint64_t binary_hash; ///< drivers crash on a binary that was cut short
};

std::uint64_t hash_of(const std::vector<unsigned char>& binary) {
  return fnv1a(std::string_view(reinterpret_cast<const char*>(binary.data()), binary.size()));
}

std::string file_of(const std::string& key) {
  const std::string folder = cache_folder();
  if (folder.empty()) return {};
  char name[32];
  std::snprintf(name, sizeof name, "/%016llx.bin", static_cast<unsigned long long>(fnv1a(key)));
  return folder + "/kernels" + name;
}

} // namespace

std::uint64_t fnv1a(std::string_view text, std::uint64_t seed) {
  std::uint64_t hash = seed;
  for (const unsigned char c : text)
    hash = (hash ^ c) * 0x100000001b3ull;
  return hash;
}

std::string cache_folder() {
  const auto variable = [](const char* name) -> std::string {
    const char* value = std::getenv(name);
    return value != nullptr ? value : "";
  };
  if (std::string own = variable("POINTGI_CACHE_DIR"); !own.empty()) return own;
  if (const std::string xdg = variable("XDG_CACHE_HOME"); !xdg.empty()) return xdg + "/pointgi";
  if (const std::string home = variable("HOME"); !home.empty()) return home + "/.cache/pointgi";
  return {};
}

// File: header, key, binary.
std::optional<std::vector<unsigned char>> load_binary(const std::string& key) {
  const std::string path = file_of(key);
  std::ifstream file(path, std::ios::binary);
  Header header{};
  if (!file.read(reinterpret_cast<char*>(&header), sizeof header) ||
      std::memcmp(header.magic_word, magic, sizeof magic) != 0 || header.key_size != key.size())
    return std::nullopt;
  std::string found_key(key.size(), '\0');
  if (!file.read(found_key.data(), static_cast<std::streamsize>(key.size())) || found_key != key) return std::nullopt;
  // Before anything is allocated: sizes of a damaged file may be any number.
  std::error_code failed;
  const std::uint64_t size = std::filesystem::file_size(path, failed), before = sizeof header + key.size();
  if (failed || size <= before || header.binary_size != size - before) return std::nullopt;
  std::vector<unsigned char> binary(static_cast<std::size_t>(header.binary_size));
  if (!file.read(reinterpret_cast<char*>(binary.data()), static_cast<std::streamsize>(binary.size())) ||
      hash_of(binary) != header.binary_hash)
    return std::nullopt;
  mark_as_used(path);
  return binary;
}

void store_binary(const std::string& key, const std::vector<unsigned char>& binary) {
  const std::string path = file_of(key);
  if (path.empty()) return;
  std::error_code ignored;
  std::filesystem::create_directories(std::filesystem::path(path).parent_path(), ignored);
  try {
    Header header{{}, key.size(), binary.size(), hash_of(binary)};
    std::memcpy(header.magic_word, magic, sizeof magic);
    AtomicFile file(path);
    file.write(&header, sizeof header);
    file.write(key.data(), key.size());
    file.write(binary.data(), binary.size());
    file.commit();
  } catch (const Error&) {
    // Documented: without a cache the next start builds again.
  }
  bound_cache(cache_folder(), most_cache_bytes());
}

} // namespace pointgi
