#pragma once
/// The points of one scan of an E57 file: a compressed vector, which holds each field as a stream of bits of its own,
/// cut into packets.
#include "host/cloud/field.h"
#include "host/cloud/readers/e57_file.h"
#include "host/cloud/readers/xml_tree.h"

namespace pointgi {

/// A field of the prototype. Stored integers take as many bits as their bounds need.
struct E57Field {
  std::string name; ///< "cartesianX", "nor:normalX"
  bool is_float = false;
  unsigned bits = 0;        ///< of a stored value: 32 or 64 of floats, 0 to 64 of integers
  std::int64_t minimum = 0; ///< of the stored integers
  std::int64_t maximum = 0;
  double scale = 1.0; ///< value = stored integer times scale plus offset
  double offset = 0.0;

  /// The type that holds its values: the narrowest integer, or a float.
  FieldType type() const;
};

/// What an element of type CompressedVector says.
struct E57Points {
  std::uint64_t begin = 0; ///< logical byte of its section
  std::uint64_t count = 0; ///< of records
  std::vector<E57Field> fields;

  /// Index of the field, or fields.size().
  std::size_t find(const char* name) const;
};

/// `node`: the element points of a scan. Throws Error(input): attributes or a prototype that are missing or senseless,
/// more records than the file has bits.
E57Points parse_e57_points(const E57File& file, const XmlNode& node);

/// The bits of the fields that are wanted, of all records.
class E57Streams {
public:
  /// `wanted`: one flag a field. Throws Error(input) naming the byte: no such section, packets that break the rules,
  /// fewer values than records.
  E57Streams(const E57File& file, const E57Points& points, const std::vector<bool>& wanted);

  double value(std::size_t field, std::uint64_t record) const;

private:
  const std::vector<E57Field>& fields_;
  std::vector<std::vector<char>> bytes_; ///< one stream a field, and eight bytes to spare
};

} // namespace pointgi
