#pragma once
/// Bytes of E57 files, for tests that need files with exact contents.
#include "tests/support/ply_bytes.h"
#include <cstdint>
#include <vector>

namespace pointgi::test {

/// A stream of values of any number of bits, the lowest first.
class BitStream {
public:
  BitStream& put(std::uint64_t value, unsigned bits) {
    for (unsigned bit = 0; bit < bits; ++bit, ++count_) {
      if (count_ % 8 == 0) bytes_ += '\0';
      bytes_.back() = static_cast<char>(bytes_.back() | static_cast<char>((value >> bit & 1) << count_ % 8));
    }
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

private:
  std::string bytes_;
  std::size_t count_ = 0;
};

constexpr std::size_t e57_content = 1020; // bytes of a page of 1024 before its checksum

inline std::uint64_t e57_physical(std::uint64_t logical) {
  return logical / e57_content * 1024 + logical % e57_content;
}

/// Pages with their checksums around logical bytes.
inline std::string e57_pages(std::string logical) {
  logical.resize((logical.size() + e57_content - 1) / e57_content * e57_content, '\0');
  std::string file;
  for (std::size_t begin = 0; begin < logical.size(); begin += e57_content) {
    std::uint32_t crc = 0xffffffff;
    for (std::size_t i = begin; i < begin + e57_content; ++i) {
      crc ^= static_cast<unsigned char>(logical[i]);
      for (int bit = 0; bit < 8; ++bit)
        crc = crc >> 1 ^ (crc & 1 ? 0x82f63b78u : 0u);
    }
    file += logical.substr(begin, e57_content) + bytes_of(~crc, true);
  }
  return file;
}

inline std::string e57_data_packet(const std::vector<std::string>& streams) {
  std::string lengths, body;
  for (const std::string& stream : streams) {
    lengths += bytes_of(static_cast<std::uint16_t>(stream.size()));
    body += stream;
  }
  std::size_t size = 6 + lengths.size() + body.size();
  body.resize(body.size() + (4 - size % 4) % 4, '\0');
  size = 6 + lengths.size() + body.size();
  return std::string("\1\0", 2) + bytes_of(static_cast<std::uint16_t>(size - 1)) +
         bytes_of(static_cast<std::uint16_t>(streams.size())) + lengths + body;
}

/// What stands before the pages are made: header, sections, description.
class E57Bytes {
public:
  /// A section of these packets; its byte of the file, for fileOffset.
  std::uint64_t add_section(const std::string& packets) {
    const std::uint64_t begin = logical_.size();
    logical_ += std::string("\1\0\0\0\0\0\0\0", 8) + bytes_of<std::uint64_t>(32 + packets.size()) +
                bytes_of<std::uint64_t>(e57_physical(begin + 32)) + bytes_of<std::uint64_t>(0) + packets;
    return e57_physical(begin);
  }
  /// `scans`: the content of the element data3D.
  std::string finish(const std::string& scans) {
    const std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!-- made by a test --><e57Root "
                            "type=\"Structure\"><formatName type=\"String\"><![CDATA[ASTM E57 3D Imaging Data "
                            "File]]></formatName><data3D type=\"Vector\">" +
                            scans + "</data3D></e57Root>\n";
    const std::uint64_t begin = logical_.size();
    logical_ += xml;
    const std::uint64_t pages = (logical_.size() + e57_content - 1) / e57_content;
    logical_.replace(0, 48,
                     "ASTM-E57" + bytes_of<std::uint32_t>(1) + bytes_of<std::uint32_t>(0) +
                         bytes_of<std::uint64_t>(1024 * pages) + bytes_of<std::uint64_t>(e57_physical(begin)) +
                         bytes_of<std::uint64_t>(xml.size()) + bytes_of<std::uint64_t>(1024));
    return logical_;
  }

private:
  std::string logical_ = std::string(48, '\0');
};

/// An element of a prototype.
inline std::string e57_integer_field(const std::string& name, long minimum, long maximum) {
  return "<" + name + " type=\"Integer\" minimum=\"" + std::to_string(minimum) + "\" maximum=\"" +
         std::to_string(maximum) + "\"/>";
}

inline std::string e57_scan(std::uint64_t offset, std::size_t records, const std::string& prototype,
                            const std::string& more) {
  return "<vectorChild type=\"Structure\">" + more + "<points type=\"CompressedVector\" fileOffset=\"" +
         std::to_string(offset) + "\" recordCount=\"" + std::to_string(records) + "\"><prototype type=\"Structure\">" +
         prototype + "</prototype><codecs type=\"Vector\"/></points></vectorChild>";
}

/// Two stations. The first at 10 20 30, turned by a quarter about z: spherical, three records of which the second is
/// invalid, 8-bit colours, intensities of 10 bits in steps of 1/4, its streams cut into two packets within a value and
/// packets of other kinds between. The second without a pose: cartesian, one record with a 16-bit colour and a normal.
inline std::string e57_two_stations() {
  const double half = 0.70710678118654752, quarter = 1.57079632679489662;
  E57Bytes file;
  std::string range, azimuth, elevation;
  for (const double value : {1.0, 9.0, 2.0})
    range += bytes_of(value);
  for (const double value : {0.0, 0.0, quarter})
    azimuth += bytes_of(value);
  for (const double value : {0.0, 0.0, quarter / 3})
    elevation += bytes_of(value);
  const std::string intensity = BitStream().put(1, 10).put(0, 10).put(1023, 10).bytes();
  const std::string state = BitStream().put(0, 2).put(2, 2).put(0, 2).bytes();
  const std::string red = "\xff" + std::string(2, '\0'), green = std::string(2, '\0') + "\x33";
  const std::string blue; // 0 to 0 takes no bits
  const std::string index = std::string("\0\0\x0f\0", 4) + std::string(12, '\0');
  const std::string empty = std::string("\2\0\3\0", 4);
  const std::string packets =
      e57_data_packet(
          {range.substr(0, 5), azimuth, elevation.substr(0, 9), intensity.substr(0, 1), state, red, green, blue}) +
      index + empty + e57_data_packet({range.substr(5), "", elevation.substr(9), intensity.substr(1), "", "", "", ""});
  const std::string real = " type=\"Float\"/>";
  const std::string prototype =
      "<sphericalRange" + real + "<sphericalAzimuth" + real + "<sphericalElevation" + real +
      "<intensity type=\"ScaledInteger\" minimum=\"-1\" maximum=\"1022\" scale=\"0.25\" offset=\"0.5\"/>" +
      e57_integer_field("sphericalInvalidState", 0, 2) + e57_integer_field("colorRed", 0, 255) +
      e57_integer_field("colorGreen", 0, 255) + e57_integer_field("colorBlue", 0, 0);
  const std::string pose = "<pose type=\"Structure\"><rotation type=\"Structure\"><w type=\"Float\">" +
                           std::to_string(half) + "</w><x type=\"Float\"/><z type=\"Float\">" + std::to_string(half) +
                           "</z></rotation><translation type=\"Structure\"><x type=\"Float\">10</x><y "
                           "type=\"Float\">2e1</y><z type=\"ScaledInteger\" scale=\"10\">3</z></translation></pose>";
  std::string scans = e57_scan(file.add_section(packets), 3, prototype, pose);
  std::vector<std::string> streams;
  for (const double value : {4e6 + 0.125, 5.0, 6.0})
    streams.push_back(bytes_of(value));
  for (const int value : {65535, 32768, 0})
    streams.push_back(bytes_of(static_cast<std::uint16_t>(value)));
  for (const float value : {0.0f, 0.6f, 0.8f})
    streams.push_back(bytes_of(value));
  std::string second;
  for (const char* axis : {"X", "Y", "Z"})
    second += std::string("<cartesian") + axis + real;
  for (const char* channel : {"colorRed", "colorGreen", "colorBlue"})
    second += e57_integer_field(channel, 0, 65535);
  for (const char* axis : {"X", "Y", "Z"})
    second += std::string("<nor:normal") + axis + " type=\"Float\" precision=\"single\"/>";
  scans += e57_scan(file.add_section(e57_data_packet(streams)), 1, second, "<name>a &lt; b</name>");
  return file.finish(scans);
}

} // namespace pointgi::test
