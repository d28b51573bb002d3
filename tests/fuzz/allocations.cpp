#include "tests/fuzz/allocations.h"
#include <atomic>
#include <cstdlib>
#include <malloc.h>
#include <new>

namespace {

std::atomic<std::size_t> taken{0}, peak{0}, until_refused{0};

/// Whether this allocation is the one that is refused.
bool is_refused() {
  std::size_t left = until_refused;
  while (left > 0 && !until_refused.compare_exchange_weak(left, left - 1)) {
  }
  return left == 1;
}

void* note(void* block) {
  if (block == nullptr || is_refused()) {
    std::free(block);
    throw std::bad_alloc();
  }
  const std::size_t now = taken += malloc_usable_size(block);
  std::size_t before = peak;
  while (now > before && !peak.compare_exchange_weak(before, now)) {
  }
  return block;
}

void give_back(void* block) {
  if (block == nullptr) return;
  taken -= malloc_usable_size(block);
  std::free(block);
}

} // namespace

// The other forms call these.
void* operator new(std::size_t bytes) {
  return note(std::malloc(bytes == 0 ? 1 : bytes));
}
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  const auto step = static_cast<std::size_t>(alignment);
  return note(std::aligned_alloc(step, (bytes + step - 1) / step * step));
}
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
  try {
    return operator new(bytes);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
void operator delete(void* block) noexcept {
  give_back(block);
}
void operator delete(void* block, std::size_t) noexcept {
  give_back(block);
}
void operator delete(void* block, std::align_val_t) noexcept {
  give_back(block);
}
void operator delete(void* block, std::size_t, std::align_val_t) noexcept {
  give_back(block);
}

namespace pointgi::test {

std::size_t allocated_bytes() {
  return taken;
}
std::size_t peak_bytes() {
  return peak;
}
void refuse_allocation(std::size_t number) {
  until_refused = number;
}
void reset_peak() {
  peak = taken.load();
}

} // namespace pointgi::test
