#pragma once
/// PCD files of the Point Cloud Library: ascii, binary and binary_compressed.
#include "host/cloud/readers/readers.h"

namespace pointgi {

/// The points as they are stored: VIEWPOINT moves nothing. Its position, unless that is 0 0 0, is the scanner's, of all
/// points (PointCloud::stations). Pixels of an organised cloud that saw nothing (NaN) are points here; complete_cloud()
/// drops and counts them. Fields of several values are name0 name1 …, and of rgb, normal and xyz what these mean; more
/// than 16 values (histograms) and padding ("_") are left aside.
/// Throws Error(input) naming the line (header, ascii) or byte.
PointCloud read_pcd(const std::string& path, const ReadRequest& request, CloudReport& report);

} // namespace pointgi
