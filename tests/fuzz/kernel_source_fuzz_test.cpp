/// Memory that ends while a text is put together: it is whole, or there is none. Streams take the end of memory for the
/// end of what they read.
#include "host/cl/kernel_source.h"
#include "tests/fuzz/allocations.h"
#include <catch2/catch.hpp>
#include <new>

using namespace pointgi;
using namespace pointgi::test;

TEST_CASE("kernel sources are whole whichever allocation is refused") {
  const std::string file = "test/probe.cl", whole = kernel_source(file);
  std::size_t refused = 0, halves = 0;
  for (std::size_t number = 1;; ++number) {
    std::string text;
    refuse_allocation(number);
    try {
      text = kernel_source(file);
      refuse_allocation(0);
    } catch (const std::bad_alloc&) {
      ++refused;
      continue;
    }
    if (text == whole) break; // fewer allocations are made
    ++halves;
  }
  CHECK(refused > 100);
  CHECK(halves == 0);
}
