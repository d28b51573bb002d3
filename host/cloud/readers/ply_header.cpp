#include "host/cloud/readers/ply_header.h"
#include "host/cloud/input_file.h"
#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <string_view>
#include <unordered_set>

namespace pointgi {

namespace {

struct TypeName {
  const char* name;
  FieldType type;
};
constexpr std::array<TypeName, 16> type_names{{{"char", FieldType::i8},
                                               {"uchar", FieldType::u8},
                                               {"short", FieldType::i16},
                                               {"ushort", FieldType::u16},
                                               {"int", FieldType::i32},
                                               {"uint", FieldType::u32},
                                               {"float", FieldType::f32},
                                               {"double", FieldType::f64},
                                               {"int8", FieldType::i8},
                                               {"uint8", FieldType::u8},
                                               {"int16", FieldType::i16},
                                               {"uint16", FieldType::u16},
                                               {"int32", FieldType::i32},
                                               {"uint32", FieldType::u32},
                                               {"float32", FieldType::f32},
                                               {"float64", FieldType::f64}}};

std::vector<std::string_view> words_of(std::string_view line) {
  constexpr std::string_view blanks = " \t\r\v\f";
  std::vector<std::string_view> words;
  std::size_t at = line.find_first_not_of(blanks);
  while (at != std::string_view::npos) {
    const std::size_t end = line.find_first_of(blanks, at);
    words.push_back(line.substr(at, end - at));
    at = end == std::string_view::npos ? end : line.find_first_not_of(blanks, end);
  }
  return words;
}

class HeaderParser {
public:
  HeaderParser(const char* data, std::size_t size, const std::string& file) : text_(data, size), file_(file) {}

  PlyHeader parse() {
    check_magic();
    while (true) {
      const std::string_view line = next_line();
      const std::vector<std::string_view> words = words_of(line);
      if (words.empty() || words[0] == "obj_info") continue;
      if (words[0] == "comment")
        read_comment(words);
      else if (words[0] == "format")
        read_format(words);
      else if (words[0] == "element")
        read_element(words);
      else if (words[0] == "property")
        read_property(words);
      else if (words[0] == "end_header" && words.size() == 1)
        break;
      else
        fail("expected format, comment, obj_info, element, property or end_header, found " + quoted_bytes(line));
    }
    if (!has_format_)
      fail("the header ends without a line like \"format binary_little_endian 1.0\"; add it after \"ply\"");
    for (const PlyElement& element : header_.elements)
      if (element.properties.empty() && element.count > 0)
        fail("element " + quoted_bytes(element.name) + " of line " + std::to_string(element.line) +
             " has no property; give it one or remove it");
    header_.body_offset = at_;
    header_.body_line = line_ + 1;
    return std::move(header_);
  }

private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorKind::input, file_ + ": line " + std::to_string(line_) + ": " + what);
  }

  void check_magic() {
    line_ = 1;
    if (text_.empty()) fail("the file is empty, expected a PLY file that begins with \"ply\"");
    const std::size_t end = text_.find_first_of("\r\n");
    const std::string_view first = text_.substr(0, end);
    const std::vector<std::string_view> words = words_of(first);
    if (words.size() != 1 || words[0] != "ply" || first[0] != 'p')
      fail("not a PLY file: expected \"ply\", found " + quoted_bytes(first) +
           "; if it holds points in another format, give it that format's extension (las, laz, e57, pcd, ptx, pts, "
           "xyz, csv, splat, spz)");
    if (end == std::string_view::npos)
      fail("the file ends after \"ply\", expected a header with a \"format\" line; the file is truncated");
    // "\r" alone ends lines only where the first one does it: a payload may begin with 0x0A or 0x0D, and then the
    // line end of end_header must be known without a look at what follows it.
    const bool carriage_return = text_[end] == '\r' && (end + 1 >= text_.size() || text_[end + 1] != '\n');
    line_end_ = carriage_return ? '\r' : '\n';
    at_ = text_.find(line_end_) + 1;
  }

  std::string_view next_line() {
    ++line_;
    if (at_ >= text_.size()) fail("the file ends before end_header; it is truncated");
    const std::size_t end = text_.find(line_end_, at_);
    const std::string_view line = text_.substr(at_, end - at_);
    // A last line without its end can only be complete when it is end_header; the counts then tell the rest.
    at_ = end == std::string_view::npos ? text_.size() : end + 1;
    return line;
  }

  /// A comment may say anything: what is not understood is no error.
  void read_comment(const std::vector<std::string_view>& words) {
    if (words.size() == 4 && words[1] == "pointgi" && words[2] == "up" && words[3].size() == 1 && words[3][0] >= 'x' &&
        words[3][0] <= 'z')
      header_.up = words[3][0] - 'x';
  }

  void read_format(const std::vector<std::string_view>& words) {
    if (has_format_) fail("a second format line; remove one of them");
    if (words.size() != 3) fail("expected \"format ascii|binary_little_endian|binary_big_endian 1.0\"");
    if (words[1] == "ascii")
      header_.format = PlyFormat::ascii;
    else if (words[1] == "binary_little_endian")
      header_.format = PlyFormat::binary_little_endian;
    else if (words[1] == "binary_big_endian")
      header_.format = PlyFormat::binary_big_endian;
    else
      fail("expected format ascii, binary_little_endian or binary_big_endian, found " + quoted_bytes(words[1]));
    if (words[2] != "1.0")
      fail("expected PLY version 1.0, found " + quoted_bytes(words[2]) + "; save the file again as PLY 1.0");
    has_format_ = true;
  }

  void read_element(const std::vector<std::string_view>& words) {
    if (words.size() != 3) fail("expected \"element NAME COUNT\", found " + std::to_string(words.size()) + " words");
    PlyElement element;
    element.name = words[1];
    element.line = line_;
    const char* end = words[2].data() + words[2].size();
    const auto [stop, error] = std::from_chars(words[2].data(), end, element.count);
    if (error == std::errc::result_out_of_range)
      fail("element " + quoted_bytes(words[1]) + ": the count " + quoted_bytes(words[2]) + " is larger than any file");
    if (error != std::errc() || stop != end)
      fail("element " + quoted_bytes(words[1]) + ": expected a count of 0 or more in digits, found " +
           quoted_bytes(words[2]));
    for (const PlyElement& other : header_.elements)
      if (other.name == element.name)
        fail("element " + quoted_bytes(words[1]) + " was declared in line " + std::to_string(other.line) +
             " already; an element may stand once");
    // The comparison above is quadratic in the elements; no sane file has more than a dozen.
    if (header_.elements.size() >= 1000) fail("more than 1000 elements; this is no PLY file that a scanner wrote");
    header_.elements.push_back(std::move(element));
    property_names_.clear();
  }

  void read_property(const std::vector<std::string_view>& words) {
    if (header_.elements.empty())
      fail("a property before the first element; expected \"element vertex COUNT\" above it");
    PlyProperty property;
    if (words.size() == 3) {
      property.type = read_type(words[1]);
    } else if (words.size() == 5 && words[1] == "list") {
      property.is_list = true;
      property.count_type = read_type(words[2]);
      if (is_float(property.count_type))
        fail("a list's count must be of an integer type, found " + quoted_bytes(words[2]));
      property.type = read_type(words[3]);
    } else {
      fail("expected \"property TYPE NAME\" or \"property list TYPE TYPE NAME\", found " +
           std::to_string(words.size()) + " words");
    }
    property.name = words.back();
    if (!property_names_.insert(property.name).second)
      fail("element " + quoted_bytes(header_.elements.back().name) + " has two properties " +
           quoted_bytes(property.name) + "; rename or remove one");
    header_.elements.back().properties.push_back(std::move(property));
  }

  FieldType read_type(std::string_view word) const {
    for (const TypeName& known : type_names)
      if (word == known.name) return known.type;
    fail("unknown type " + quoted_bytes(word) +
         ", expected char, uchar, short, ushort, int, uint, float, double (or int8 ... float64)");
  }

  std::string_view text_;
  const std::string& file_;
  std::size_t at_ = 0;
  std::size_t line_ = 0;
  char line_end_ = '\n';
  bool has_format_ = false;
  PlyHeader header_;
  std::unordered_set<std::string> property_names_; ///< of the element being declared
};

} // namespace

const char* name_of(PlyFormat format) {
  switch (format) {
  case PlyFormat::ascii:
    return "ascii";
  case PlyFormat::binary_little_endian:
    return "binary_little_endian";
  case PlyFormat::binary_big_endian:
    return "binary_big_endian";
  }
  return "unknown";
}

PlyHeader parse_ply_header(const char* data, std::size_t size, const std::string& file) {
  return HeaderParser(data, size, file).parse();
}

PlyHeader read_ply_header(const InputFile& file) {
  constexpr std::uint64_t longest = std::uint64_t{64} << 20;
  std::vector<char> start;
  for (std::uint64_t bytes = 65536;; bytes *= 8) {
    start.resize(static_cast<std::size_t>(std::min({bytes, longest, file.size()})));
    file.read(0, start.data(), start.size());
    const bool is_all = start.size() == file.size() || std::string_view(start.data(), 3) != "ply";
    try {
      PlyHeader header = parse_ply_header(start.data(), start.size(), file.path());
      // One that ends where we stopped may have its last line end after that.
      if (is_all || header.body_offset < start.size()) return header;
    } catch (const Error&) {
      if (is_all) throw;
    }
    if (bytes >= longest)
      throw Error(ErrorKind::input, file.path() + ": line 1: the header does not end within 64 MiB, or has a fault in "
                                                  "these; this is no PLY file that a scanner wrote");
  }
}

void check_ply_counts(const PlyHeader& header, std::uint64_t file_size, const std::string& file) {
  const bool ascii = header.format == PlyFormat::ascii;
  // The last line of an ascii file may lack its end: one byte of grace.
  std::uint64_t left = file_size - header.body_offset + (ascii ? 1 : 0);
  for (const PlyElement& element : header.elements) {
    std::uint64_t record = 0;
    for (const PlyProperty& property : element.properties)
      record += ascii ? 2 : size_of(property.is_list ? property.count_type : property.type);
    // By division, as the product may be larger than 2^64.
    if (record > 0 && element.count > left / record)
      throw Error(ErrorKind::input, file + ": line " + std::to_string(element.line) + ": element " +
                                        quoted_bytes(element.name) + " announces " + std::to_string(element.count) +
                                        " records of at least " + std::to_string(record) + " bytes, but only " +
                                        std::to_string(left) +
                                        " bytes are left for them; the file is truncated or the count is wrong");
    left -= element.count * record;
  }
}

} // namespace pointgi
