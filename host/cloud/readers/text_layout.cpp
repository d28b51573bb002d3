#include "host/cloud/readers/text_layout.h"
#include "host/cloud/input_file.h"
#include "host/cloud/readers/text_columns.h"
#include <algorithm>
#include <cstring>
#include <map>

namespace pointgi {

namespace {

constexpr std::size_t most_lines = 1000;    // of points, by which the layout is found
constexpr std::size_t most_columns = 1000;  // a line of a table has fewer
constexpr std::size_t most_bytes = 1 << 24; // of text looked at, in case there are no lines

[[noreturn]] void fail(const std::string& file, std::size_t line, const std::string& what) {
  throw Error(ErrorKind::input, file + ": line " + std::to_string(line) + ": " + what);
}

/// The first lines: what may name the columns, and those of points.
struct Sample {
  std::vector<NumberedLine> comments; ///< before the first other line, without their signs
  NumberedLine first;                 ///< the first line that is no comment and no count
  std::vector<NumberedLine> points;   ///< the lines after it
  std::size_t last_line = 1;
};

std::string_view without_comment_sign(std::string_view line) {
  line = trimmed(line);
  while (!line.empty() && (line.front() == '#' || line.front() == '/' || line.front() == ';'))
    line.remove_prefix(1);
  return trimmed(line);
}

Sample take_sample(const char* begin, const char* end, std::size_t first_line) {
  Sample sample;
  const TextSeparator blanks;
  TextLines lines(begin, end, first_line);
  while (sample.points.size() < most_lines && lines.next()) {
    sample.last_line = lines.line();
    const std::string_view text = trimmed(lines.text());
    const TextLine kind = kind_of_line(text, blanks);
    if (kind == TextLine::values) {
      if (sample.first.number == 0)
        sample.first = {text, lines.line()};
      else
        sample.points.push_back({text, lines.line()});
    } else if (kind == TextLine::blank && !text.empty() && sample.first.number == 0) {
      sample.comments.push_back({without_comment_sign(text), lines.line()});
    }
  }
  return sample;
}

/// The words of a header line, or nothing where some word is a number.
std::vector<std::string> names_in(std::string_view line, TextSeparator separator) {
  std::vector<std::string> names;
  TextWords words(line, separator);
  std::string_view word;
  double number = 0.0;
  while (names.size() < most_columns && words.next(word)) {
    if (parse_number(word, true, number) || parse_number(word, false, number)) return {};
    names.push_back(column_name(without_comment_sign(word)));
  }
  return names;
}

std::vector<FieldInfo> columns_named(const std::vector<std::string>& names) {
  std::vector<FieldInfo> columns;
  for (const std::string& name : names)
    columns.push_back({name, FieldType::f64});
  return columns;
}

/// How many values the lines have: the commonest count, of at least half of them.
std::size_t column_count(const std::vector<NumberedLine>& lines, TextSeparator separator, const std::string& file) {
  std::map<std::size_t, std::size_t> lines_of;
  for (const NumberedLine& line : lines)
    ++lines_of[count_words(line.text, separator, most_columns)];
  const auto commonest = std::max_element(lines_of.begin(), lines_of.end(),
                                          [](const auto& a, const auto& b) { return a.second < b.second; });
  if (2 * commonest->second < lines.size())
    fail(file, lines.front().number,
         "the lines have different numbers of values (" + std::to_string(lines_of.begin()->first) + " to " +
             std::to_string(lines_of.rbegin()->first) +
             "), expected as many on every line; this is no table of points");
  return commonest->first;
}

void refuse_other_colmap_lists(const std::vector<NumberedLine>& comments, const std::string& file) {
  for (const NumberedLine& comment : comments)
    for (const auto& [sign, content] : {std::pair{"IMAGE_ID, QW", "images"}, {"CAMERA_ID, MODEL", "cameras"}})
      if (comment.text.find(sign) == 0)
        fail(file, comment.number,
             std::string("this is COLMAP's list of ") + content +
                 ", which holds no points; give points3D.txt, which "
                 "lies beside it");
}

void name_by_header(const Sample& sample, const std::vector<NumberedLine>& points, TextLayout& layout) {
  if (layout.header_is_data) {
    layout.header_line = sample.first.number;
    layout.columns = columns_named(names_in(sample.first.text, layout.separator));
    return;
  }
  const std::size_t columns = count_words(points.front().text, layout.separator, most_columns);
  for (const NumberedLine& comment : sample.comments)
    for (const char sign : {layout.separator.sign, ' ', ','}) {
      const std::vector<FieldInfo> named = columns_named(names_in(comment.text, {sign, false}));
      if (named.size() != columns || !have_position(named)) continue;
      layout.header_line = comment.number;
      layout.columns = named;
      break;
    }
}

void refuse_other_than_text(const char* begin, const char* end, const std::string& file) {
  const std::size_t size = std::min<std::size_t>(static_cast<std::size_t>(end - begin), 1 << 16);
  if (size >= 2 && (std::memcmp(begin, "\xff\xfe", 2) == 0 || std::memcmp(begin, "\xfe\xff", 2) == 0))
    throw Error(ErrorKind::input, file + ": byte 0: this is text of two bytes a letter (UTF-16); save it as UTF-8");
  if (const void* zero = std::memchr(begin, 0, size))
    throw Error(ErrorKind::input, file + ": byte " + std::to_string(static_cast<const char*>(zero) - begin) +
                                      ": this is no text; check what program wrote the file and give it the ending "
                                      "of its format");
}

} // namespace

TextLine kind_of_line(std::string_view line, TextSeparator separator) {
  line = trimmed(line);
  if (line.empty() || line.front() == '#' || (line.front() == ';' && separator.sign != ';') ||
      line.compare(0, 2, "//") == 0)
    return TextLine::blank;
  return is_whole_number(line) ? TextLine::count : TextLine::values;
}

TextLayout find_text_layout(const char* begin, const char* end, std::size_t first_line, const std::string& file) {
  refuse_other_than_text(begin, end, file);
  const char* stop = end - begin > static_cast<std::ptrdiff_t>(most_bytes) ? begin + most_bytes : end;
  const Sample sample = take_sample(begin, stop, first_line);
  refuse_other_colmap_lists(sample.comments, file);
  if (sample.first.number == 0)
    fail(file, sample.last_line, "the file ends without a point; expected lines of x y z and more");

  TextLayout layout;
  std::vector<NumberedLine> points = sample.points;
  if (points.empty()) points.push_back(sample.first);
  layout.separator = find_separator(points);
  layout.header_is_data = !sample.points.empty() && !names_in(sample.first.text, layout.separator).empty();
  if (!layout.header_is_data && !sample.points.empty()) {
    points.insert(points.begin(), sample.first);
    layout.separator = find_separator(points);
  }
  layout.colmap = !layout.header_is_data && is_colmap(sample.comments, points, layout.separator);
  if (layout.colmap) {
    layout.columns = columns_named({"point3d_id", "x", "y", "z", "red", "green", "blue", "error"});
  } else {
    name_by_header(sample, points, layout);
    if (layout.columns.empty()) {
      const std::size_t columns = column_count(points, layout.separator, file);
      if (columns < 3)
        fail(file, points.front().number,
             "expected x y z and more, numbers with blanks, tabs, commas or semicolons between them; found " +
                 quoted_bytes(points.front().text));
      layout.columns = columns_by_content(points, layout.separator, columns);
    }
  }
  set_colour_types(points, layout.separator, layout.columns);
  return layout;
}

} // namespace pointgi
