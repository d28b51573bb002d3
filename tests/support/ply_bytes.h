#pragma once
/// Bytes of binary PLY bodies, for tests that need files with exact contents.
#include <algorithm>
#include <cstring>
#include <string>

namespace pointgi::test {

/// The bytes of `value` in little- or big-endian order.
template <class T>
std::string bytes_of(T value, bool big_endian = false) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  const bool host_is_big = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__;
  if (big_endian != host_is_big) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

} // namespace pointgi::test
