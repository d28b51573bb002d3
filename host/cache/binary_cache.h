#pragma once
/// Compiled kernels kept between runs.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pointgi {

/// The folder for everything that is kept between runs: POINTGI_CACHE_DIR, else XDG_CACHE_HOME/pointgi, else
/// ~/.cache/pointgi; empty when none can be made (then nothing is kept).
std::string cache_folder();

/// A cached program binary. The file names itself (magic, version, full key); one that does not match is ignored.
std::optional<std::vector<unsigned char>> load_binary(const std::string& key);

/// Keeps a binary; a full disk or a read-only folder only means that nothing is kept.
void store_binary(const std::string& key, const std::vector<unsigned char>& binary);

/// 64-bit FNV-1a, for file names and scene hashes; the full key inside the file decides.
std::uint64_t fnv1a(std::string_view text, std::uint64_t seed = 0xcbf29ce484222325ull);

} // namespace pointgi
