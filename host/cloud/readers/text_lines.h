#pragma once
/// Text that holds numbers: its lines, its words, and pieces of it that can be read side by side. Nothing here depends
/// on the locale.
#include <cstddef>
#include <string_view>
#include <vector>

namespace pointgi {

/// Lines one after the other, without their ends: LF, CRLF or CR.
class TextLines {
public:
  /// `first_line`: number of the line that begins at `begin`.
  TextLines(const char* begin, const char* end, std::size_t first_line = 1)
      : at_(begin), end_(end), next_line_(first_line) {}

  /// Steps to the next line; false where the text has ended. What follows the last line end counts if it is not empty.
  bool next() {
    if (at_ == end_) return false;
    const char* stop = at_;
    while (stop < end_ && *stop != '\n' && *stop != '\r')
      ++stop;
    text_ = std::string_view(at_, static_cast<std::size_t>(stop - at_));
    if (stop < end_) stop += *stop == '\r' && stop + 1 < end_ && stop[1] == '\n' ? 2 : 1;
    at_ = stop;
    line_ = next_line_++;
    return true;
  }
  std::string_view text() const { return text_; }
  std::size_t line() const { return line_; } ///< its number
  const char* rest() const { return at_; }   ///< where the line after it begins

private:
  const char* at_;
  const char* end_;
  std::string_view text_;
  std::size_t line_ = 0;
  std::size_t next_line_;
};

/// A part of a text that begins and ends with whole lines.
struct TextPiece {
  const char* begin;
  const char* end;
};

/// Pieces of about `bytes` bytes each, in order; together the whole text. Empty for an empty text.
std::vector<TextPiece> split_at_line_ends(const char* begin, const char* end, std::size_t bytes = 1u << 20);

/// What stands between two values of a line, and inside of a number.
struct TextSeparator {
  char sign = ' ';            ///< ' ': any run of blanks and tabs; else each one separates
  bool decimal_comma = false; ///< 1,5 is one and a half

  const char* name() const; ///< "blanks", "tabs", "commas", "semicolons"
};

/// The words of a line. Blanks about a word and the quotes of a word in quotes are left out. A separator after the last
/// word ends the line; elsewhere nothing between two separators is an empty word.
class TextWords {
public:
  TextWords(std::string_view line, TextSeparator separator);
  bool next(std::string_view& word);

private:
  const char* at_;
  const char* end_;
  char sign_;
};

/// How many words a line has, counting at most `most`.
std::size_t count_words(std::string_view line, TextSeparator separator, std::size_t most);

std::string_view trimmed(std::string_view text); ///< without blanks and tabs at its ends

/// True if the whole word is a number: decimal, with exponent, inf or nan, after a + too. Numbers too small for a
/// double become zero and those too large infinite.
bool parse_number(std::string_view word, bool decimal_comma, double& value);

/// True if the word is a whole number in decimal digits, after a sign or not.
bool is_whole_number(std::string_view word);

} // namespace pointgi
