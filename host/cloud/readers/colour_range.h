#pragma once
/// What range the numbers of a file's colours have.
#include "host/cloud/field.h"
#include "host/cloud/point_cloud.h"

namespace pointgi {

/// Brings `colours` from the file's numbers to [0,1]: of 8 bits 0..255; of wider integers 0..255 or 0..65535; of floats
/// 0..1, 0..255 or 0..65535, whichever holds all points but a thousandth; those few are clamped. Values that are not
/// finite stay what they are. `types`: of red, green and blue; the widest decides.
/// What was decided against the type is added to the notes of `report`, points that were clamped to its warnings.
void scale_colours(const std::array<FieldType, 3>& types, std::vector<Eigen::Vector3f>& colours, CloudReport& report);

} // namespace pointgi
