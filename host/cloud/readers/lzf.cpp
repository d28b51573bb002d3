#include "host/cloud/readers/lzf.h"
#include <cstring>

namespace pointgi {

std::size_t decompress_lzf(const char* from, std::size_t size, char* to, std::size_t expected) {
  const auto byte = [from](std::size_t at) { return static_cast<std::size_t>(static_cast<unsigned char>(from[at])); };
  std::size_t in = 0, out = 0;
  while (in < size) {
    const std::size_t token = in, control = byte(in++);
    if (control < 32) { // that many bytes and one more, as they are
      const std::size_t length = control + 1;
      if (length > size - in || length > expected - out) return token;
      std::memcpy(to + out, from + in, length);
      in += length;
      out += length;
      continue;
    }
    std::size_t length = (control >> 5) + 2; // bytes that were there before
    if (length == 9) {
      if (in == size) return token;
      length += byte(in++);
    }
    if (in == size) return token;
    const std::size_t back = ((control & 31) << 8 | byte(in++)) + 1;
    if (back > out || length > expected - out) return token;
    for (std::size_t i = 0; i < length; ++i, ++out) // one at a time: what is copied may be part of its own source
      to[out] = to[out - back];
  }
  return out == expected ? size : size + 1;
}

} // namespace pointgi
