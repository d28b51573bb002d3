#include "host/cloud/readers/text_columns.h"
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace pointgi {

namespace {

constexpr double nearly_all = 0.98; // of the lines

bool are_nearly_all(std::size_t some, std::size_t all) {
  return all > 0 && static_cast<double>(some) >= nearly_all * static_cast<double>(all);
}

/// The first columns of some lines: a number each, NaN where there is none, and how it was written.
class Table {
public:
  Table(const std::vector<NumberedLine>& lines, TextSeparator separator, std::size_t columns) : columns_(columns) {
    for (const NumberedLine& line : lines) {
      TextWords words(line.text, separator);
      std::string_view word;
      for (std::size_t c = 0; c < columns; ++c) {
        double number = std::numeric_limits<double>::quiet_NaN();
        const bool there = words.next(word);
        if (there && !parse_number(word, separator.decimal_comma, number))
          number = std::numeric_limits<double>::quiet_NaN();
        numbers_.push_back(number);
        whole_.push_back(there && is_whole_number(word));
      }
    }
    lines_ = lines.size();
  }

  std::size_t lines() const { return lines_; }
  std::size_t columns() const { return columns_; }
  double number(std::size_t line, std::size_t column) const { return numbers_[line * columns_ + column]; }
  bool is_whole(std::size_t line, std::size_t column) const { return whole_[line * columns_ + column]; }

  /// Whether test(line) holds for nearly all lines.
  template <class Test>
  bool holds(Test test) const {
    std::size_t some = 0;
    for (std::size_t line = 0; line < lines_; ++line)
      some += test(line) ? 1u : 0u;
    return are_nearly_all(some, lines_);
  }

private:
  std::size_t columns_;
  std::size_t lines_ = 0;
  std::vector<double> numbers_;
  std::vector<bool> whole_;
};

bool is_whole_to(const Table& table, std::size_t column, double most) {
  return table.holds([&](std::size_t line) {
    const double value = table.number(line, column);
    return table.is_whole(line, column) && value >= 0.0 && value <= most;
  });
}

bool is_fraction(const Table& table, std::size_t column) {
  return table.holds([&](std::size_t line) {
    const double value = table.number(line, column);
    return value >= 0.0 && value <= 1.0;
  });
}

/// Three columns from `first` on: of unit length, but for those that are missing, zero.
bool are_normals(const Table& table, std::size_t first) {
  constexpr double rounding = 0.02; // of two decimals in each component
  std::size_t zero = 0;
  const bool unit = table.holds([&](std::size_t line) {
    const double length =
        std::hypot(table.number(line, first), table.number(line, first + 1), table.number(line, first + 2));
    zero += length == 0.0 ? 1u : 0u;
    return length == 0.0 || std::abs(length - 1.0) <= rounding;
  });
  return unit && zero < table.lines();
}

template <class Test>
bool hold_three(std::size_t first, Test test) {
  return test(first) && test(first + 1) && test(first + 2);
}

bool is_constant(const Table& table, std::size_t column) {
  return table.holds([&](std::size_t line) { return table.number(line, column) == table.number(0, column); });
}

/// Where the columns of one kind begin, among those in [begin, end) which nothing else has; `none` where they are not.
constexpr std::size_t none = 0;

std::size_t find_normals(const Table& table) {
  for (std::size_t c = 3; c + 3 <= table.columns(); ++c)
    if (are_normals(table, c)) return c;
  return none;
}

/// Of four columns the last three are taken as colours, as PTS has them after the intensity, unless the fourth holds
/// one number only: that is an opacity.
std::size_t find_colours(const Table& table, std::size_t begin, std::size_t end) {
  if (end < begin + 3) return none;
  const auto test_each = [&](auto test) -> std::size_t {
    const bool opacity_follows = end == begin + 4 && is_constant(table, begin + 3);
    if (end == begin + 4 && !opacity_follows && hold_three(begin + 1, test)) return begin + 1;
    for (std::size_t c = begin; c + 3 <= end; ++c)
      if (hold_three(c, test)) return c;
    return none;
  };
  for (const double most : {255.0, 65535.0}) {
    const std::size_t found = test_each([&](std::size_t c) { return is_whole_to(table, c, most); });
    if (found != none) return found;
  }
  return end == begin + 3 ? test_each([&](std::size_t c) { return is_fraction(table, c); }) : none;
}

struct Numbers {
  std::size_t words = 0; ///< that are numbers
  std::size_t lines = 0; ///< with three of them or more
};

Numbers count_numbers(const std::vector<NumberedLine>& lines, TextSeparator separator) {
  Numbers numbers;
  for (const NumberedLine& line : lines) {
    constexpr std::size_t most = 100; // of a line: they tell enough
    TextWords words(line.text, separator);
    std::string_view word;
    std::size_t here = 0;
    double number = 0.0;
    for (std::size_t w = 0; w < most && words.next(word); ++w)
      here += parse_number(word, separator.decimal_comma, number) ? 1u : 0u;
    numbers.words += here;
    numbers.lines += here >= 3 ? 1u : 0u;
  }
  return numbers;
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return lower;
}

} // namespace

bool have_position(const std::vector<FieldInfo>& columns) {
  return std::all_of(axis_names.begin(), axis_names.end(), [&](const char* axis) {
    return std::any_of(columns.begin(), columns.end(),
                       [&](const FieldInfo& column) { return lookup_name(column.name) == axis; });
  });
}

std::string column_name(std::string_view name) {
  const std::size_t bracket = name.find_first_of("[(");
  if (bracket != std::string_view::npos && bracket > 0) name = trimmed(name.substr(0, bracket));
  static const std::vector<std::pair<const char*, const char*>> others{
      {"easting", "x"},   {"northing", "y"},   {"elevation", "z"},  {"height", "z"},       {"altitude", "z"},
      {"x_coord", "x"},   {"y_coord", "y"},    {"z_coord", "z"},    {"points:0", "x"},     {"points:1", "y"},
      {"points:2", "z"},  {"normals:0", "nx"}, {"normals:1", "ny"}, {"normals:2", "nz"},   {"rgb:0", "red"},
      {"rgb:1", "green"}, {"rgb:2", "blue"},   {"colors:0", "red"}, {"colors:1", "green"}, {"colors:2", "blue"}};
  const std::string lower = lower_case(name);
  for (const auto& [other, ours] : others)
    if (lower == other) return ours;
  return std::string(name);
}

TextSeparator find_separator(const std::vector<NumberedLine>& lines) {
  // Commas between numbers come before commas in them: 1, 2, 3 has both.
  for (const char sign : {';', '\t', ',', ' '}) {
    const Numbers points = count_numbers(lines, {sign, false});
    const Numbers commas = sign == ',' ? Numbers{} : count_numbers(lines, {sign, true});
    const bool decimal_comma = commas.words > points.words;
    if (are_nearly_all(decimal_comma ? commas.lines : points.lines, lines.size())) return {sign, decimal_comma};
  }
  return {};
}

bool is_colmap(const std::vector<NumberedLine>& comments, const std::vector<NumberedLine>& points,
               TextSeparator separator) {
  for (const NumberedLine& comment : comments)
    if (comment.text.find("POINT3D_ID") == 0) return true;
  const Table table(points, separator, 8);
  bool differ = false;
  const std::size_t words = count_words(points.front().text, separator, 100000);
  for (const NumberedLine& line : points) {
    const std::size_t count = count_words(line.text, separator, 100000);
    if (count < 10 || count % 2 != 0) return false;
    differ = differ || count != words;
  }
  return differ && is_whole_to(table, 0, 1e19) &&
         hold_three(4, [&](std::size_t c) { return is_whole_to(table, c, 255); });
}

std::vector<FieldInfo> columns_by_content(const std::vector<NumberedLine>& lines, TextSeparator separator,
                                          std::size_t columns) {
  std::vector<FieldInfo> named;
  for (std::size_t c = 0; c < columns; ++c)
    named.push_back({c < 3 ? axis_names[c] : "column " + std::to_string(c + 1), FieldType::f64});
  const Table table(lines, separator, columns);
  std::vector<bool> taken(columns, false);
  const auto take = [&](std::size_t first, std::array<const char*, 3> names) {
    for (std::size_t k = 0; k < 3 && first != none; ++k) {
      named[first + k].name = names[k];
      taken[first + k] = true;
    }
  };
  const std::size_t normals = find_normals(table);
  take(normals, {"nx", "ny", "nz"});
  std::size_t colours = find_colours(table, 3, normals == none ? columns : normals);
  if (colours == none && normals != none) colours = find_colours(table, normals + 3, columns);
  take(colours, {"red", "green", "blue"});
  // One more column beside what is known is an intensity; of several nothing tells which.
  std::vector<std::size_t> others;
  for (std::size_t c = 3; c < columns; ++c)
    if (!taken[c]) others.push_back(c);
  const bool grey = columns == 4; // an intensity that stands for colours may be any
  if (others.size() == 1 && (grey || !is_constant(table, others[0]))) named[others[0]].name = "intensity";
  return named;
}

void set_colour_types(const std::vector<NumberedLine>& lines, TextSeparator separator,
                      std::vector<FieldInfo>& columns) {
  static const std::vector<std::string> colours{"red", "green",       "blue",          "r",           "g",
                                                "b",   "diffuse_red", "diffuse_green", "diffuse_blue"};
  const Table table(lines, separator, columns.size());
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const std::string name = lookup_name(columns[c].name);
    if (std::find(colours.begin(), colours.end(), name) != colours.end()) {
      if (is_whole_to(table, c, 65535.0)) columns[c].type = FieldType::i32; // 8 bits or 16: nearly all points decide
    } else if (name == "rgb" || name == "rgba") {
      columns[c].type = is_whole_to(table, c, 4294967295.0) ? FieldType::u32 : FieldType::f32;
    }
  }
}

} // namespace pointgi
