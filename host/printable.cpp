#include "host/printable.h"

namespace pointgi {

std::string printable(std::string_view text, std::size_t max_bytes) {
  static const char digits[] = "0123456789abcdef";
  std::string out;
  for (const char c : text.substr(0, max_bytes)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte < 0x7f && c != '"' && c != '\\') {
      out += c;
    } else {
      out += "\\x";
      out += digits[byte >> 4];
      out += digits[byte & 15];
    }
  }
  if (text.size() > max_bytes) out += "...";
  return out;
}

std::string quoted_bytes(std::string_view text, std::size_t max_bytes) {
  return '"' + printable(text, max_bytes) + '"';
}

} // namespace pointgi
