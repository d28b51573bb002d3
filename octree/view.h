#pragma once
/// Pointer and size: how layers hand arrays to each other without copying or owning.
#include <cstddef>
#include <vector>

namespace pointgi {

template <typename T>
struct View {
  const T* data = nullptr;
  std::size_t size = 0;

  View() = default;
  View(const T* d, std::size_t n) : data(d), size(n) {}
  template <class Allocator>
  View(const std::vector<T, Allocator>& v) : data(v.data()), size(v.size()) {} // NOLINT: implicit on purpose

  const T& operator[](std::size_t i) const { return data[i]; }
  const T* begin() const { return data; }
  const T* end() const { return data + size; }
};

} // namespace pointgi
