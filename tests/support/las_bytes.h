#pragma once
/// LAS files, byte for byte as a test wants them.
#include "tests/support/ply_bytes.h"
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace pointgi::test {

/// What a point record holds; formats take what they have a place for.
struct LasPoint {
  std::array<std::int32_t, 3> position{0, 0, 0};
  std::uint16_t intensity = 0;
  unsigned return_number = 1, returns = 1;
  unsigned classification = 0;
  bool withheld = false;
  std::int16_t angle = 0; ///< degrees in old formats, steps of 0.006 degrees in new ones
  std::uint8_t user_data = 0;
  std::uint16_t source = 0;
  double gps_time = 0.0;
  std::array<std::uint16_t, 3> colour{0, 0, 0};
  std::uint16_t nir = 0;
};

inline std::string las_record(unsigned format, const LasPoint& p) {
  std::string bytes;
  for (const std::int32_t axis : p.position)
    bytes += bytes_of(axis);
  bytes += bytes_of(p.intensity);
  const auto byte = [](unsigned value) { return std::string(1, static_cast<char>(value)); };
  if (format <= 5) {
    bytes += byte(p.return_number | p.returns << 3 | 1u << 6); // scan direction 1
    bytes += byte(p.classification | (p.withheld ? 0x80u : 0u));
    bytes += bytes_of(static_cast<std::int8_t>(p.angle)) + bytes_of(p.user_data) + bytes_of(p.source);
  } else {
    bytes += byte(p.return_number | p.returns << 4);
    bytes += byte((p.withheld ? 4u : 0u) | 2u << 4 | 1u << 6); // scanner channel 2, scan direction 1
    bytes += byte(p.classification) + bytes_of(p.user_data) + bytes_of(p.angle) + bytes_of(p.source);
  }
  if (format != 0 && format != 2) bytes += bytes_of(p.gps_time);
  const bool colours = format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10;
  for (std::size_t k = 0; colours && k < 3; ++k)
    bytes += bytes_of(p.colour[k]);
  if (format == 8 || format == 10) bytes += bytes_of(p.nir);
  if (format == 4 || format == 5 || format >= 9) bytes += std::string(29, '\x5a'); // a packet of a waveform
  return bytes;
}

inline std::string padded(const std::string& text, std::size_t bytes) {
  std::string result = text;
  result.resize(bytes, '\0');
  return result;
}

/// A variable length record; an extended one counts its content in 64 bits.
inline std::string las_vlr(const std::string& user, std::uint16_t id, const std::string& content,
                           bool extended = false) {
  return bytes_of<std::uint16_t>(0) + padded(user, 16) + bytes_of(id) +
         (extended ? bytes_of<std::uint64_t>(content.size()) : bytes_of(static_cast<std::uint16_t>(content.size()))) +
         padded("made by a test", 32) + content;
}

/// An entry of the record LASF_Spec 4. `type`: 0 to 30 of the standard. Options: 8 a scale, 16 an offset.
inline std::string las_extra_entry_bytes(const std::string& name, unsigned type, unsigned options = 0,
                                         std::array<double, 3> scale = {}, std::array<double, 3> offset = {}) {
  std::string bytes(2, '\0');
  bytes += static_cast<char>(type);
  bytes += static_cast<char>(options);
  bytes += padded(name, 32) + std::string(4 + 3 * 24, '\0');
  for (const auto& triple : {scale, offset})
    for (const double value : triple)
      bytes += bytes_of(value);
  return bytes + padded("an extra dimension", 32);
}

struct LasFile {
  unsigned minor = 2;
  unsigned format = 0;
  std::array<double, 3> scale{0.01, 0.01, 0.01};
  std::array<double, 3> offset{0, 0, 0};
  std::vector<LasPoint> points;
  std::vector<std::string> extra; ///< bytes behind each record, all of one length, or none
  std::vector<std::string> vlrs, evlrs;
  std::string before_points;    ///< bytes that belong to nothing
  std::int64_t count = -1;      ///< in 32 bits; -1: the points' number, 0 for formats 6 and above
  std::int64_t wide_count = -1; ///< in 64 bits; -1: the points' number
  std::uint16_t encoding = 0;

  std::size_t header_bytes() const { return minor >= 4 ? 375 : minor == 3 ? 235 : 227; }
  std::size_t record_bytes() const { return las_record(format, {}).size() + (extra.empty() ? 0 : extra[0].size()); }
  std::size_t points_begin() const {
    std::size_t bytes = header_bytes() + before_points.size();
    for (const std::string& vlr : vlrs)
      bytes += vlr.size();
    return bytes;
  }

  std::string bytes() const {
    std::string head = "LASF" + bytes_of<std::uint16_t>(0) + bytes_of(encoding) + std::string(16, '\0');
    head += static_cast<char>(1);
    head += static_cast<char>(minor);
    head += padded("pointgi", 32) + padded("a test", 32) + bytes_of<std::uint16_t>(1) + bytes_of<std::uint16_t>(2026);
    head += bytes_of(static_cast<std::uint16_t>(header_bytes())) + bytes_of(static_cast<std::uint32_t>(points_begin()));
    head += bytes_of(static_cast<std::uint32_t>(vlrs.size()));
    head += static_cast<char>(format);
    head += bytes_of(static_cast<std::uint16_t>(record_bytes()));
    const std::int64_t narrow = count >= 0    ? count
                                : format <= 5 ? static_cast<std::int64_t>(points.size())
                                              : std::int64_t{0};
    head += bytes_of(static_cast<std::uint32_t>(narrow)) + std::string(20, '\0');
    for (const auto& triple : {scale, offset})
      for (const double value : triple)
        head += bytes_of(value);
    for (int k = 0; k < 6; ++k)
      head += bytes_of(1e9); // bounds that are wrong
    const std::size_t points_end = points_begin() + points.size() * record_bytes();
    if (minor >= 3) head += bytes_of<std::uint64_t>(0);
    if (minor >= 4) {
      head +=
          bytes_of<std::uint64_t>(evlrs.empty() ? 0 : points_end) + bytes_of(static_cast<std::uint32_t>(evlrs.size()));
      head += bytes_of(wide_count >= 0 ? static_cast<std::uint64_t>(wide_count) : std::uint64_t{points.size()});
      head += std::string(120, '\0');
    }
    for (const std::string& vlr : vlrs)
      head += vlr;
    head += before_points;
    for (std::size_t i = 0; i < points.size(); ++i)
      head += las_record(format, points[i]) + (extra.empty() ? "" : extra[i]);
    for (const std::string& evlr : evlrs)
      head += evlr;
    return head;
  }
};

} // namespace pointgi::test
