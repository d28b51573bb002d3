#pragma once
/// How much may be kept between runs.
#include <cstdint>
#include <string>

namespace pointgi {

/// Bytes that all compiled programs and V-maps together may take: POINTGI_CACHE_BYTES, else 2 GiB. Throws Error(usage)
/// where that is no number.
std::uint64_t most_cache_bytes();

/// Of files that are kept, the one that was used last is removed last.
void mark_as_used(const std::string& path);

/// Removes the compiled programs and V-maps below `folder` (cache_folder()) that were not used for the longest time,
/// until at most `most` bytes are left of them. Other files stay, and are not counted. A file that cannot be removed is
/// left alone: another process may have been faster.
void bound_cache(const std::string& folder, std::uint64_t most);

} // namespace pointgi
