#include "host/cloud/readers/las_write.h"
#include "host/atomic_file.h"
#include "host/cloud/readers/las_fields.h"
#include "host/cloud/readers/las_records.h"
#include "host/run.h"
#include <algorithm>
#include <cmath>
#include <limits>

namespace pointgi {

namespace {

constexpr std::size_t piece_bytes = 1 << 20;
constexpr std::size_t vlr_head = 54; ///< bytes of a variable length record before its content

/// A column and the byte of the new record at which its values go.
struct Placed {
  const Field* column;
  std::size_t byte;
};

struct Layout {
  std::size_t record_bytes = 0; ///< of the new records
  std::vector<Placed> columns;
  std::vector<std::array<char, las_extra_entry>> entries; ///< of the new Extra Bytes record
};

template <class Value>
void put(char* to, Value value) {
  static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "values are copied as they are to lie in the file");
  std::memcpy(to, &value, sizeof value);
}

template <class Whole>
void put_whole(char* to, double value) {
  constexpr auto low = static_cast<double>(std::numeric_limits<Whole>::min());
  constexpr auto high = static_cast<double>(std::numeric_limits<Whole>::max());
  Whole whole = 0;
  if (value <= low)
    whole = std::numeric_limits<Whole>::min();
  else if (value >= high)
    whole = std::numeric_limits<Whole>::max();
  else if (!std::isnan(value))
    whole = static_cast<Whole>(std::round(value));
  put(to, whole);
}

void put_value(char* to, FieldType type, double value) {
  switch (type) {
  case FieldType::i8:
    return put_whole<std::int8_t>(to, value);
  case FieldType::u8:
    return put_whole<std::uint8_t>(to, value);
  case FieldType::i16:
    return put_whole<std::int16_t>(to, value);
  case FieldType::u16:
    return put_whole<std::uint16_t>(to, value);
  case FieldType::i32:
    return put_whole<std::int32_t>(to, value);
  case FieldType::u32:
    return put_whole<std::uint32_t>(to, value);
  case FieldType::i64:
    return put_whole<std::int64_t>(to, value);
  case FieldType::u64:
    return put_whole<std::uint64_t>(to, value);
  case FieldType::f32:
    return put(to, static_cast<float>(value));
  case FieldType::f64:
    return put(to, value);
  }
}

/// The number of a type in the record LASF_Spec 4.
char code_of(FieldType type) {
  static constexpr std::array<FieldType, 10> types{FieldType::u8,  FieldType::i8,  FieldType::u16, FieldType::i16,
                                                   FieldType::u32, FieldType::i32, FieldType::u64, FieldType::i64,
                                                   FieldType::f32, FieldType::f64};
  return static_cast<char>(std::find(types.begin(), types.end(), type) - types.begin() + 1);
}

std::array<char, las_extra_entry> entry_of(const FieldInfo& info) {
  std::array<char, las_extra_entry> entry{};
  const std::string description = "written by pointgi";
  entry[2] = code_of(info.type);
  entry[3] = static_cast<char>((info.scale != 1.0 ? 8 : 0) | (info.offset != 0.0 ? 16 : 0));
  std::copy(info.name.begin(), info.name.end(), &entry[4]);
  if (info.scale != 1.0) put(&entry[112], info.scale);
  if (info.offset != 0.0) put(&entry[136], info.offset);
  std::copy(description.begin(), description.end(), &entry[160]);
  return entry;
}

/// Bytes that nobody described need an entry now, for those behind them to be found.
void describe_unknown(std::size_t bytes, Layout& layout) {
  for (int number = 0; bytes > 0; ++number) {
    const std::size_t part = std::min<std::size_t>(bytes, 255);
    std::array<char, las_extra_entry> entry = entry_of({"unknown" + std::to_string(number), FieldType::u8, 1.0, 0.0});
    entry[2] = 0; // undefined: the options are their number
    entry[3] = static_cast<char>(part);
    layout.entries.push_back(entry);
    bytes -= part;
  }
}

/// Where the bytes of an extra dimension of this name are already, or nothing.
void place_column(const Field& column, const std::vector<LasExtra>& extras, std::size_t extra_begin,
                  const std::string& source, Layout& layout) {
  std::size_t byte = extra_begin;
  for (std::size_t e = 0; e < extras.size(); byte += extras[e].bytes(), ++e) {
    if (extras[e].name != column.info.name) continue;
    if (extras[e].undefined || extras[e].values != 1 || extras[e].type != column.info.type)
      throw Error(ErrorKind::input, source + ": has extra bytes " + quoted_bytes(column.info.name) +
                                        " of another type already; start from a file without them");
    layout.columns.push_back({&column, byte});
    layout.entries[e] = entry_of(column.info);
    return;
  }
  layout.columns.push_back({&column, layout.record_bytes});
  layout.entries.push_back(entry_of(column.info));
  layout.record_bytes += size_of(column.info.type);
}

Layout plan_records(const InputFile& file, const LasHeader& header, const std::vector<Field>& columns) {
  Layout layout;
  std::vector<std::string> ignored; // the reader has told them
  const std::vector<LasExtra> extras = read_las_extras(file, header, ignored);
  const std::size_t extra_begin = las_record_bytes(header.format);
  std::size_t described = 0;
  for (const LasExtra& extra : extras) {
    layout.entries.push_back(extra.entry);
    described += extra.bytes();
  }
  describe_unknown(header.record_bytes - extra_begin - described, layout);
  layout.record_bytes = header.record_bytes;
  for (const Field& column : columns)
    place_column(column, extras, extra_begin, file.path(), layout);
  if (layout.record_bytes > 65535 || layout.entries.size() * las_extra_entry > 65535)
    throw Error(ErrorKind::input, file.path() + ": its records have no room for " + std::to_string(columns.size()) +
                                      " more values; write a PLY file instead");
  return layout;
}

void copy_bytes(const InputFile& from, std::uint64_t begin, std::uint64_t end, AtomicFile& to) {
  std::vector<char> piece;
  for (; begin < end; begin += piece.size()) {
    piece.resize(static_cast<std::size_t>(std::min<std::uint64_t>(end - begin, piece_bytes)));
    from.read(begin, piece.data(), piece.size());
    to.write(piece.data(), piece.size());
  }
}

/// Copies a part of the file that variable length records lie in; those of `gone` keep their place and become LASF_Spec
/// 7, superseded.
void copy_records(const InputFile& from, std::uint64_t begin, std::uint64_t end, const std::vector<const LasVlr*>& gone,
                  AtomicFile& to) {
  for (const LasVlr* vlr : gone) {
    if (vlr->begin < begin || vlr->begin + vlr_head > end) continue;
    copy_bytes(from, begin, vlr->begin + 2, to);
    std::array<char, 18> superseded{};
    const std::string user = "LASF_Spec";
    std::copy(user.begin(), user.end(), superseded.begin());
    put(&superseded[16], std::uint16_t{7});
    to.write(superseded.data(), superseded.size());
    begin = vlr->begin + 20;
  }
  copy_bytes(from, begin, end, to);
}

/// What the file has behind its points, from this byte on.
std::uint64_t tail_of(const InputFile& file, const LasHeader& header) {
  if (!header.is_compressed) return header.points_begin + header.points * header.record_bytes;
  return header.vlrs.size() > header.vlrs_before ? header.vlrs[header.vlrs_before].begin : file.size();
}

/// The Extra Bytes record, its head as it was where there was one.
std::vector<char> extra_vlr(const InputFile& file, const LasVlr* old, const Layout& layout) {
  std::vector<char> vlr(vlr_head, '\0');
  if (old != nullptr) {
    file.read(old->begin, vlr.data(), vlr.size());
  } else {
    const std::string user = "LASF_Spec", description = "Extra Bytes";
    std::copy(user.begin(), user.end(), &vlr[2]);
    put(&vlr[18], std::uint16_t{4});
    std::copy(description.begin(), description.end(), &vlr[22]);
  }
  put(&vlr[20], static_cast<std::uint16_t>(layout.entries.size() * las_extra_entry));
  for (const auto& entry : layout.entries)
    vlr.insert(vlr.end(), entry.begin(), entry.end());
  return vlr;
}

/// What an old header says of places, counts and compression, made true of the new file.
std::vector<char> new_header(const InputFile& file, const LasHeader& header, const Layout& layout,
                             std::uint64_t points_begin, std::size_t vlr_count) {
  std::vector<char> bytes(header.header_bytes);
  file.read(0, bytes.data(), bytes.size());
  if (points_begin > std::numeric_limits<std::uint32_t>::max())
    throw Error(ErrorKind::input, file.path() + ": its variable length records leave no room for another; write a "
                                                "PLY file instead");
  put(&bytes[96], static_cast<std::uint32_t>(points_begin));
  put(&bytes[100], static_cast<std::uint32_t>(vlr_count));
  bytes[104] = static_cast<char>(header.format);
  put(&bytes[105], static_cast<std::uint16_t>(layout.record_bytes));
  const bool counts_in_32_bits = little_endian<std::uint32_t>(&bytes[107]) != 0;
  if (counts_in_32_bits) put(&bytes[107], static_cast<std::uint32_t>(header.points));
  const std::uint64_t old_tail = tail_of(file, header), tail = points_begin + header.points * layout.record_bytes;
  const auto move_on = [&](std::size_t at) {
    if (const auto place = little_endian<std::uint64_t>(&bytes[at]); place != 0)
      put(&bytes[at], place - old_tail + tail);
  };
  if (header.minor >= 3 && bytes.size() >= 235) move_on(227); // waveforms
  if (header.has_wide_count) {
    move_on(235); // extended variable length records
    put(&bytes[247], header.points);
  }
  return bytes;
}

void write_head(const InputFile& file, const LasHeader& header, const Layout& layout, const LasVlr* old,
                const std::vector<const LasVlr*>& gone, AtomicFile& out) {
  const bool in_place = old != nullptr && old < header.vlrs.data() + header.vlrs_before;
  std::vector<char> vlr;
  if (!layout.entries.empty()) vlr = extra_vlr(file, in_place ? old : nullptr, layout);
  const std::uint64_t old_begin = in_place ? old->begin : header.vlrs_end;
  const std::uint64_t old_end = in_place && !vlr.empty() ? old->data + old->bytes : old_begin;
  const std::vector<char> head =
      new_header(file, header, layout, header.points_begin + vlr.size() - (old_end - old_begin),
                 header.vlrs_before + (in_place || vlr.empty() ? 0 : 1));
  out.write(head.data(), head.size());
  copy_records(file, header.header_bytes, old_begin, gone, out);
  out.write(vlr.data(), vlr.size());
  copy_records(file, old_end, header.points_begin, gone, out);
}

void put_colour(char* to, const Eigen::Vector3f& colour) {
  if (!colour.allFinite()) return;
  for (int k = 0; k < 3; ++k)
    put_whole<std::uint16_t>(to + 2 * k, 65535.0 * static_cast<double>(std::clamp(colour[k], 0.0f, 1.0f)));
}

void write_points(const InputFile& file, const LasHeader& header, const Layout& layout,
                  const std::vector<Eigen::Vector3f>& colour, AtomicFile& out) {
  const std::size_t old_bytes = header.record_bytes, new_bytes = layout.record_bytes;
  const std::size_t colour_byte = las_colour_byte(header.format);
  std::vector<char> to;
  LasRecords(file, header).for_each_piece_in_order([&](std::size_t first, std::size_t end, const char* from) {
    stop_if_asked();
    to.resize((end - first) * new_bytes);
    for (std::size_t i = first; i < end; ++i, from += old_bytes) {
      char* record = &to[(i - first) * new_bytes];
      std::copy_n(from, old_bytes, record);
      if (!colour.empty() && colour_byte != 0) put_colour(record + colour_byte, colour[i]);
      for (const Placed& placed : layout.columns) {
        const FieldInfo& info = placed.column->info;
        put_value(record + placed.byte, info.type, (placed.column->values[i] - info.offset) / info.scale);
      }
    }
    out.write(to.data(), to.size());
  });
}

/// Records that are not true of the new file: of the compression that is gone, of the places of compressed points
/// (COPC), and the extra bytes that another one declares now.
std::vector<const LasVlr*> superseded(const LasHeader& header, const LasVlr* extra) {
  std::vector<const LasVlr*> gone;
  for (const LasVlr& vlr : header.vlrs) {
    const bool is_packing = header.is_compressed && (vlr.user == "laszip encoded" || vlr.user == "copc");
    const bool is_late_extra = &vlr == extra && &vlr >= header.vlrs.data() + header.vlrs_before;
    if (is_packing || is_late_extra) gone.push_back(&vlr);
  }
  std::sort(gone.begin(), gone.end(), [](const LasVlr* a, const LasVlr* b) { return a->begin < b->begin; });
  return gone;
}

/// Such a mismatch is a fault of the caller's, not of the user's.
void check(const LasHeader& header, const std::string& path, const std::vector<Field>& columns,
           const std::vector<Eigen::Vector3f>& colour) {
  const auto fail = [&](const std::string& what) { throw Error(ErrorKind::internal, path + ": writing " + what); };
  const auto expect = [&](const std::string& what, std::size_t length) {
    if (length != header.points)
      fail(what + ": " + std::to_string(length) + " values for " + std::to_string(header.points) + " points");
  };
  if (!colour.empty()) expect("colours", colour.size());
  for (const Field& column : columns) {
    expect("column " + column.info.name, column.values.size());
    if (column.info.name.empty() || column.info.name.size() > 32)
      fail("\"" + column.info.name + "\": no name for extra bytes, which has 1 to 32 bytes");
  }
}

} // namespace

bool las_holds_colour(const std::string& path) {
  return las_colour_byte(read_las_header(InputFile(path), true).format) != 0;
}

void write_las_with_columns(const std::string& source_las, const std::string& output, const std::vector<Field>& columns,
                            const std::vector<Eigen::Vector3f>& colour) {
  const InputFile file(source_las);
  const LasHeader header = read_las_header(file, true);
  check(header, output, columns, colour);
  const Layout layout = plan_records(file, header, columns);
  const LasVlr* old = header.find("LASF_Spec", 4);
  const std::vector<const LasVlr*> gone = superseded(header, old);
  AtomicFile out(output);
  write_head(file, header, layout, old, gone, out);
  write_points(file, header, layout, colour, out);
  copy_records(file, tail_of(file, header), file.size(), gone, out);
  out.commit();
}

} // namespace pointgi
