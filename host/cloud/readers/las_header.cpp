#include "host/cloud/readers/las_header.h"
#include "host/cloud/readers/record_values.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pointgi {

namespace {

// Bytes of the header.
constexpr std::size_t at_encoding = 6, at_major = 24, at_minor = 25, at_header_bytes = 94, at_points_begin = 96,
                      at_vlr_count = 100, at_format = 104, at_record_bytes = 105, at_count = 107, at_scale = 131,
                      at_offset = 155, at_waveforms = 227, at_evlr_begin = 235, at_evlr_count = 243,
                      at_wide_count = 247;
constexpr std::size_t shortest_header = 227, header_of_1_4 = 375;

[[noreturn]] void fail(const InputFile& file, std::size_t byte, const std::string& what) {
  throw Error(ErrorKind::input, file.path() + ": byte " + std::to_string(byte) + ": " + what);
}

using std::to_string;

bool begins_as_las(const char* data, std::size_t size) {
  return size >= 4 && std::equal(data, data + 4, "LASF");
}

/// The header's bytes, those that an older version lacks as zeros.
using HeaderBytes = std::array<char, header_of_1_4>;

HeaderBytes read_bytes(const InputFile& file) {
  HeaderBytes bytes{};
  const auto present = static_cast<std::size_t>(std::min<std::uint64_t>(file.size(), bytes.size()));
  file.read(0, bytes.data(), present);
  if (!begins_as_las(bytes.data(), present))
    fail(file, 0,
         "expected \"LASF\", found " + quoted_bytes({bytes.data(), std::min<std::size_t>(present, 4)}) +
             "; the file is no LAS file");
  if (present < shortest_header)
    fail(file, present, "the file ends within its header of " + to_string(shortest_header) + " bytes; it is truncated");
  return bytes;
}

void read_layout(const InputFile& file, const HeaderBytes& bytes, bool may_be_compressed, LasHeader& header) {
  const int major = static_cast<unsigned char>(bytes[at_major]);
  header.minor = static_cast<unsigned char>(bytes[at_minor]);
  if (major != 1)
    fail(file, at_major, "version " + to_string(major) + "." + to_string(header.minor) + ", expected 1.0 to 1.4");
  if (header.minor > 4)
    header.warnings.push_back("the file is of LAS version 1." + to_string(header.minor) +
                              "; it was read as version 1.4. Save it as 1.4 if the points look wrong.");
  header.is_compressed = is_laz(bytes.data(), bytes.size());
  const unsigned format = static_cast<unsigned char>(bytes[at_format]) & (header.is_compressed ? 0x3fu : 0xffu);
  if (header.is_compressed && !may_be_compressed)
    fail(file, at_format,
         "the points are compressed (LAZ), expected plain LAS; convert the file with `scripts/import " + file.path() +
             " OUT.ply`");
  if (format > 10) fail(file, at_format, "point format " + to_string(format) + ", expected 0 to 10");
  header.format = format;
  header.record_bytes = little_endian<std::uint16_t>(&bytes[at_record_bytes]);
  if (header.record_bytes < las_record_bytes(format))
    fail(file, at_record_bytes,
         "records of " + to_string(header.record_bytes) + " bytes, expected " + to_string(las_record_bytes(format)) +
             " or more for point format " + to_string(format));
  header.header_bytes = little_endian<std::uint16_t>(&bytes[at_header_bytes]);
  if (header.header_bytes < shortest_header)
    fail(file, at_header_bytes,
         "a header of " + to_string(header.header_bytes) + " bytes, expected " + to_string(shortest_header) +
             " or more");
  header.has_wide_count = header.minor >= 4 && header.header_bytes >= header_of_1_4;
  header.points_begin = little_endian<std::uint32_t>(&bytes[at_points_begin]);
  if (header.points_begin < header.header_bytes || header.points_begin > file.size())
    fail(file, at_points_begin,
         "the points begin at byte " + to_string(header.points_begin) + ", expected " + to_string(header.header_bytes) +
             " to " + to_string(file.size()) + "; the file is truncated or corrupt");
  header.says_wkt = (little_endian<std::uint16_t>(&bytes[at_encoding]) & 16) != 0;
  for (int k = 0; k < 3; ++k) {
    const std::size_t axis = 8 * static_cast<std::size_t>(k);
    header.scale[k] = little_endian<double>(&bytes[at_scale + axis]);
    header.offset[k] = little_endian<double>(&bytes[at_offset + axis]);
    if (!std::isfinite(header.scale[k]) || header.scale[k] == 0.0)
      fail(file, at_scale + axis, "a scale of " + to_string(header.scale[k]) + ", expected a number other than 0");
    if (!std::isfinite(header.offset[k])) fail(file, at_offset + axis, "an offset that is no number");
  }
}

/// Files of version 1.4 have two counts; older programs fill one, some fill both and differ.
void choose_count(const InputFile& file, const HeaderBytes& bytes, LasHeader& header) {
  const std::uint64_t narrow = little_endian<std::uint32_t>(&bytes[at_count]);
  const std::uint64_t wide = header.has_wide_count ? little_endian<std::uint64_t>(&bytes[at_wide_count]) : 0;
  // How many compressed points there can be is known to their decoder.
  const std::uint64_t room = header.is_compressed ? std::numeric_limits<std::uint64_t>::max()
                                                  : (file.size() - header.points_begin) / header.record_bytes;
  const bool wide_counts = wide != 0 && (wide <= room || narrow == 0 || narrow > room);
  header.points = wide_counts ? wide : narrow;
  const std::size_t place = wide_counts ? at_wide_count : at_count;
  if (header.points == 0)
    fail(file, place,
         "the header counts 0 points" +
             (room > 0 && !header.is_compressed
                  ? ", though the file has room for " + to_string(room) +
                        "; the program that wrote it was stopped before its end, write it again"
                  : std::string("; the cloud is empty")));
  if (header.points > room)
    fail(file, place,
         "the header counts " + to_string(header.points) + " points of " + to_string(header.record_bytes) +
             " bytes from byte " + to_string(header.points_begin) + " on, the file has room for " + to_string(room) +
             "; it is truncated or corrupt");
  if (header.points > std::numeric_limits<std::uint32_t>::max())
    fail(file, place,
         to_string(header.points) + " points, expected at most 4294967295; thin the cloud out or split it");
  if (narrow != 0 && wide != 0 && narrow != wide)
    header.warnings.push_back("the header counts " + to_string(narrow) + " points at byte 107 and " + to_string(wide) +
                              " at byte 247; " + to_string(header.points) +
                              " were read. Save the file again with a program that sets both if points are missing.");
  const bool nothing_follows = (header.minor < 3 || little_endian<std::uint64_t>(&bytes[at_waveforms]) == 0) &&
                               (!header.has_wide_count || little_endian<std::uint32_t>(&bytes[at_evlr_count]) == 0);
  if (nothing_follows && header.points < room && !header.is_compressed)
    header.warnings.push_back("the file has room for " + to_string(room) + " points, its header counts " +
                              to_string(header.points) +
                              ", which were read. Repair the header, for example with `lasinfo -repair`, if points "
                              "are missing.");
}

std::string name_in(const char* bytes, std::size_t most) {
  return {bytes, static_cast<std::size_t>(std::find(bytes, bytes + most, '\0') - bytes)};
}

/// Reads `count` records from `begin` on that lie before `limit`, and returns where they end.
std::uint64_t read_vlrs(const InputFile& file, std::uint64_t begin, std::uint64_t limit, std::uint64_t count,
                        bool extended, LasHeader& header) {
  // As many as nobody has; a file full of empty records costs no time.
  constexpr std::uint64_t most = 10000;
  const std::size_t head_bytes = extended ? 60 : 54;
  std::array<char, 60> head{};
  for (std::uint64_t i = 0; i < std::min(count, most); ++i) {
    LasVlr vlr;
    vlr.begin = begin;
    vlr.data = begin + head_bytes;
    if (begin > limit || limit - begin < head_bytes) break;
    file.read(begin, head.data(), head_bytes);
    vlr.user = name_in(&head[2], 16);
    vlr.id = little_endian<std::uint16_t>(&head[18]);
    vlr.bytes = extended ? little_endian<std::uint64_t>(&head[20]) : little_endian<std::uint16_t>(&head[20]);
    if (vlr.bytes > limit - vlr.data) break;
    begin = vlr.data + vlr.bytes;
    header.vlrs.push_back(std::move(vlr));
  }
  const std::size_t read = header.vlrs.size() - header.vlrs_before;
  if (read < count)
    header.warnings.push_back("the header counts " + to_string(count) + (extended ? " extended" : "") +
                              " variable length records, " + to_string(read) +
                              " are there; what the others say of the points is not known.");
  return begin;
}

} // namespace

const LasVlr* LasHeader::find(const char* user, std::uint16_t id) const {
  const auto found =
      std::find_if(vlrs.begin(), vlrs.end(), [&](const LasVlr& vlr) { return vlr.user == user && vlr.id == id; });
  return found == vlrs.end() ? nullptr : &*found;
}

bool is_las(const char* data, std::size_t size) {
  return begins_as_las(data, size) && !is_laz(data, size);
}

bool is_laz(const char* data, std::size_t size) {
  // LASzip marks the format with its upper bits, which no format of the standard uses.
  return begins_as_las(data, size) && size > at_format && (static_cast<unsigned char>(data[at_format]) & 0xc0) != 0;
}

std::size_t las_record_bytes(unsigned format) {
  static constexpr std::array<std::size_t, 11> bytes{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
  return bytes.at(format);
}

std::size_t las_colour_byte(unsigned format) {
  static constexpr std::array<std::size_t, 11> byte{0, 0, 20, 28, 0, 28, 0, 30, 30, 0, 30};
  return byte.at(format);
}

LasHeader read_las_header(const InputFile& file, bool may_be_compressed) {
  LasHeader header;
  const HeaderBytes bytes = read_bytes(file);
  read_layout(file, bytes, may_be_compressed, header);
  choose_count(file, bytes, header);
  header.vlrs_end = read_vlrs(file, header.header_bytes, header.points_begin,
                              little_endian<std::uint32_t>(&bytes[at_vlr_count]), false, header);
  header.vlrs_before = header.vlrs.size();
  if (header.has_wide_count)
    read_vlrs(file, little_endian<std::uint64_t>(&bytes[at_evlr_begin]), file.size(),
              little_endian<std::uint32_t>(&bytes[at_evlr_count]), true, header);
  return header;
}

} // namespace pointgi
