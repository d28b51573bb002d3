#pragma once
/// What the machine's memory has left, and what this process has of it.
#include <cstdint>
#include <optional>

namespace pointgi {

/// Bytes that the program can still take without swapping: MemAvailable of Linux, or less where a control group allows
/// less; absent: not known.
std::optional<std::uint64_t> available_memory();

/// Most that this process has held in memory until now, bytes; 0 where the system does not tell.
std::uint64_t process_peak_bytes();

/// Gives what the program has freed back to the system, where the C library would keep it: threads have heaps of their
/// own.
void release_freed_memory();

} // namespace pointgi
