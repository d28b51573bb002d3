#pragma once
/// What the machine's memory has left.
#include <cstdint>
#include <optional>

namespace pointgi {

/// Bytes that programs can still take without swapping: MemAvailable of Linux; absent: not known.
std::optional<std::uint64_t> free_memory();

} // namespace pointgi
