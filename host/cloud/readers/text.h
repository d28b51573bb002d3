#pragma once
/// Points as text: XYZ, ASC, CSV, TXT, PTS and COLMAP's points3D.txt.
#include "host/cloud/readers/readers.h"

namespace pointgi {

/// Reads a line a point. What the columns are is found by find_text_layout() and told in `report`; a line of one whole
/// number, as PTS has it, announces how many points follow. Empty values and those that are no numbers are NaN where
/// they are used for no position. Comments (# // ;) and blank lines may stand anywhere.
/// Throws Error(input) with the line: no points, lines that lack values, words where numbers are expected.
PointCloud read_text(const std::string& path, const ReadRequest& request, CloudReport& report);

/// Whether all whole lines of the first bytes of a file could be a table of points.
bool recognises_text(const char* data, std::size_t size);

} // namespace pointgi
