#pragma once
/// Colours of points from other numbers that their file has: intensity, height, a class.
#include "host/scene/scene.h"

namespace pointgi {

/// Fills `cloud.colour`, encoded as material.colour_space says, from the fields that the material names: low is black,
/// high is white, what is beyond is clamped; NaN is middle grey. Where low or high is open it is the quantile of 1 % or
/// 99 % of the values, of all three fields together. Notes in `report` what was taken.
/// Throws Error(input) naming the fields of the file where one is missing. `material.albedo_field` is there.
void colours_from_fields(const MaterialSettings& material, const std::string& file, PointCloud& cloud,
                         CloudReport& report);

/// The same in grey from the intensity of a file that has no colours, if it has one that is not the same everywhere;
/// half of the points are at least middle grey, and none is black. True if it has.
bool colours_from_intensity(PointCloud& cloud, CloudReport& report);

} // namespace pointgi
