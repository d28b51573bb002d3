#include "host/cloud/readers/readers.h"
#include "host/cloud/input_file.h"
#include "host/cloud/readers/mesh.h"
#include "host/cloud/readers/ply.h"
#include "host/error.h"
#include <algorithm>

namespace pointgi {

namespace {

bool has_extension_of(const std::string& path, const CloudReader& reader) {
  return std::any_of(reader.extensions.begin(), reader.extensions.end(),
                     [&](const std::string& extension) { return has_extension(path, extension); });
}

PointCloud read_with(const CloudReader& reader, const std::string& path, const ReadRequest& request,
                     CloudReport& report) {
  if (reader.read != nullptr) return reader.read(path, request, report);
  throw Error(ErrorKind::input, path + ": " + reader.format +
                                    " is not read directly; convert it to PLY first, with `pdal translate` or "
                                    "CloudCompare");
}

} // namespace

const std::vector<CloudReader>& cloud_readers() {
  static const std::vector<CloudReader> readers{
      {"PLY", {".ply"}, nullptr, read_ply},
      // Scanners' own formats are for the programs that know them; the mesh library's answer would only puzzle.
      {"LAS", {".las"}, nullptr, nullptr},
      {"LAZ", {".laz"}, nullptr, nullptr},
      {"E57", {".e57"}, nullptr, nullptr},
      {"PCD", {".pcd"}, nullptr, nullptr},
      {"PTS", {".pts"}, nullptr, nullptr},
      {"PTX", {".ptx"}, nullptr, nullptr},
      {"XYZ", {".xyz"}, nullptr, nullptr},
  };
  return readers;
}

PointCloud read_cloud(const std::string& path, const ReadRequest& request, CloudReport& report) {
  for (const CloudReader& reader : cloud_readers())
    if (has_extension_of(path, reader)) return read_with(reader, path, request, report);
  return sample_mesh(path, request.spacing, report);
}

} // namespace pointgi
