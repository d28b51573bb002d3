#pragma once
/// What the machine's memory has left.
#include <cstdint>
#include <optional>

namespace pointgi {

/// Bytes that the program can still take without swapping: MemAvailable of Linux, or less where a control group allows
/// less; absent: not known.
std::optional<std::uint64_t> available_memory();

} // namespace pointgi
