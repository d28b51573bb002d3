#pragma once
/// Unpacks gzip data piece by piece, never more than is asked for.
#include <cstddef>
#include <memory>
#include <string>

namespace pointgi {

class Gunzip {
public:
  /// `data` must live as long as this. Throws Error(input) unless it begins as gzip data do.
  Gunzip(const char* data, std::size_t size, const std::string& file);
  ~Gunzip();

  /// Throws Error(input) when the packed data can't hold `bytes` more bytes: deflate packs 1032 to one at best.
  void expect(std::size_t bytes) const;
  /// The next `bytes` bytes. Throws Error(input) with the byte of the unpacked data when they are damaged or missing.
  void read(unsigned char* to, std::size_t bytes);
  void skip(std::size_t bytes);
  /// Checks that nothing follows, and the sum of all that was read. Throws Error(input).
  void finish();

  static bool is_gzip(const char* data, std::size_t size);
  /// The first `bytes` bytes of packed data that may be cut off; false where they are not to be had.
  static bool peek(const char* data, std::size_t size, unsigned char* to, std::size_t bytes);

private:
  [[noreturn]] void fail(const std::string& what) const;
  [[noreturn]] void fail_unpacking(int result) const;
  struct Stream;
  std::unique_ptr<Stream> stream_;
  std::string file_;
  std::size_t packed_bytes_;
  std::size_t done_ = 0; ///< unpacked bytes that were read
  bool ended_ = false;
};

} // namespace pointgi
