#pragma once
/// What the columns of a table of numbers mean: by a header that names them, or by what they hold.
#include "host/cloud/field.h"
#include "host/cloud/readers/text_lines.h"
#include <string>
#include <vector>

namespace pointgi {

struct TextLayout {
  TextSeparator separator;
  std::vector<FieldInfo> columns; ///< named as plan_fields() knows them; further values of a line are not read
  std::size_t header_line = 0;    ///< number of the line that named them; 0: none did
  bool header_is_data = false;    ///< the header is no comment: it must be passed over
  bool colmap = false;            ///< points3D.txt, whose lines go on with the images that see the point
};

/// Finds the layout by the first lines of the text, at most a thousand of points. Columns are named by a header, a line
/// of names or a comment with as many names as there are columns, or else by what nearly all (98 %) of the lines hold:
/// x y z first; three columns of unit length are a normal; three of whole numbers 0..255, else 0..65535, or of
/// fractions 0..1 are red green blue; one more is intensity, unless it holds one number only.
/// `first_line`: number of the line at `begin`. Throws Error(input) with the line: bytes that are no text, nothing but
/// comments, lines of fewer than three numbers, lines whose lengths differ; lists of images and cameras of COLMAP.
TextLayout find_text_layout(const char* begin, const char* end, std::size_t first_line, const std::string& file);

/// How the lines of a table are told apart.
enum class TextLine {
  blank, ///< empty, or a comment: # or // or, where it does not separate, ;
  count, ///< one whole number: how many points follow
  values,
};
TextLine kind_of_line(std::string_view line, TextSeparator separator);

} // namespace pointgi
