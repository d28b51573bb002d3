#include "host/cloud/readers/las_fields.h"
#include <algorithm>
#include <cmath>

namespace pointgi {

namespace {

/// A dimension of the standard: the whole type, or `bits` bits from `shift` on.
struct Dimension {
  const char* name;
  std::size_t byte;
  FieldType type;
  unsigned shift = 0;
  unsigned bits = 0;
  double scale = 1.0;
};

/// Of formats 0 to 5, behind x y z.
constexpr Dimension early[] = {{"intensity", 12, FieldType::u16},
                               {"return_number", 14, FieldType::u8, 0, 3},
                               {"number_of_returns", 14, FieldType::u8, 3, 3},
                               {"scan_direction_flag", 14, FieldType::u8, 6, 1},
                               {"edge_of_flight_line", 14, FieldType::u8, 7, 1},
                               {"classification", 15, FieldType::u8, 0, 5},
                               {"synthetic", 15, FieldType::u8, 5, 1},
                               {"key_point", 15, FieldType::u8, 6, 1},
                               {"withheld", 15, FieldType::u8, 7, 1},
                               {"scan_angle", 16, FieldType::i8},
                               {"user_data", 17, FieldType::u8},
                               {"point_source_id", 18, FieldType::u16}};

/// Of formats 6 to 10; the angle is in steps of 0.006 degrees.
constexpr Dimension late[] = {{"intensity", 12, FieldType::u16},
                              {"return_number", 14, FieldType::u8, 0, 4},
                              {"number_of_returns", 14, FieldType::u8, 4, 4},
                              {"synthetic", 15, FieldType::u8, 0, 1},
                              {"key_point", 15, FieldType::u8, 1, 1},
                              {"withheld", 15, FieldType::u8, 2, 1},
                              {"overlap", 15, FieldType::u8, 3, 1},
                              {"scanner_channel", 15, FieldType::u8, 4, 2},
                              {"scan_direction_flag", 15, FieldType::u8, 6, 1},
                              {"edge_of_flight_line", 15, FieldType::u8, 7, 1},
                              {"classification", 16, FieldType::u8},
                              {"user_data", 17, FieldType::u8},
                              {"scan_angle", 18, FieldType::i16, 0, 0, 0.006},
                              {"point_source_id", 20, FieldType::u16},
                              {"gps_time", 22, FieldType::f64}};

LasColumn column_of(const Dimension& dimension) {
  LasColumn column;
  column.info = {dimension.name, dimension.type, dimension.scale, 0.0};
  column.byte = dimension.byte;
  column.shift = dimension.shift;
  column.bits = dimension.bits;
  return column;
}

void add_standard(const LasHeader& header, std::vector<LasColumn>& columns) {
  static const char* const axes[] = {"x", "y", "z"};
  for (int k = 0; k < 3; ++k) {
    LasColumn& column = columns.emplace_back();
    column.info = {axes[k], FieldType::i32, header.scale[k], header.offset[k]};
    column.byte = 4 * static_cast<std::size_t>(k);
  }
  const bool is_early = header.format <= 5;
  std::transform(is_early ? std::begin(early) : std::begin(late), is_early ? std::end(early) : std::end(late),
                 std::back_inserter(columns), column_of);
  if (header.format == 1 || (header.format >= 3 && header.format <= 5))
    columns.push_back(column_of({"gps_time", 20, FieldType::f64}));
  if (const std::size_t red = las_colour_byte(header.format); red != 0)
    for (std::size_t k = 0; k < 3; ++k) {
      static const char* const channels[] = {"red", "green", "blue"};
      columns.push_back(column_of({channels[k], red + 2 * k, FieldType::u16}));
    }
  if (header.format == 8 || header.format == 10) columns.push_back(column_of({"nir", 36, FieldType::u16}));
}

/// Types 1 to 10 are single values, 11 to 20 pairs, 21 to 30 triples of the same types (LAS 1.4 R14, table 24).
bool understand(unsigned type, std::size_t undefined_bytes, LasExtra& extra) {
  static constexpr FieldType types[] = {FieldType::u8,  FieldType::i8,  FieldType::u16, FieldType::i16, FieldType::u32,
                                        FieldType::i32, FieldType::u64, FieldType::i64, FieldType::f32, FieldType::f64};
  extra.undefined = type == 0;
  if (type > 30) return false;
  extra.type = type == 0 ? FieldType::u8 : types[(type - 1) % 10];
  extra.values = type == 0 ? undefined_bytes : (type - 1) / 10 + 1;
  return true;
}

/// Options say whether scale (bit 3) and offset (bit 4) count; some writers set the bits and leave zeros.
void read_scales(const char* entry, unsigned options, LasExtra& extra) {
  for (std::size_t k = 0; k < std::min<std::size_t>(extra.values, 3); ++k) {
    const auto scale = little_endian<double>(entry + 112 + 8 * k);
    const auto offset = little_endian<double>(entry + 136 + 8 * k);
    if ((options & 8) != 0 && std::isfinite(scale) && scale != 0.0) extra.scale[k] = scale;
    if ((options & 16) != 0 && std::isfinite(offset)) extra.offset[k] = offset;
  }
}

} // namespace

std::vector<LasExtra> read_las_extras(const InputFile& file, const LasHeader& header,
                                      std::vector<std::string>& warnings) {
  std::vector<LasExtra> extras;
  const LasVlr* vlr = header.find("LASF_Spec", 4);
  if (vlr == nullptr) return extras;
  std::size_t room = header.record_bytes - las_record_bytes(header.format);
  for (std::uint64_t at = 0; vlr->bytes - at >= las_extra_entry; at += las_extra_entry) {
    LasExtra extra;
    std::array<char, las_extra_entry>& entry = extra.entry;
    file.read(vlr->data + at, entry.data(), entry.size());
    const auto options = static_cast<unsigned char>(entry[3]);
    extra.name.assign(&entry[4], std::find(&entry[4], &entry[4] + 32, '\0'));
    const bool known = understand(static_cast<unsigned char>(entry[2]), options, extra);
    if (!known || extra.bytes() > room) {
      warnings.push_back("extra bytes from " + quoted_bytes(extra.name) + " on are not read: " +
                         (known ? "the point records are too short for them."
                                : "their type " + std::to_string(static_cast<unsigned char>(entry[2])) +
                                      " is not one of the standard's.") +
                         " Write the file again with a program that knows LAS 1.4 if they matter.");
      break;
    }
    if (extra.bytes() == 0) continue;
    room -= extra.bytes();
    if (!extra.undefined) read_scales(entry.data(), options, extra);
    extras.push_back(std::move(extra));
  }
  return extras;
}

std::vector<LasColumn> las_columns(const LasHeader& header, const std::vector<LasExtra>& extras) {
  constexpr std::size_t most_unknown = 16; // a record may have 65,000 bytes that nobody knows
  std::vector<LasColumn> columns;
  add_standard(header, columns);
  std::size_t byte = las_record_bytes(header.format);
  std::size_t unknown = 0;
  const auto add_unknown = [&](std::size_t end) {
    for (; byte < end; ++byte, ++unknown) {
      if (unknown >= most_unknown) continue;
      LasColumn& column = columns.emplace_back(column_of({"", byte, FieldType::u8}));
      column.info.name = "extra_bytes" + std::to_string(unknown);
      column.is_extra = true;
    }
  };
  for (const LasExtra& extra : extras) {
    if (extra.undefined) {
      add_unknown(byte + extra.bytes());
      continue;
    }
    for (std::size_t k = 0; k < extra.values; ++k, byte += size_of(extra.type)) {
      LasColumn& column = columns.emplace_back(column_of({"", byte, extra.type}));
      column.info.name = extra.name + (extra.values > 1 ? std::to_string(k) : "");
      column.info.scale = extra.scale[k];
      column.info.offset = extra.offset[k];
      column.is_extra = true;
    }
  }
  add_unknown(header.record_bytes);
  return columns;
}

} // namespace pointgi
