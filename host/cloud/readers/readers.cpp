#include "host/cloud/readers/readers.h"
#include "host/cloud/input_file.h"
#include "host/cloud/readers/e57_file.h"
#include "host/cloud/readers/e57_read.h"
#include "host/cloud/readers/gaussian_files.h"
#include "host/cloud/readers/las_header.h"
#include "host/cloud/readers/las_read.h"
#include "host/cloud/readers/mesh.h"
#include "host/cloud/readers/pcd_header.h"
#include "host/cloud/readers/pcd_read.h"
#include "host/cloud/readers/ply.h"
#include "host/cloud/readers/ptx.h"
#include "host/cloud/readers/text.h"
#include "host/error.h"
#include <algorithm>
#include <string_view>

namespace pointgi {

namespace {

bool begins_with(const char* data, std::size_t size, std::string_view magic) {
  return std::string_view(data, size).substr(0, magic.size()) == magic;
}

bool is_ply(const char* data, std::size_t size) {
  return (begins_with(data, size, "ply\n") || begins_with(data, size, "ply\r")) &&
         !recognises_compressed_ply(data, size);
}

bool is_packed(const char* data, std::size_t size) {
  using namespace std::string_view_literals;
  for (const std::string_view magic : {"\x1f\x8b\x08"sv, "BZh"sv,
                                       "\xfd"
                                       "7zXZ\0"sv,
                                       "\x28\xb5\x2f\xfd"sv, "PK\3\4"sv, "7z\xbc\xaf\x27\x1c"sv})
    if (begins_with(data, size, magic)) return true;
  return false;
}

const char* const export_it = "export it as E57, LAS or PLY with the program that wrote it";

bool has_extension_of(const std::string& path, const CloudReader& reader) {
  return std::any_of(reader.extensions.begin(), reader.extensions.end(),
                     [&](const std::string& extension) { return has_extension(path, extension); });
}

/// The row whose job the file is; null: a mesh, if anything.
const CloudReader* reader_of(const std::string& path) {
  const InputFile file(path);
  char begin[4096];
  const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(file.size(), sizeof begin));
  file.read(0, begin, size);
  const CloudReader* by_extension = nullptr;
  const CloudReader* by_content = nullptr;
  for (const CloudReader& reader : cloud_readers()) {
    const bool recognised = reader.recognises != nullptr && reader.recognises(begin, size);
    const bool named = has_extension_of(path, reader);
    if (recognised && named) return &reader;
    if (named) by_extension = &reader;
    if (recognised && by_content == nullptr) by_content = &reader;
  }
  // Some meshes are packed files, which the mesh library unpacks.
  const bool may_be_mesh = by_extension == nullptr && has_mesh_extension(path);
  if (by_content != nullptr && !(may_be_mesh && by_content->read == nullptr)) return by_content;
  return by_extension;
}

} // namespace

const std::vector<CloudReader>& cloud_readers() {
  static const std::vector<CloudReader> readers{
      {"compressed PLY of Gaussians", {".compressed.ply"}, recognises_compressed_ply, read_compressed_ply},
      {"PLY", {".ply"}, is_ply, read_ply},
      {"LAS", {".las"}, is_las, read_las},
      {"LAZ", {".laz"}, is_laz, read_las},
      {"E57", {".e57"}, is_e57, read_e57},
      {"PCD", {".pcd"}, is_pcd, read_pcd},
      {"PTX", {".ptx"}, recognises_ptx, read_ptx},
      {"splat", {".splat"}, nullptr, read_splat},
      {"SPZ", {".spz"}, recognises_spz, read_spz},
      {"text", {".xyz", ".txt", ".csv", ".asc", ".pts", ".xyzrgb", ".xyzn"}, recognises_text, read_text},
      // Only the programs that wrote these know them; the mesh library's answer would only puzzle.
      {"a project of ReCap", {".rcp", ".rcs"}, nullptr, nullptr, export_it},
      {"a scan of FARO", {".fls", ".fws"}, nullptr, nullptr, export_it},
      {"a scan of Z+F", {".zfs"}, nullptr, nullptr, export_it},
      {"a packed file",
       {".gz", ".bz2", ".xz", ".zst", ".zip", ".7z", ".tar", ".tgz"},
       is_packed,
       nullptr,
       "unpack it first"},
  };
  return readers;
}

PointCloud read_cloud(const std::string& path, const ReadRequest& request, CloudReport& report) {
  const CloudReader* reader = reader_of(path);
  if (reader == nullptr) return sample_mesh(path, request.spacing, report);
  if (reader->read != nullptr) return reader->read(path, request, report);
  const char* instead = reader->instead != nullptr ? reader->instead : "convert it to PLY, with CloudCompare or PDAL";
  throw Error(ErrorKind::input, path + ": " + reader->format + " is not read directly; " + instead);
}

} // namespace pointgi
