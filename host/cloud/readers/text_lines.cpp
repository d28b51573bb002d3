#include "host/cloud/readers/text_lines.h"
#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <limits>

namespace pointgi {

namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

} // namespace

std::vector<TextPiece> split_at_line_ends(const char* begin, const char* end, std::size_t bytes) {
  std::vector<TextPiece> pieces;
  while (begin < end) {
    const char* stop = static_cast<std::size_t>(end - begin) <= bytes ? end : begin + bytes;
    const auto after_line_end = [&] { return stop[-1] == '\n' || (stop[-1] == '\r' && *stop != '\n'); };
    while (stop < end && !after_line_end())
      ++stop;
    pieces.push_back({begin, stop});
    begin = stop;
  }
  return pieces;
}

const char* TextSeparator::name() const {
  switch (sign) {
  case '\t':
    return "tabs";
  case ',':
    return "commas";
  case ';':
    return "semicolons";
  default:
    return "blanks";
  }
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front()))
    text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back()))
    text.remove_suffix(1);
  return text;
}

TextWords::TextWords(std::string_view line, TextSeparator separator)
    : at_(line.data()), end_(line.data() + line.size()), sign_(separator.sign) {}

bool TextWords::next(std::string_view& word) {
  while (at_ < end_ && *at_ != sign_ && is_blank(*at_))
    ++at_;
  if (sign_ == ' ')
    while (at_ < end_ && is_blank(*at_))
      ++at_;
  if (at_ == end_) return false;
  const char* start = at_;
  if (*start == '"') {
    const char* closing =
        static_cast<const char*>(std::memchr(start + 1, '"', static_cast<std::size_t>(end_ - start - 1)));
    if (closing != nullptr) {
      word = trimmed({start + 1, static_cast<std::size_t>(closing - start - 1)});
      at_ = closing + 1;
      while (at_ < end_ && *at_ != sign_ && is_blank(*at_))
        ++at_;
      if (at_ < end_ && *at_ == sign_) ++at_;
      return true;
    }
  }
  if (sign_ == ' ') {
    while (at_ < end_ && !is_blank(*at_))
      ++at_;
    word = {start, static_cast<std::size_t>(at_ - start)};
    return true;
  }
  while (at_ < end_ && *at_ != sign_)
    ++at_;
  word = trimmed({start, static_cast<std::size_t>(at_ - start)});
  if (at_ < end_) ++at_;
  return true;
}

std::size_t count_words(std::string_view line, TextSeparator separator, std::size_t most) {
  TextWords words(line, separator);
  std::string_view word;
  std::size_t count = 0;
  while (count < most && words.next(word))
    ++count;
  return count;
}

bool parse_number(std::string_view word, bool decimal_comma, double& value) {
  std::array<char, 64> copy;
  if (decimal_comma && word.find(',') != std::string_view::npos) {
    if (word.size() > copy.size() || word.find('.') != std::string_view::npos) return false;
    std::replace_copy(word.begin(), word.end(), copy.begin(), ',', '.');
    word = {copy.data(), word.size()};
  }
  const char* first = word.data();
  const char* last = first + word.size();
  if (word.size() > 1 && *first == '+' && first[1] != '-') ++first;
  if (first == last) return false;
  const auto [stop, error] = std::from_chars(first, last, value);
  if (stop != last || error == std::errc::invalid_argument) return false;
  if (error == std::errc::result_out_of_range) {
    const std::size_t exponent = word.find_first_of("eE");
    const bool tiny = exponent != std::string_view::npos && exponent + 1 < word.size() && word[exponent + 1] == '-';
    value = tiny ? 0.0 : std::numeric_limits<double>::infinity();
    if (*first == '-') value = -value;
  }
  return true;
}

bool is_whole_number(std::string_view word) {
  if (!word.empty() && (word.front() == '-' || word.front() == '+')) word.remove_prefix(1);
  return !word.empty() && std::all_of(word.begin(), word.end(), [](char c) { return c >= '0' && c <= '9'; });
}

} // namespace pointgi
