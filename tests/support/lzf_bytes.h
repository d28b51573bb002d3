#pragma once
/// LZF compression as a test needs it: correct, with both kinds of token and long copies; slow and simple.
#include <algorithm>
#include <string>

namespace pointgi::test {

inline std::string lzf_compressed(const std::string& bytes) {
  std::string result, literal;
  const auto flush = [&] {
    for (std::size_t at = 0; at < literal.size(); at += 32) {
      const std::string part = literal.substr(at, 32);
      result += static_cast<char>(part.size() - 1);
      result += part;
    }
    literal.clear();
  };
  for (std::size_t at = 0; at < bytes.size();) {
    // The longest run that stood up to 64 bytes before (short distances overlap their own copy), or one of the
    // farthest.
    std::size_t best = 0, back = 0;
    for (std::size_t distance = 1; distance <= std::min<std::size_t>(at, 8192); distance += distance < 64 ? 1 : 1016) {
      std::size_t length = 0;
      while (length < 264 && at + length < bytes.size() && bytes[at + length] == bytes[at + length - distance])
        ++length;
      if (length > best) {
        best = length;
        back = distance;
      }
    }
    if (best < 3) {
      literal += bytes[at++];
      continue;
    }
    flush();
    const std::size_t code = best - 2, offset = back - 1;
    result += static_cast<char>(std::min<std::size_t>(code, 7) << 5 | offset >> 8);
    if (code >= 7) result += static_cast<char>(code - 7);
    result += static_cast<char>(offset & 255);
    at += best;
  }
  flush();
  return result;
}

} // namespace pointgi::test
