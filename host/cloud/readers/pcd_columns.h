#pragma once
/// The values of a PCD point by name, and where they are.
#include "host/cloud/readers/pcd_header.h"
#include "host/cloud/readers/record_values.h"

namespace pointgi {

struct PcdColumn {
  FieldInfo info;
  std::size_t place = 0;       ///< number of the value in a line of text
  std::size_t field_begin = 0; ///< byte of its field in a record
  std::size_t field_bytes = 0; ///< of its field, in a record
  std::size_t byte = 0;        ///< of the value in its field
  bool packs_in_float = false; ///< declared a float whose bits are 0xAARRGGBB; info says u32
};

/// Padding, and fields of more than 16 values, are not among them.
std::vector<PcdColumn> pcd_columns(const PcdHeader& header);

/// The colour packed in what a text shows for a field that is declared a float: newer files write the integer itself.
double packed_in_text(double value);

} // namespace pointgi
