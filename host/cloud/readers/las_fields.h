#pragma once
/// What a point record of LAS holds: the dimensions of its format and the extra bytes behind them.
#include "host/cloud/field.h"
#include "host/cloud/readers/las_header.h"
#include "host/cloud/readers/record_values.h"
#include <array>

namespace pointgi {

/// A dimension and where it is in a record.
struct LasColumn {
  FieldInfo info;        ///< type of the stored value, its scale and offset
  std::size_t byte = 0;  ///< of the record
  unsigned shift = 0;    ///< a value of some bits: those from this one on ...
  unsigned bits = 0;     ///< ... so many; 0: the whole type
  bool is_extra = false; ///< of the extra bytes
};

/// The value of a dimension, its scale and offset applied.
inline double las_value(const char* record, const LasColumn& column) {
  double value = value_at(record + column.byte, column.info.type);
  if (column.bits != 0) value = (static_cast<unsigned>(value) >> column.shift) & ((1u << column.bits) - 1u);
  return value * column.info.scale + column.info.offset;
}

constexpr std::size_t las_extra_entry = 192; ///< bytes of an entry of the record LASF_Spec 4

/// One of its entries.
struct LasExtra {
  std::string name; ///< at most 32 bytes
  FieldType type = FieldType::u8;
  std::size_t values = 1; ///< of this type, one behind the other
  bool undefined = false; ///< bytes whose meaning is not told
  std::array<double, 3> scale{1, 1, 1};
  std::array<double, 3> offset{0, 0, 0};
  std::array<char, las_extra_entry> entry{}; ///< as the file has it
  std::size_t bytes() const { return values * size_of(type); }
};

/// The entries, in the order of their bytes; none where the file has no such record. What does not fit into a point
/// record is left out, with a warning.
std::vector<LasExtra> read_las_extras(const InputFile& file, const LasHeader& header,
                                      std::vector<std::string>& warnings);

/// x y z intensity return_number number_of_returns … as laspy calls them, red green blue nir where the format has them,
/// then the extra ones; of three values name0 name1 name2. Bytes that nobody describes are extra_bytes0 … (the first
/// 16).
std::vector<LasColumn> las_columns(const LasHeader& header, const std::vector<LasExtra>& extras);

} // namespace pointgi
