#include "host/cloud/readers/readers.h"
#include "host/cloud/input_file.h"
#include "host/cloud/readers/mesh.h"
#include "host/cloud/readers/ply.h"
#include "host/error.h"
#include <algorithm>

namespace pointgi {

namespace {

PointCloud read_as_ply(const std::string& path, double, CloudReport& report) {
  return read_ply(path, report);
}

} // namespace

const std::vector<CloudReader>& cloud_readers() {
  static const std::vector<CloudReader> readers{
      {{".ply"}, read_as_ply},
      // Scanners' own formats are for the programs that know them; the mesh library's answer would only puzzle.
      {{".las", ".laz", ".e57", ".pcd", ".pts", ".ptx", ".xyz"}, nullptr},
      {{}, sample_mesh},
  };
  return readers;
}

PointCloud read_cloud(const std::string& path, double spacing, CloudReport& report) {
  for (const CloudReader& reader : cloud_readers()) {
    const auto its = std::find_if(reader.extensions.begin(), reader.extensions.end(),
                                  [&](const std::string& extension) { return has_extension(path, extension); });
    if (its == reader.extensions.end() && !reader.extensions.empty()) continue;
    if (reader.read != nullptr) return reader.read(path, spacing, report);
    throw Error(ErrorKind::input,
                path + ": " + its->substr(1) +
                    " is not read directly; convert it to PLY first, with `pdal translate` or CloudCompare");
  }
  throw Error(ErrorKind::internal, path + ": no reader takes it");
}

} // namespace pointgi
