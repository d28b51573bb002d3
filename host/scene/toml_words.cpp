#include "host/scene/toml_words.h"
#include "host/scene/nearest.h"
#include <algorithm>
#include <charconv>
#include <cmath>

namespace pointgi {
namespace {

constexpr std::size_t shown_bytes = 60;
constexpr std::size_t shown_elements = 4;
constexpr std::size_t shown_names = 32;

std::string number_text(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value < 0 ? "-inf" : "inf";
  char digits[32]; // the shortest text of a double has at most 24 characters
  const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  const std::string text(digits, end);
  // TOML tells 32.0 from 32, and so must "expected an integer, found 32.0".
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

std::string array_text(const toml::array& array) {
  std::string text = "[";
  for (std::size_t i = 0; i < array.size() && i < shown_elements; ++i) {
    if (!array[i].is_value()) return "an array of " + std::to_string(array.size());
    text += (i > 0 ? ", " : "") + found_text(array[i]);
  }
  if (array.size() <= shown_elements) return text + "]";
  return text + ", ...] (" + std::to_string(array.size()) + " values)";
}

} // namespace

SourcePlace place_of(const toml::source_region& source, const std::string& file) {
  if (source.path) return {*source.path, 0, 0};
  return {file, source.begin.line, source.begin.column};
}

std::string found_text(const toml::node& node) {
  if (const auto* text = node.as_string()) return quoted(text->get());
  if (const auto* integer = node.as_integer()) return std::to_string(integer->get());
  if (const auto* number = node.as_floating_point()) return number_text(number->get());
  if (const auto* truth = node.as_boolean()) return truth->get() ? "true" : "false";
  if (const auto* array = node.as_array()) return array_text(*array);
  if (node.is_table()) return "a table";
  return "a date or time";
}

std::string harmless(const std::string& text) {
  std::string shown;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f) {
      constexpr char hex[] = "0123456789abcdef";
      shown += std::string("\\x") + hex[byte >> 4] + hex[byte & 15];
    } else {
      shown += c;
    }
  }
  return shown;
}

std::string quoted(const std::string& text) {
  std::size_t end = std::min(text.size(), shown_bytes);
  // The cut must not leave half a UTF-8 character: take the rest of its continuation bytes too.
  while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80)
    ++end;
  return "\"" + harmless(text.substr(0, end)) + (end < text.size() ? "...\"" : "\"");
}

std::string any_of(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + quoted(words[i]);
  return text;
}

std::string hint(const std::string& word, const std::vector<std::string>& known, const std::string& what) {
  const std::string near = nearest(word, known);
  if (!near.empty() && near != word) return "; did you mean " + quoted(near) + "?";
  std::string text = "; known " + what + ": ";
  for (std::size_t i = 0; i < known.size() && i < shown_names; ++i)
    text += (i > 0 ? ", " : "") + known[i];
  if (known.size() > shown_names) text += ", ... (" + std::to_string(known.size()) + " in all)";
  return text;
}

} // namespace pointgi
