#include "host/cloud/readers/pcd_header.h"
#include "host/cloud/input_file.h"
#include "host/cloud/readers/lzf.h"
#include "host/cloud/readers/text_lines.h"
#include <algorithm>
#include <charconv>
#include <limits>

namespace pointgi {

namespace {

using Words = std::vector<std::string_view>;

constexpr std::size_t most_values = 4096; ///< of a point; the longest histogram in use has 1980

std::string upper(std::string_view word) {
  std::string text(word);
  for (char& c : text)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return text;
}

Words words_of(std::string_view line) {
  Words words;
  TextWords rest(line, {});
  for (std::string_view word; rest.next(word);)
    words.push_back(word);
  return words;
}

/// Collects the header's lines, then makes sense of them together.
class Parser {
public:
  Parser(const char* data, std::size_t size, std::uint64_t file_bytes, const std::string& file)
      : begin_(data), lines_(data, data + size), file_bytes_(file_bytes), file_(file) {}

  PcdHeader parse() {
    while (!read_line())
      continue;
    build_fields();
    build_count();
    check_size();
    return std::move(header_);
  }

private:
  [[noreturn]] void fail(std::size_t line, const std::string& what) const {
    throw Error(ErrorKind::input, file_ + ": line " + std::to_string(line) + ": " + what);
  }

  /// True behind the line DATA, the last of the header.
  bool read_line() {
    if (!lines_.next())
      fail(lines_.line() + 1, "the file ends within its header, expected a line DATA; the file is truncated or no PCD");
    Words words = words_of(lines_.text());
    if (words.empty() || words[0].substr(0, 1) == "#") return false; // quotes may hold no word
    const std::string key = upper(words[0]);
    words.erase(words.begin());
    if (key == "FIELDS" || key == "COLUMNS")
      keep(names_, words);
    else if (key == "SIZE")
      keep(sizes_, words);
    else if (key == "TYPE")
      keep(types_, words);
    else if (key == "COUNT")
      keep(counts_, words);
    else if (key == "WIDTH")
      width_ = whole(words);
    else if (key == "HEIGHT")
      height_ = whole(words);
    else if (key == "POINTS")
      points_ = whole(words);
    else if (key == "VIEWPOINT")
      read_viewpoint(words);
    else if (key == "DATA")
      read_data(words);
    else if (key != "VERSION")
      fail(lines_.line(), "expected FIELDS, SIZE, TYPE, COUNT, WIDTH, HEIGHT, VIEWPOINT, POINTS or DATA, found " +
                              quoted_bytes(lines_.text()) +
                              "; the file has no PCD header, name it .xyz if it is a table of numbers");
    return key == "DATA";
  }

  struct Line {
    std::size_t number = 0;
    std::vector<std::string> words;
  };
  struct Number {
    std::size_t line = 0;
    std::uint64_t value = 0;
  };

  void keep(Line& line, const Words& words) {
    if (words.size() > most_values)
      fail(lines_.line(), std::to_string(words.size()) + " words, expected at most " + std::to_string(most_values));
    line.number = lines_.line();
    line.words.assign(words.begin(), words.end());
  }

  std::uint64_t whole(std::size_t line, std::string_view word) const {
    std::uint64_t value = 0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || stop != word.data() + word.size())
      fail(line, "expected a whole number, found " + quoted_bytes(word));
    return value;
  }
  Number whole(const Words& words) const {
    if (words.size() != 1) fail(lines_.line(), "expected one whole number");
    return {lines_.line(), whole(lines_.line(), words[0])};
  }

  void read_viewpoint(const Words& words) {
    std::array<double, 7> v{};
    if (words.size() != v.size())
      fail(lines_.line(), "expected 7 numbers (tx ty tz qw qx qy qz), found " + std::to_string(words.size()));
    for (std::size_t k = 0; k < v.size(); ++k)
      if (!parse_number(words[k], false, v[k]))
        fail(lines_.line(), "expected a number, found " + quoted_bytes(words[k]));
    if (std::all_of(v.begin(), v.end(), [](double value) { return std::isfinite(value); }))
      header_.viewpoint = PcdViewpoint{{v[0], v[1], v[2]}, {v[3], v[4], v[5], v[6]}};
  }

  void read_data(const Words& words) {
    const std::string kind = words.empty() ? "" : upper(words[0]);
    if (kind == "ASCII")
      header_.data = PcdData::ascii;
    else if (kind == "BINARY")
      header_.data = PcdData::binary;
    else if (kind == "BINARY_COMPRESSED")
      header_.data = PcdData::binary_compressed;
    else
      fail(lines_.line(), "expected DATA ascii, binary or binary_compressed, found " +
                              quoted_bytes(words.empty() ? std::string_view() : words[0]));
    header_.body = static_cast<std::size_t>(lines_.rest() - begin_);
    header_.body_line = lines_.line() + 1;
  }

  FieldType type_of(std::size_t k) const {
    // Old text files have neither line: their values are floats.
    const std::string size = sizes_.number == 0 ? "4" : sizes_.words[k];
    const std::string kind = types_.number == 0 ? "F" : upper(types_.words[k]);
    static const std::vector<std::pair<std::string, FieldType>> types{
        {"I1", FieldType::i8},  {"I2", FieldType::i16}, {"I4", FieldType::i32}, {"I8", FieldType::i64},
        {"U1", FieldType::u8},  {"U2", FieldType::u16}, {"U4", FieldType::u32}, {"U8", FieldType::u64},
        {"F4", FieldType::f32}, {"F8", FieldType::f64}};
    for (const auto& [name, type] : types)
      if (name == kind + size) return type;
    fail(types_.number == 0 ? sizes_.number : types_.number,
         "field " + quoted_bytes(names_.words[k]) + " has TYPE " + quoted_bytes(kind) + " and SIZE " +
             quoted_bytes(size) + ", expected I or U with 1, 2, 4 or 8, or F with 4 or 8");
  }

  void build_fields() {
    const std::size_t data_line = header_.body_line - 1;
    if (names_.words.empty()) fail(data_line, "no line FIELDS came before it, expected one that names x y z");
    for (const Line* line : {&sizes_, &types_, &counts_})
      if (line->number != 0 && line->words.size() != names_.words.size())
        fail(line->number, std::to_string(line->words.size()) + " words, expected " +
                               std::to_string(names_.words.size()) + ", one for each of FIELDS");
    if (header_.data != PcdData::ascii && (sizes_.number == 0 || types_.number == 0))
      fail(data_line, "binary data without lines SIZE and TYPE before it");
    std::size_t values = 0;
    for (std::size_t k = 0; k < names_.words.size(); ++k) {
      PcdField field{names_.words[k], type_of(k), 1};
      if (counts_.number != 0) {
        const std::uint64_t count = whole(counts_.number, counts_.words[k]);
        if (count == 0 || count > most_values)
          fail(counts_.number, "field " + quoted_bytes(field.name) + " has a COUNT of " + std::to_string(count) +
                                   ", expected 1 to " + std::to_string(most_values));
        field.values = static_cast<std::size_t>(count);
      }
      values += field.values;
      header_.fields.push_back(std::move(field));
    }
    if (values > most_values)
      fail(counts_.number,
           std::to_string(values) + " values for each point, expected at most " + std::to_string(most_values));
  }

  void build_count() {
    header_.width = width_.value;
    header_.height = height_.line == 0 ? 1 : height_.value;
    const bool fits =
        header_.height == 0 || header_.width <= std::numeric_limits<std::uint64_t>::max() / header_.height;
    const std::uint64_t pixels = fits ? header_.width * header_.height : std::numeric_limits<std::uint64_t>::max();
    header_.points = points_.line != 0 ? points_.value : pixels;
    header_.points_line = points_.line != 0 ? points_.line : width_.line;
    if (header_.points_line == 0) fail(header_.body_line - 1, "neither WIDTH nor POINTS came before it");
    if (points_.line != 0 && width_.line != 0 && pixels != header_.points)
      header_.warnings.push_back("line " + std::to_string(points_.line) + " says " + std::to_string(header_.points) +
                                 " points, WIDTH and HEIGHT make " + std::to_string(pixels) + "; " +
                                 std::to_string(header_.points) +
                                 " were read. Correct the header if points are missing.");
    if (header_.points == 0) fail(header_.points_line, "the cloud is empty (0 points); expected one point or more");
    if (header_.points > std::numeric_limits<std::uint32_t>::max())
      fail(header_.points_line,
           std::to_string(header_.points) + " points, expected at most 4294967295; thin the cloud out or split it");
  }

  /// Products stay below 2^63: a point has at most 4096 values of 8 bytes.
  void check_size() const {
    const std::uint64_t left = file_bytes_ - header_.body;
    std::uint64_t room = left / header_.record_bytes();
    if (header_.data == PcdData::ascii) {
      std::uint64_t values = 0;
      for (const PcdField& field : header_.fields)
        values += field.values;
      room = (left + 1) / (2 * values); // a digit and what ends it, the last not needed
    } else if (header_.data == PcdData::binary_compressed) {
      room = left * lzf_most / header_.record_bytes();
    }
    if (header_.points > room)
      fail(header_.points_line, std::to_string(header_.points) + " points are announced, the " + std::to_string(left) +
                                    " bytes from byte " + std::to_string(header_.body) + " on have room for at most " +
                                    std::to_string(room) + "; the file is truncated or corrupt");
  }

  const char* begin_;
  TextLines lines_;
  std::uint64_t file_bytes_;
  const std::string& file_;
  PcdHeader header_;
  Line names_, sizes_, types_, counts_;
  Number width_, height_, points_;
};

} // namespace

const char* name_of(PcdData data) {
  return data == PcdData::ascii ? "ascii" : data == PcdData::binary ? "binary" : "binary_compressed";
}

std::uint64_t PcdHeader::record_bytes() const {
  std::uint64_t bytes = 0;
  for (const PcdField& field : fields)
    bytes += field.bytes();
  return bytes;
}

bool is_pcd(const char* data, std::size_t size) {
  TextLines lines(data, data + size);
  while (lines.next()) {
    const Words words = words_of(lines.text());
    if (words.empty()) continue;
    if (words[0] == "#") {
      if (words.size() > 1 && words[1] == ".PCD") return true;
      continue;
    }
    return words[0] == "VERSION" || words[0] == "FIELDS";
  }
  return false;
}

PcdHeader parse_pcd_header(const char* data, std::size_t size, std::uint64_t file_bytes, const std::string& file) {
  return Parser(data, size, file_bytes, file).parse();
}

} // namespace pointgi
