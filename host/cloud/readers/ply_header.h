#pragma once
/// The header of a PLY file: what the body holds and where it begins. Nothing is allocated by its counts.
#include "host/cloud/field.h"
#include "host/cloud/input_file.h"
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace pointgi {

enum class PlyFormat { ascii, binary_little_endian, binary_big_endian };
const char* name_of(PlyFormat format);

struct PlyProperty {
  std::string name;
  FieldType type = FieldType::f32;
  bool is_list = false;
  FieldType count_type = FieldType::u8; ///< of a list: never a float
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::size_t line = 0; ///< of its declaration
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements; ///< in file order; names differ
  std::size_t body_offset = 0;      ///< the byte after the one line end of end_header
  std::size_t body_line = 0;        ///< number of the line that begins there
  int up = -1;                      ///< axis of a line "comment pointgi up z", as scripts/import writes; -1: none
};

/// Reads the header from the first `size` bytes at `data`. Lines end in LF, CRLF or CR, as the first one does.
/// Throws Error(input): "<file>: line N: what was expected, what was found".
PlyHeader parse_ply_header(const char* data, std::size_t size, const std::string& file);

/// As parse_ply_header(), of as much of the file as the header takes. Headers of more than 64 MiB are refused.
PlyHeader read_ply_header(const InputFile& file);

/// Throws Error(input) when the elements cannot fit into the bytes after the header, whatever these hold: a record
/// takes at least the sizes of its scalars and list counts (binary) or two bytes a value (ascii: a digit, a blank).
void check_ply_counts(const PlyHeader& header, std::uint64_t file_size, const std::string& file);

} // namespace pointgi
