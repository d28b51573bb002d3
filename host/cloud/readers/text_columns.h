#pragma once
/// Guesses about tables of numbers by their first lines.
#include "host/cloud/field.h"
#include "host/cloud/readers/text_lines.h"
#include <array>
#include <string>
#include <vector>

namespace pointgi {

struct NumberedLine {
  std::string_view text;
  std::size_t number = 0; ///< of the line, from 1
};

constexpr std::array<const char*, 3> axis_names{"x", "y", "z"};

/// Whether there are columns named x, y and z.
bool have_position(const std::vector<FieldInfo>& columns);

/// A column's name without units in brackets, and those that other programs give positions, normals and colours as
/// plan_fields() knows them: "Easting", "Points:0", "X [m]".
std::string column_name(std::string_view name);

/// The separator by which nearly all lines have three numbers or more; blanks where none does.
TextSeparator find_separator(const std::vector<NumberedLine>& lines);

/// Whether the lines are those of COLMAP's points3D.txt, as a comment says or by their content: a number of its own,
/// x y z, whole numbers 0..255, an error, pairs of whole numbers.
bool is_colmap(const std::vector<NumberedLine>& comments, const std::vector<NumberedLine>& points,
               TextSeparator separator);

/// The columns (3 or more) of lines without a header, named by what nearly all lines hold; "column 8" where that says
/// nothing.
std::vector<FieldInfo> columns_by_content(const std::vector<NumberedLine>& lines, TextSeparator separator,
                                          std::size_t columns);

/// Makes colours, packed or not, that are written as whole numbers of integer type.
void set_colour_types(const std::vector<NumberedLine>& lines, TextSeparator separator, std::vector<FieldInfo>& columns);

} // namespace pointgi
