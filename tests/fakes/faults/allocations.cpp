/// Memory that the program asks for: operator new, malloc, calloc and aligned_alloc. What drivers and their compilers
/// ask for is let be: they end the process where they get none.
#include "tests/fakes/faults/fault.h"
#include <cstdlib>
#include <mutex>
#include <new>
#include <unordered_map>

extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);
}

namespace {

template <typename T>
struct RawAllocator {
  using value_type = T;
  RawAllocator() = default;
  template <typename U>
  RawAllocator(const RawAllocator<U>&) {} // NOLINT: implicit, as the standard asks of allocators
  T* allocate(std::size_t n) { return static_cast<T*>(__libc_malloc(n * sizeof(T))); }
  void deallocate(T* memory, std::size_t) { __libc_free(memory); }
  template <typename U>
  bool operator==(const RawAllocator<U>&) const {
    return true;
  }
  template <typename U>
  bool operator!=(const RawAllocator<U>&) const {
    return false;
  }
};

/// Blocks of the program that were not given back, by their addresses.
struct Shard {
  std::mutex mutex;
  std::unordered_map<const void*, std::uint64_t, std::hash<const void*>, std::equal_to<const void*>,
                     RawAllocator<std::pair<const void* const, std::uint64_t>>>
      blocks;
};
constexpr std::size_t shards = 64;

Shard& shard_of(const void* block) {
  static Shard* const all = [] { // never destroyed: the last blocks come back after this library's end
    void* const memory = __libc_malloc(sizeof(Shard) * shards);
    return new (memory) Shard[shards];
  }();
  return all[(reinterpret_cast<std::uintptr_t>(block) >> 4) % shards];
}

faults::Call call("allocation");

/// Whether an allocation of this caller is to fail; `place` is 0 where it is none of the program's.
bool strikes(const void* return_address, std::uint64_t& place) {
  place = 0;
  if (!faults::is_running() || !faults::may_be_of_program(return_address)) return false;
  if (!faults::called_by_program(&place)) return false;
  ++call.count;
  return faults::allocation_strikes(place);
}

void* kept(void* block, std::uint64_t place) {
  if (block == nullptr || place == 0) return block;
  Shard& shard = shard_of(block);
  const std::lock_guard<std::mutex> lock(shard.mutex);
  shard.blocks.emplace(block, place);
  ++call.live;
  return block;
}

void give_back(void* block) {
  if (block == nullptr) return;
  {
    Shard& shard = shard_of(block);
    const std::lock_guard<std::mutex> lock(shard.mutex);
    if (shard.blocks.erase(block) > 0) --call.live;
  }
  __libc_free(block);
}

void* taken(const void* return_address, std::size_t bytes, std::size_t alignment) {
  std::uint64_t place = 0;
  if (strikes(return_address, place)) return nullptr;
  bytes = bytes == 0 ? 1 : bytes;
  return kept(alignment == 0 ? __libc_malloc(bytes) : __libc_memalign(alignment, bytes), place);
}

} // namespace

#define CALLER __builtin_return_address(0)

// The other forms call these.
void* operator new(std::size_t bytes) {
  if (void* const block = taken(CALLER, bytes, 0)) return block;
  throw std::bad_alloc();
}
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  if (void* const block = taken(CALLER, bytes, static_cast<std::size_t>(alignment))) return block;
  throw std::bad_alloc();
}
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
  return taken(CALLER, bytes, 0);
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

extern "C" {
void* malloc(std::size_t bytes) noexcept {
  return faults::is_in_program(CALLER) ? taken(CALLER, bytes, 0) : __libc_malloc(bytes);
}
void* calloc(std::size_t count, std::size_t bytes) noexcept {
  std::uint64_t place = 0;
  if (faults::is_in_program(CALLER) && strikes(CALLER, place)) return nullptr;
  return kept(__libc_calloc(count, bytes), place);
}
void* aligned_alloc(std::size_t alignment, std::size_t bytes) noexcept {
  return faults::is_in_program(CALLER) ? taken(CALLER, bytes, alignment) : __libc_memalign(alignment, bytes);
}
void free(void* block) noexcept {
  if (faults::is_in_program(CALLER))
    give_back(block);
  else
    __libc_free(block);
}
}
