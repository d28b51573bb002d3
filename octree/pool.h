#pragma once
/// A vector for large arrays of plain data that many threads fill at once.
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>
#ifdef __linux__
#include <sys/mman.h>
#endif

namespace pointgi {

/// Leaves new items unwritten, so that the threads that fill a pool are the first to touch its pages and nothing is
/// written twice, and asks for huge pages: with 4 KiB ones the page faults of fresh memory cost as much as building.
template <class T>
struct PoolAllocator {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_default_constructible_v<T>,
                "a pool holds plain data");
  using value_type = T;

  PoolAllocator() = default;
  template <class U>
  PoolAllocator(const PoolAllocator<U>&) {} // NOLINT: implicit, as the standard asks of allocators

  T* allocate(std::size_t count) {
    constexpr std::size_t huge_page = std::size_t{1} << 21, small_alignment = 64;
    if (count > (std::size_t{1} << 62) / sizeof(T)) throw std::bad_alloc();
    const std::size_t alignment = count * sizeof(T) < 2 * huge_page ? small_alignment : huge_page;
    const std::size_t bytes = (count * sizeof(T) + alignment - 1) / alignment * alignment;
    void* memory = std::aligned_alloc(alignment, bytes);
    if (memory == nullptr) throw std::bad_alloc();
#ifdef __linux__
    if (alignment == huge_page) madvise(memory, bytes, MADV_HUGEPAGE); // only advice: without it all works, slower
#endif
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t) {
    std::free(memory);
  }

  template <class U>
  void construct(U* at) {
    ::new (static_cast<void*>(at)) U;
  }
  template <class U, class... Args>
  void construct(U* at, Args&&... args) {
    ::new (static_cast<void*>(at)) U(std::forward<Args>(args)...);
  }

  friend bool operator==(const PoolAllocator&, const PoolAllocator&) {
    return true;
  }
  friend bool operator!=(const PoolAllocator&, const PoolAllocator&) {
    return false;
  }
};

/// resize() and Pool(n) leave new items unwritten; resize(n, value) writes them.
template <class T>
using Pool = std::vector<T, PoolAllocator<T>>;

} // namespace pointgi
