#pragma once
/// How much memory a piece of code takes through operator new, which tests/fuzz/allocations.cpp replaces.
#include <cstddef>

namespace pointgi::test {

/// Bytes that are taken now, of all threads.
std::size_t allocated_bytes();
/// Of the allocations from now on the one of this number, from 1, throws std::bad_alloc. 0: none does.
void refuse_allocation(std::size_t number);
/// The most that were taken at once since reset_peak().
std::size_t peak_bytes();
void reset_peak();

} // namespace pointgi::test
