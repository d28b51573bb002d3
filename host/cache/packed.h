#pragma once
/// Values as bytes and back, for files that only the machine reads that wrote them.
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace pointgi {

class Packer {
public:
  template <typename T>
  Packer& operator<<(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>, "its bytes are the value");
    put(&value, sizeof value);
    return *this;
  }
  template <typename T, typename Allocator>
  Packer& operator<<(const std::vector<T, Allocator>& values) {
    static_assert(std::is_trivially_copyable_v<T>, "their bytes are the values");
    *this << static_cast<std::uint64_t>(values.size());
    put(values.data(), values.size() * sizeof(T));
    return *this;
  }
  Packer& operator<<(const std::string& text) {
    *this << static_cast<std::uint64_t>(text.size());
    put(text.data(), text.size());
    return *this;
  }
  template <typename T>
  Packer& operator<<(const std::vector<std::vector<T>>& lists) {
    *this << static_cast<std::uint64_t>(lists.size());
    for (const std::vector<T>& list : lists)
      *this << list;
    return *this;
  }

  std::string take() { return std::move(bytes_); }

private:
  void put(const void* data, std::size_t bytes) {
    if (bytes != 0) bytes_.append(static_cast<const char*>(data), bytes);
  }

  std::string bytes_;
};

/// Reads what a Packer was given, in the same order. What the bytes do not hold is left alone, and is_whole() is false
/// from then on; nothing is allocated that they cannot fill.
class Unpacker {
public:
  /// Borrows the bytes.
  explicit Unpacker(const std::string& bytes) : bytes_(bytes) {}

  template <typename T>
  Unpacker& operator>>(T& value) {
    static_assert(std::is_trivially_copyable_v<T>, "its bytes are the value");
    get(&value, sizeof value);
    return *this;
  }
  template <typename T, typename Allocator>
  Unpacker& operator>>(std::vector<T, Allocator>& values) {
    static_assert(std::is_trivially_copyable_v<T>, "their bytes are the values");
    const std::uint64_t size = size_of_list(sizeof(T));
    if (!good_) return *this;
    values.resize(size);
    get(values.data(), size * sizeof(T));
    return *this;
  }
  Unpacker& operator>>(std::string& text) {
    const std::uint64_t size = size_of_list(1);
    if (!good_) return *this;
    text.resize(size);
    get(text.data(), size);
    return *this;
  }
  template <typename T>
  Unpacker& operator>>(std::vector<std::vector<T>>& lists) {
    const std::uint64_t size = size_of_list(sizeof(std::uint64_t));
    if (!good_) return *this;
    lists.resize(size);
    for (std::vector<T>& list : lists)
      *this >> list;
    return *this;
  }

  /// Nothing was missing yet: to end a loop by. At the end is_whole() tells.
  bool is_good() const { return good_; }
  /// Everything was there, and nothing is left.
  bool is_whole() const { return good_ && at_ == bytes_.size(); }

private:
  std::uint64_t size_of_list(std::size_t least_bytes) {
    std::uint64_t size = 0;
    *this >> size;
    good_ = good_ && size <= (bytes_.size() - at_) / least_bytes;
    return size;
  }
  void get(void* data, std::size_t bytes) {
    good_ = good_ && bytes <= bytes_.size() - at_;
    if (!good_ || bytes == 0) return;
    std::memcpy(data, bytes_.data() + at_, bytes);
    at_ += bytes;
  }

  const std::string& bytes_;
  std::size_t at_ = 0;
  bool good_ = true;
};

} // namespace pointgi
