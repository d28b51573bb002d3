#include "host/cloud/readers/lzf.h"
#include "tests/support/lzf_bytes.h"
#include <catch2/catch.hpp>
#include <random>

using namespace pointgi;
using pointgi::test::lzf_compressed;

namespace {

std::size_t decompress(const std::string& packed, std::string& to) {
  return decompress_lzf(packed.data(), packed.size(), to.data(), to.size());
}

} // namespace

TEST_CASE("lzf: what was compressed comes back") {
  std::mt19937 random(1);
  std::string noise(5000, ' '), floats;
  for (char& c : noise)
    c = static_cast<char>(random() & 255);
  for (int i = 0; i < 3000; ++i)
    floats += std::string("\x3f\x80") + static_cast<char>(i / 100) + static_cast<char>(i);
  const std::vector<std::string> texts{
      "",    "a",    "ab",         std::string(1, '\0'), std::string(3000, 'x'), "abcabcabcabc abcabc",
      noise, floats, noise + noise}; // a copy from 5000 bytes before
  for (const std::string& text : texts) {
    const std::string packed = lzf_compressed(text);
    std::string back(text.size(), '?');
    CHECK(decompress(packed, back) == packed.size());
    CHECK(back == text);
    CHECK(text.size() <= packed.size() * lzf_most);
  }
  CHECK(lzf_compressed(std::string(3000, 'x')).size() < 50);
}

TEST_CASE("lzf: faults are found where they are") {
  std::string to(10, '?');
  CHECK(decompress(std::string("\x04"
                               "abcde"
                               "\x05"
                               "abc",
                               10),
                   to) == 6); // the second piece ends early
  CHECK(decompress(std::string("\x01"
                               "ab"
                               "\x20\x02",
                               5),
                   to) == 3); // from before the beginning
  CHECK(decompress(std::string("\x00"
                               "a"
                               "\xe0\xff",
                               4),
                   to) == 2); // a copy without its distance
  CHECK(decompress(std::string("\x00"
                               "a"
                               "\xe0",
                               3),
                   to) == 2); // nor its length
  CHECK(decompress(std::string("\x00"
                               "a"
                               "\xe0\xff\x00",
                               5),
                   to) == 2); // too much
  CHECK(decompress(std::string("\x0a"
                               "abcdefghijk",
                               12),
                   to) == 0);
  CHECK(decompress(std::string("\x00"
                               "a",
                               2),
                   to) == 3); // too little
}

TEST_CASE("lzf: any bytes end, within their bounds") {
  std::mt19937 random(2);
  for (int i = 0; i < 20000; ++i) {
    std::string packed(random() % 64, ' ');
    for (char& c : packed)
      c = static_cast<char>(random() & (i % 2 == 0 ? 255u : 63u));
    std::string to(random() % 128 + 2, '?');
    to[to.size() - 1] = '!';
    const std::size_t stop = decompress_lzf(packed.data(), packed.size(), to.data(), to.size() - 1);
    REQUIRE(stop <= packed.size() + 1);
    REQUIRE(to.back() == '!');
  }
}
