#pragma once
/// What a LAS file says before its points: header (ASPRS LAS specification 1.0 to 1.4) and variable length records.
/// Nothing is allocated by its counts.
#include "host/cloud/input_file.h"
#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

namespace pointgi {

/// A variable length record, before the points or (extended) behind them.
struct LasVlr {
  std::string user;        ///< e.g. "LASF_Projection"
  std::uint16_t id = 0;    ///< what it is, among those of this user
  std::uint64_t begin = 0; ///< byte of the file at which it begins
  std::uint64_t data = 0;  ///< byte at which its content begins
  std::uint64_t bytes = 0; ///< of its content, all of them in the file
};

struct LasHeader {
  int minor = 0;                  ///< version 1.minor
  unsigned format = 0;            ///< of the point records, 0 to 10
  std::size_t header_bytes = 0;   ///< the first variable length record begins here
  std::uint64_t vlrs_end = 0;     ///< byte behind the last variable length record before the points
  std::uint64_t points_begin = 0; ///< byte of the first point record
  std::size_t record_bytes = 0;   ///< of a point record, its format's and extra ones
  std::uint64_t points = 0;       ///< at least 1; the file has as many records, unless they are compressed
  Eigen::Vector3d scale;          ///< position = stored integer times scale plus offset
  Eigen::Vector3d offset;
  bool is_compressed = false;  ///< LAZ: points_begin is where their compressed bytes begin
  bool has_wide_count = false; ///< the 64-bit count of points of version 1.4
  bool says_wkt = false;       ///< coordinates are described by text, not by GeoKeys
  std::vector<LasVlr> vlrs;    ///< those before the points first, in file order
  std::size_t vlrs_before = 0; ///< how many of them lie before the points
  std::vector<std::string> warnings;

  /// The first record of that user and number, or null.
  const LasVlr* find(const char* user, std::uint16_t id) const;
};

/// Whether the first bytes of a file are those of a LAS file.
bool is_las(const char* data, std::size_t size);
/// Whether they are those of one whose points are compressed.
bool is_laz(const char* data, std::size_t size);

/// Bytes of a point record of a format (0 to 10) without extra bytes.
std::size_t las_record_bytes(unsigned format);
/// Whether a format has red, green and blue, and at which byte of the record. 0: it has none.
std::size_t las_colour_byte(unsigned format);

/// Throws Error(input) "<file>: byte N: …" where the file is no LAS, without points or shorter than its header says, or
/// compressed unless that `may_be_compressed`. Bounds are not looked at: they are often wrong.
LasHeader read_las_header(const InputFile& file, bool may_be_compressed = false);

} // namespace pointgi
