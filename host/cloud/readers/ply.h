#pragma once
/// PLY files: ascii and both binary byte orders, any property order and type.
#include "host/cloud/readers/readers.h"
#include <string>

namespace pointgi {

/// Reads the vertices (and the triangles of polygonal faces, fans of them) of a PLY file.
/// Counts are checked against the file's size before anything is allocated. Points that are not finite are kept here:
/// complete_cloud() drops and counts them.
/// Throws Error(input) naming the file and the line (header, ascii body) or byte (binary body), what was expected and
/// what was found. `report` receives format, property uses, counts and warnings.
PointCloud read_ply(const std::string& path, const ReadRequest& request, CloudReport& report);

/// Extra per-vertex float columns, e.g. {"scalar_radiosity_r", values}.
struct PlyColumn {
  std::string name;
  std::vector<float> values;
};

/// Writes binary_little_endian PLY: x y z as double, nx ny nz, red green blue (uchar, as in `colour`), radius, faces
/// and `columns` where they exist. Atomic: a temporary file in the same folder, fsync, rename. Throws Error(output).
void write_ply(const std::string& path, const PointCloud& cloud, const std::vector<PlyColumn>& columns = {});

} // namespace pointgi
