#include "host/cl/binary_cache.h"
#include "host/atomic_file.h"
#include "host/error.h"
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace pointgi {

namespace {

constexpr char magic[8] = {'p', 'g', 'i', 'k', 'b', 'i', 'n', '1'};

std::string file_of(const std::string& key) {
  const std::string folder = cache_folder();
  if (folder.empty()) return {};
  char name[32];
  std::snprintf(name, sizeof name, "/%016llx.bin", static_cast<unsigned long long>(fnv1a(key)));
  return folder + "/kernels" + name;
}

bool write_all(int fd, const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = ::write(fd, at, size);
    if (written <= 0) return false;
    at += written;
    size -= static_cast<std::size_t>(written);
  }
  return true;
}

} // namespace

std::uint64_t fnv1a(const std::string& text, std::uint64_t seed) {
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
  if (const std::string own = variable("POINTGI_CACHE_DIR"); !own.empty()) return own;
  if (const std::string xdg = variable("XDG_CACHE_HOME"); !xdg.empty()) return xdg + "/pointgi";
  if (const std::string home = variable("HOME"); !home.empty()) return home + "/.cache/pointgi";
  return {};
}

// File: magic, 64-bit key size, key, binary up to the end.
std::optional<std::vector<unsigned char>> load_binary(const std::string& key) {
  std::ifstream file(file_of(key), std::ios::binary);
  char found_magic[sizeof magic];
  std::uint64_t key_size = 0;
  if (!file.read(found_magic, sizeof found_magic) || std::memcmp(found_magic, magic, sizeof magic) != 0 ||
      !file.read(reinterpret_cast<char*>(&key_size), sizeof key_size) || key_size != key.size())
    return std::nullopt;
  std::string found_key(key.size(), '\0');
  if (!file.read(found_key.data(), static_cast<std::streamsize>(key.size())) || found_key != key) return std::nullopt;
  std::vector<unsigned char> binary((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  if (binary.empty()) return std::nullopt;
  return binary;
}

void store_binary(const std::string& key, const std::vector<unsigned char>& binary) {
  const std::string path = file_of(key);
  if (path.empty()) return;
  std::error_code ignored;
  std::filesystem::create_directories(std::filesystem::path(path).parent_path(), ignored);
  try {
    AtomicFile file(path);
    const std::uint64_t key_size = key.size();
    if (write_all(file.fd(), magic, sizeof magic) && write_all(file.fd(), &key_size, sizeof key_size) &&
        write_all(file.fd(), key.data(), key.size()) && write_all(file.fd(), binary.data(), binary.size()))
      file.commit();
  } catch (const Error&) {
    // Documented: without a cache the next start builds again.
  }
}

} // namespace pointgi
