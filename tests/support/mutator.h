#pragma once
/// Damaged files for the readers' fuzz tests.
#include <algorithm>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace pointgi::test {

class Mutator {
public:
  /// Numbers are exchanged in the text before `end_of_header`; empty: anywhere.
  explicit Mutator(std::uint32_t seed, std::string end_of_header = "end_header")
      : random_(seed), end_of_header_(std::move(end_of_header)) {}

  /// One to four changes of the kinds that damage, truncation and malice make.
  std::string operator()(std::string bytes) {
    for (std::uint32_t change = 0, changes = 1 + below(4); change < changes && !bytes.empty(); ++change)
      change_once(bytes);
    return bytes;
  }

private:
  /// Portable, unlike a distribution.
  std::uint32_t below(std::size_t end) { return static_cast<std::uint32_t>(random_() % end); }

  /// One draw a statement: the order in which a call's arguments are evaluated is the compiler's.
  void change_once(std::string& bytes) {
    const std::size_t at = below(bytes.size());
    switch (below(8)) {
    case 0:
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
      break;
    case 1:
      bytes[at] = static_cast<char>(below(256));
      break;
    case 2:
      bytes.resize(at);
      break;
    case 3: {
      const auto character = static_cast<char>(below(256));
      bytes.insert(at, std::string(1 + below(8), character));
      break;
    }
    case 4:
      bytes.erase(at, 1 + below(16));
      break;
    case 5: {
      const std::size_t length = below(64);
      bytes.insert(at, bytes.substr(below(bytes.size()), length));
      break;
    }
    case 6:
      set_number(bytes, at);
      break;
    default:
      swap_number(bytes);
    }
  }

  /// Puts a nasty binary number of 1 to 8 bytes somewhere.
  void set_number(std::string& bytes, std::size_t at) {
    static const std::vector<std::string> nasty{std::string(8, '\0'),
                                                std::string(8, '\xff'),
                                                std::string("\0\0\0\x80\0\0\0\x80", 8),     // the least int
                                                std::string("\xff\xff\xff\x7f\0\0\0\0", 8), // the largest; a NaN
                                                std::string("\0\0\x80\x7f\0\0\xf0\x7f", 8), // infinite
                                                std::string("\0\0\0\0\0\0\0\x80", 8)};
    const std::size_t length = std::min<std::size_t>(std::size_t{1} << below(4), bytes.size() - at);
    bytes.replace(at, length, nasty[below(nasty.size())].substr(0, length));
  }

  /// Puts a nasty number or word in the place of a number or word of the header.
  void swap_number(std::string& bytes) {
    static const std::vector<std::string> nasty{
        "0",     "-1",   "255",  "65536", "2147483648", "4294967297", "18446744073709551615",
        "1e30",  "1,5",  "nan",  "inf",   "1.0",        "vertex",     "face",
        "float", "char", "list", "x",     "",           "\r"};
    const std::size_t header =
        end_of_header_.empty() ? bytes.size() : std::min(bytes.find(end_of_header_), bytes.size());
    std::size_t start = below(header + 1);
    start = bytes.find_first_not_of(" \n", start);
    if (start == std::string::npos) return;
    const std::size_t end = std::min(bytes.find_first_of(" \n", start), bytes.size());
    bytes.replace(start, end - start, nasty[below(nasty.size())]);
  }

  std::mt19937 random_;
  std::string end_of_header_;
};

} // namespace pointgi::test
