#pragma once
/// LAS files with more in them than they had: for results that belong to the points of a scan.
#include "host/cloud/field.h"
#include <Eigen/Core>
#include <string>
#include <vector>

namespace pointgi {

/// Whether the point format of the LAS file has red, green and blue. Throws Error(input).
bool las_holds_colour(const std::string& path);

/// Writes `source_las` again as `output`: the same version, point format, header, variable length records and point
/// records, byte for byte, with `columns` behind each record as extra bytes, declared in the Extra Bytes record
/// (LASF_Spec 4), which keeps what it has. A column has the type, scale and offset of its info and a value for each
/// record of the file, in its order; integers are rounded and clamped, NaN becomes 0 in them. A name is at most 32
/// bytes; where the file has extra bytes of that name and type they are written over, so that a second run leaves one
/// of each. `colour` ([0,1], as the file is to have it; empty: none) replaces red, green and blue, 16 bit, where the
/// format has them; a colour that is not finite leaves the record's own. Atomic: `output` may be `source_las`. Throws
/// Error(input) when the source cannot be read or has no room for so many extra bytes,
/// Error(output), and Error(internal) where lengths differ from the points' number.
void write_las_with_columns(const std::string& source_las, const std::string& output, const std::vector<Field>& columns,
                            const std::vector<Eigen::Vector3f>& colour);

} // namespace pointgi
