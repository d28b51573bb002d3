#include "host/cloud/readers/e57_points.h"
#include "host/cloud/readers/e57_node.h"
#include "host/cloud/readers/record_values.h"
#include <algorithm>
#include <array>
#include <limits>

namespace pointgi {

namespace {

constexpr std::size_t section_bytes = 32, packet_head_bytes = 6;
constexpr std::size_t most_fields = 1000;
enum PacketType : unsigned char { index_packet = 0, data_packet = 1, empty_packet = 2 };

/// Bits that tell the whole numbers of a range apart.
unsigned bits_of_range(std::int64_t minimum, std::int64_t maximum) {
  std::uint64_t range = static_cast<std::uint64_t>(maximum) - static_cast<std::uint64_t>(minimum);
  unsigned bits = 0;
  for (; range > 0; range >>= 1)
    ++bits;
  return bits;
}

E57Field parse_field(const E57File& file, const XmlNode& node) {
  E57Field field;
  field.name = node.name;
  const std::string type = e57_type(node);
  if (type == "Float") {
    const std::string* precision = node.attribute("precision");
    field.is_float = true;
    field.bits = precision != nullptr && *precision == "single" ? 32 : 64;
    return field;
  }
  if (type != "Integer" && type != "ScaledInteger")
    file.fail(file.xml_begin(), "the field " + quoted_bytes(node.name) + " of the points is of type " +
                                    quoted_bytes(type) + ", expected Float, Integer or ScaledInteger");
  const auto least = std::numeric_limits<std::int64_t>::min();
  const auto most = std::numeric_limits<std::int64_t>::max();
  field.minimum = e57_integer(file, node, "minimum", least);
  field.maximum = e57_integer(file, node, "maximum", most);
  if (field.minimum > field.maximum)
    file.fail(file.xml_begin(), "the minimum of the field " + quoted_bytes(node.name) + " is above its maximum");
  field.bits = bits_of_range(field.minimum, field.maximum);
  if (type == "ScaledInteger") {
    field.scale = e57_real(file, node, "scale", 1.0);
    field.offset = e57_real(file, node, "offset", 0.0);
  }
  return field;
}

/// The bytes of one packet, which end with it.
struct Packet {
  const char* bytes;
  std::uint64_t place; ///< logical byte of the file
  std::size_t size;
};

/// Hands the parts of a data packet on to the streams.
void take_packet(const E57File& file, const Packet& packet, const std::vector<bool>& wanted,
                 std::vector<std::vector<char>>& streams) {
  const std::size_t count = little_endian<std::uint16_t>(packet.bytes + 4);
  if (count != streams.size() || packet_head_bytes + 2 * count > packet.size)
    file.fail(packet.place + 4, "a packet of " + std::to_string(count) + " streams, expected " +
                                    std::to_string(streams.size()) + "; the file is corrupt");
  std::size_t at = packet_head_bytes + 2 * count;
  for (std::size_t f = 0; f < count; ++f) {
    const std::size_t length = little_endian<std::uint16_t>(packet.bytes + packet_head_bytes + 2 * f);
    if (length > packet.size - at)
      file.fail(packet.place + packet_head_bytes + 2 * f,
                "a stream of " + std::to_string(length) + " bytes goes beyond its packet; the file is corrupt");
    if (wanted[f]) streams[f].insert(streams[f].end(), packet.bytes + at, packet.bytes + at + length);
    at += length;
  }
}

std::uint64_t bytes_of_values(const E57Field& field, std::uint64_t count) {
  return (count * field.bits + 7) / 8;
}

} // namespace

FieldType E57Field::type() const {
  if (is_float) return bits == 32 ? FieldType::f32 : FieldType::f64;
  if (scale != 1.0 || offset != 0.0) return FieldType::f64;
  if (minimum < 0) return minimum >= -32768 && maximum <= 32767 ? FieldType::i16 : FieldType::f64;
  if (maximum <= 255) return FieldType::u8;
  if (maximum <= 65535) return FieldType::u16;
  return maximum <= 0xffffffff ? FieldType::u32 : FieldType::f64;
}

std::size_t E57Points::find(const char* name) const {
  return static_cast<std::size_t>(
      std::find_if(fields.begin(), fields.end(), [&](const E57Field& field) { return field.name == name; }) -
      fields.begin());
}

E57Points parse_e57_points(const E57File& file, const XmlNode& node) {
  E57Points points;
  const XmlNode* prototype = node.child("prototype");
  if (e57_type(node) != "CompressedVector" || prototype == nullptr)
    file.fail(file.xml_begin(), "the points of a scan are no CompressedVector with a prototype");
  points.count = static_cast<std::uint64_t>(std::max<std::int64_t>(0, e57_integer(file, node, "recordCount", 0)));
  for (const XmlNode& field : prototype->children) {
    if (points.fields.size() >= most_fields) file.fail(file.xml_begin(), "a scan has more than 1000 fields");
    points.fields.push_back(parse_field(file, field));
  }
  std::uint64_t bits = 0;
  for (const E57Field& field : points.fields)
    bits += field.bits;
  if (points.count == 0) return points;
  if (bits == 0) file.fail(file.xml_begin(), "the points of a scan have no field that varies");
  if (points.count > 8 * file.bytes() / bits)
    file.fail(file.xml_begin(), "a scan announces " + std::to_string(points.count) + " records of " +
                                    std::to_string(bits) +
                                    " bits, which a file of this size cannot hold; it is "
                                    "truncated or corrupt");
  points.begin =
      file.logical(static_cast<std::uint64_t>(e57_integer(file, node, "fileOffset", -1)), "a scan's section");
  return points;
}

E57Streams::E57Streams(const E57File& file, const E57Points& points, const std::vector<bool>& wanted)
    : fields_(points.fields), bytes_(points.fields.size()) {
  std::array<char, section_bytes> section{};
  file.read(points.begin, section.data(), section.size());
  if (section[0] != 1) file.fail(points.begin, "expected the section of a scan's points (1), found another");
  std::uint64_t at = file.logical(little_endian<std::uint64_t>(&section[16]), "a scan's first packet");
  const std::uint64_t length = little_endian<std::uint64_t>(&section[8]);
  const std::uint64_t end = points.begin + std::min(length, file.bytes() - points.begin);
  for (std::size_t f = 0; f < fields_.size(); ++f)
    if (wanted[f]) bytes_[f].reserve(bytes_of_values(fields_[f], points.count) + 8);
  std::vector<char> packet;
  while (at + 4 <= end) {
    std::array<char, 4> head{};
    file.read(at, head.data(), head.size());
    const std::size_t size = std::size_t{1} + little_endian<std::uint16_t>(&head[2]);
    const auto type = static_cast<unsigned char>(head[0]);
    if (type > empty_packet || size > end - at || size < (type == data_packet ? packet_head_bytes : head.size()))
      file.fail(at, "a packet of type " + std::to_string(type) + " with " + std::to_string(size) +
                        " bytes cannot be here; the file is corrupt");
    if (type == data_packet) {
      packet.resize(size);
      file.read(at, packet.data(), size);
      take_packet(file, {packet.data(), at, size}, wanted, bytes_);
    }
    at += size;
  }
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    if (!wanted[f]) continue;
    if (bytes_[f].size() < bytes_of_values(fields_[f], points.count))
      file.fail(points.begin, "the field " + quoted_bytes(fields_[f].name) + " has " +
                                  std::to_string(bytes_[f].size()) + " bytes, expected " +
                                  std::to_string(bytes_of_values(fields_[f], points.count)) + " for " +
                                  std::to_string(points.count) + " records; the file is truncated or corrupt");
    bytes_[f].resize(bytes_[f].size() + 8, '\0');
  }
}

double E57Streams::value(std::size_t f, std::uint64_t record) const {
  const E57Field& field = fields_[f];
  const char* bytes = bytes_[f].data();
  if (field.is_float)
    return field.bits == 32 ? static_cast<double>(little_endian<float>(bytes + 4 * record))
                            : little_endian<double>(bytes + 8 * record);
  std::uint64_t stored = 0;
  if (field.bits > 0) {
    const std::uint64_t bit = record * field.bits;
    const unsigned shift = static_cast<unsigned>(bit % 8);
    stored = little_endian<std::uint64_t>(bytes + bit / 8) >> shift;
    // More than 57 bits may begin too late for eight bytes.
    if (shift + field.bits > 64)
      stored |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[bit / 8 + 8])) << (64 - shift);
    if (field.bits < 64) stored &= (std::uint64_t{1} << field.bits) - 1;
  }
  const auto integer = static_cast<std::int64_t>(static_cast<std::uint64_t>(field.minimum) + stored);
  return static_cast<double>(integer) * field.scale + field.offset;
}

} // namespace pointgi
