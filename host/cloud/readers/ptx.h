#pragma once
/// PTX: grids of points as scanners see them, each with the pose of its scanner.
#include "host/cloud/readers/readers.h"

namespace pointgi {

/// Reads one grid or several: columns, rows, the scanner's position and three axes, a 4x4 matrix for row vectors (its
/// last row moves), then a line x y z intensity [r g b] for each cell. Points are taken to the world by the matrix, in
/// double; lines 0 0 0 are rays without a return and no points. A matrix for column vectors (its last column moves) is
/// recognised. Each grid with points is a station, where its matrix takes the origin; where the matrix moves nothing,
/// at the scanner's position. `report.up` is +z.
/// Throws Error(input) with the line: a header that is none, fewer lines than a header announces, words where numbers
/// are expected, no points at all, more than 65535 stations.
PointCloud read_ptx(const std::string& path, const ReadRequest& request, CloudReport& report);

/// Whether the first bytes of a file are the header of a grid.
bool recognises_ptx(const char* data, std::size_t size);

} // namespace pointgi
