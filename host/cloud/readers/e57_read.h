#pragma once
/// E57 files (ASTM E2807): scans of stations, each with its pose.
#include "host/cloud/readers/readers.h"

namespace pointgi {

/// The points of all scans, in the file's frame: cartesian or spherical coordinates, turned and moved by the pose of
/// their scan. Records that are marked as invalid are left out and told. Each scan is a station, where its pose takes
/// the origin. Fields have the names of other formats: intensity, red green blue, nx ny nz, return_number (from 1),
/// number_of_returns; others keep E57's. A field that a scan lacks is NaN there, colours are white.
/// `report.up` is +z. Throws Error(input) naming the byte.
PointCloud read_e57(const std::string& path, const ReadRequest& request, CloudReport& report);

} // namespace pointgi
