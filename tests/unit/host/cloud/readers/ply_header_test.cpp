#include "host/cloud/readers/ply_header.h"
#include "host/error.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using Catch::Matchers::Contains;

namespace {

PlyHeader parse(const std::string& text) {
  return parse_ply_header(text.data(), text.size(), "cloud.ply");
}

/// The text of the input error that `text` must raise as a header, its counts included.
std::string complaint(const std::string& text) {
  try {
    const PlyHeader header = parse(text);
    check_ply_counts(header, text.size(), "cloud.ply");
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::input);
    return error.what();
  }
  FAIL("accepted: " << text.substr(0, 200));
  return "";
}

const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
const std::string start = "ply\nformat ascii 1.0\n";

} // namespace

TEST_CASE("ply header: elements, properties and where the body begins") {
  const std::string text = "ply\nformat binary_big_endian 1.0\ncomment hello  there\nobj_info any\nelement vertex 7\n" +
                           xyz +
                           "element face 2\nproperty list uchar int32 vertex_indices\nproperty float64 q\n"
                           "end_header\n";
  const PlyHeader header = parse(text + "BODY");
  CHECK(header.format == PlyFormat::binary_big_endian);
  REQUIRE(header.elements.size() == 2);
  CHECK(header.elements[0].name == "vertex");
  CHECK(header.elements[0].count == 7);
  CHECK(header.elements[0].line == 5);
  CHECK(header.elements[0].properties.size() == 3);
  const std::vector<PlyProperty>& face = header.elements[1].properties;
  REQUIRE(face.size() == 2);
  CHECK(face[0].is_list);
  CHECK(face[0].count_type == FieldType::u8);
  CHECK(face[0].type == FieldType::i32);
  CHECK(face[1].type == FieldType::f64);
  CHECK(header.body_offset == text.size());
  CHECK(header.body_line == 13);
}

TEST_CASE("ply header: all sixteen type names") {
  const std::vector<std::pair<std::string, FieldType>> types{
      {"char", FieldType::i8},   {"int8", FieldType::i8},     {"uchar", FieldType::u8},   {"uint8", FieldType::u8},
      {"short", FieldType::i16}, {"int16", FieldType::i16},   {"ushort", FieldType::u16}, {"uint16", FieldType::u16},
      {"int", FieldType::i32},   {"int32", FieldType::i32},   {"uint", FieldType::u32},   {"uint32", FieldType::u32},
      {"float", FieldType::f32}, {"float32", FieldType::f32}, {"double", FieldType::f64}, {"float64", FieldType::f64}};
  for (const auto& [name, type] : types)
    CHECK(parse(start + "element vertex 0\nproperty " + name + " x\nend_header\n").elements[0].properties[0].type ==
          type);
  CHECK(size_of(FieldType::u16) == 2);
  CHECK(size_of(FieldType::f64) == 8);
  CHECK(std::string(name_of(FieldType::f32)) == "float");
}

TEST_CASE("ply header: lines end in LF or CRLF or CR and the body begins after one line end") {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string text;
    for (const std::string line : {"ply", "format binary_little_endian 1.0", "element vertex 1", "property uchar x",
                                   "property uchar y", "property uchar z", "end_header"})
      text += line + end;
    // First bytes that look like line ends are data.
    for (const std::string body : {"\n\n\n", "\r\r\r", "\r\nx"}) {
      if (end == "\r" && body[0] == '\n') continue; // looked at below: the first line has settled what ends lines
      CHECK(parse(text + body).body_offset == text.size());
    }
    CHECK(parse(text + "\n\r\n").body_offset == text.size());
  }
}

TEST_CASE("ply header: tabs and runs of blanks and blank lines are no matter") {
  const PlyHeader header =
      parse("ply \nformat\t ascii   1.0\t\n\ncomment\n \telement   vertex\t3 \nproperty  float\tx\nend_header \n");
  CHECK(header.elements[0].count == 3);
  CHECK(header.elements[0].properties[0].name == "x");
}

TEST_CASE("ply header: what is wrong is named with its line") {
  struct Case {
    std::string text, says;
  };
  const std::string vertex = start + "element vertex 1\n";
  const std::vector<Case> cases{
      {"", "line 1: the file is empty"},
      {"ply", "line 1: the file ends after \"ply\""},
      {"ply\n", "line 2: the file ends before end_header"},
      {"ply\r", "line 2: the file ends before end_header"},
      {"plyx\nformat ascii 1.0\n", "line 1: not a PLY file"},
      {" ply\nformat ascii 1.0\n", "line 1: not a PLY file"},
      {"LASF\x01\x02", "\"LASF\\x01\\x02\""},
      {"ply\nelement vertex 1\n" + xyz + "end_header\n0 0 0\n", "without a line like \"format"},
      {start + "format ascii 1.0\nend_header\n", "line 3: a second format line"},
      {"ply\nformat ascii\n", "line 2: expected \"format"},
      {"ply\nformat binary 1.0\n", "line 2: expected format ascii, binary_little_endian or binary_big_endian"},
      {"ply\nformat ascii 2.0\n", "expected PLY version 1.0, found \"2.0\""},
      {vertex + xyz, "line 7: the file ends before end_header"},
      {vertex + "property quad x\n", "line 4: unknown type \"quad\""},
      {vertex + "property float\n", "line 4: expected \"property TYPE NAME\""},
      {vertex + "property float x y\n", "line 4: expected \"property TYPE NAME\""},
      {vertex + "property list float int a\n", "count must be of an integer type"},
      {vertex + "property float x\nproperty double x\n", "line 5: element \"vertex\" has two properties \"x\""},
      {start + "property float x\n", "line 3: a property before the first element"},
      {start + "element vertex\n", "line 3: expected \"element NAME COUNT\""},
      {vertex + xyz + "element vertex 2\n", "line 7: element \"vertex\" was declared in line 3 already"},
      {vertex + "end_header\n", "has no property"},
      {start + "elements vertex 1\n", "line 3: expected format, comment"},
      {start + "element vertex 1\nproperty float \x1b[31m\xff\n" + xyz + "end_header now\n", "line 8: expected format"},
      {start + std::string("elem\0ent vertex 1\n", 18), "elem\\x00ent"},
  };
  for (const Case& c : cases) {
    INFO(c.text.substr(0, 200));
    CHECK_THAT(complaint(c.text), Contains("cloud.ply: line ") && Contains(c.says));
  }
}

TEST_CASE("ply header: counts are judged before anything is allocated") {
  const auto with_count = [](const std::string& count) {
    return start + "element vertex " + count + "\n" + xyz + "end_header\n0 0 0\n";
  };
  for (const std::string count :
       {"2147483648", "4294967297", "9223372036854775808", "18446744073709551615", "100", "2"})
    CHECK_THAT(complaint(with_count(count)), Contains("line 3: element \"vertex\" announces " + count + " records"));
  CHECK_THAT(complaint(with_count("18446744073709551616")), Contains("line 3") && Contains("larger than any file"));
  for (const std::string count : {"-1", "1e30", "1.0", "0x10", "many", "+1"})
    CHECK_THAT(complaint(with_count(count)), Contains("line 3") && Contains("in digits, found \"" + count + "\""));
  // One record of three values takes 5 bytes without a line end: exactly enough is enough.
  const std::string exact = with_count("1").substr(0, with_count("1").size() - 1);
  check_ply_counts(parse(exact), exact.size(), "cloud.ply");
  CHECK_THAT(complaint(exact.substr(0, exact.size() - 1)), Contains("truncated"));

  // Two elements that fit one by one but not together; and list counts count.
  const std::string binary = "ply\nformat binary_little_endian 1.0\nelement vertex 2\n" + xyz +
                             "element face 3\nproperty list ushort int vertex_indices\nend_header\n";
  check_ply_counts(parse(binary), binary.size() + 30, "cloud.ply");
  CHECK_THAT(complaint(binary + std::string(29, 'x')), Contains("element \"face\" announces 3 records of at least 2"));
}

TEST_CASE("ply header: a line of a megabyte is a comment or a short complaint") {
  const std::string megabyte(1 << 20, 'x');
  CHECK(parse(start + "comment " + megabyte + "\nelement vertex 0\nend_header\n").elements.size() == 1);
  const std::string text = complaint(start + megabyte + "\n");
  CHECK_THAT(text, Contains("line 3"));
  CHECK(text.size() < 500); // an error is read by a person
  CHECK_THAT(complaint("ply\n" + megabyte), Contains("line 2"));
}

TEST_CASE("ply header: ten thousand properties") {
  std::string text = start + "element vertex 0\n";
  for (int i = 0; i < 10000; ++i)
    text += "property float p" + std::to_string(i) + "\n";
  CHECK(parse(text + "end_header\n").elements[0].properties.size() == 10000);
}
