#pragma once
/// How much memory a piece of code takes through operator new, which tests/fuzz/allocations.cpp replaces.
#include <cstddef>

namespace pointgi::test {

/// Bytes that are taken now, of all threads.
std::size_t allocated_bytes();
/// The most that were taken at once since reset_peak().
std::size_t peak_bytes();
void reset_peak();

} // namespace pointgi::test
