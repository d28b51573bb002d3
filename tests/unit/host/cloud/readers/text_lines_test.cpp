#include "host/cloud/readers/text_lines.h"
#include <catch2/catch.hpp>
#include <cmath>

using namespace pointgi;

namespace {

std::vector<std::string> words_of(std::string_view line, TextSeparator separator) {
  std::vector<std::string> all;
  TextWords words(line, separator);
  std::string_view word;
  while (words.next(word))
    all.emplace_back(word);
  return all;
}

} // namespace

TEST_CASE("text lines: LF, CRLF and CR end a line, and the last needs no end") {
  const std::string text = "a\nb\r\n\r\nc\rd";
  TextLines lines(text.data(), text.data() + text.size(), 5);
  std::vector<std::string> found;
  while (lines.next())
    found.push_back(std::to_string(lines.line()) + ":" + std::string(lines.text()));
  CHECK(found == std::vector<std::string>{"5:a", "6:b", "7:", "8:c", "9:d"});
}

TEST_CASE("text lines: pieces of any size have the same lines as the whole") {
  std::string text;
  for (int i = 0; i < 200; ++i)
    text += std::string(static_cast<std::size_t>(i % 13), 'x') + (i % 3 == 0 ? "\r\n" : i % 3 == 1 ? "\n" : "\r");
  text += "end";
  for (std::size_t bytes = 1; bytes < 60; ++bytes) {
    const char* at = text.data();
    std::size_t lines_of_pieces = 0;
    for (const TextPiece& piece : split_at_line_ends(text.data(), text.data() + text.size(), bytes)) {
      REQUIRE(piece.begin == at);
      REQUIRE(piece.end > piece.begin);
      at = piece.end;
      TextLines lines(piece.begin, piece.end);
      while (lines.next())
        ++lines_of_pieces;
    }
    CHECK(at == text.data() + text.size());
    CHECK(lines_of_pieces == 201);
  }
  CHECK(split_at_line_ends(text.data(), text.data()).empty());
}

TEST_CASE("text words: separators, quotes, and a separator at the end of the line") {
  using Words = std::vector<std::string>;
  CHECK(words_of("  1 \t2  3 ", {' ', false}) == Words{"1", "2", "3"});
  CHECK(words_of("1, 2 ,,3,", {',', false}) == Words{"1", "2", "", "3"});
  CHECK(words_of("1;2,5;3", {';', true}) == Words{"1", "2,5", "3"});
  CHECK(words_of("a b\tc\t\td", {'\t', false}) == Words{"a b", "c", "", "d"});
  CHECK(words_of(R"("X","a, b",3)", {',', false}) == Words{"X", "a, b", "3"});
  CHECK(words_of(R"("one two" 3)", {' ', false}) == Words{"one two", "3"});
  CHECK(words_of("", {',', false}).empty());
  CHECK(count_words("1 2 3 4", {' ', false}, 3) == 3);
}

TEST_CASE("text words: numbers in every notation, and what is none") {
  double value = 0.0;
  const auto number = [&](const char* word, bool comma = false) {
    REQUIRE(parse_number(word, comma, value));
    return value;
  };
  CHECK(number("1.5") == 1.5);
  CHECK(number("+2e3") == 2000.0);
  CHECK(number("-.25") == -0.25);
  CHECK(number("1,5", true) == 1.5);
  CHECK(number("1.5", true) == 1.5);
  CHECK(number("1e-999") == 0.0);
  CHECK(number("-1e999") == -HUGE_VAL);
  CHECK(std::isnan(number("nan")));
  for (const char* word : {"", "-", "+-1", "1,5", "1.5f", "x", "1 2", "0x10"})
    CHECK_FALSE(parse_number(word, false, value));
  CHECK_FALSE(parse_number("1.234,5", true, value));
  CHECK(is_whole_number("-12"));
  CHECK_FALSE(is_whole_number("1.0"));
  CHECK_FALSE(is_whole_number("-"));
}
