#pragma once
/// What readers owe to every file, in the words of what was not kept; empty: all was. For tests and for fuzz targets.
#include "host/cloud/point_cloud.h"
#include "host/error.h"
#include <algorithm>
#include <string>
#include <vector>

namespace pointgi::test {

/// Nothing of a file's bytes goes to a terminal as it is.
inline bool is_printable(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= 0x20 && c < 0x7f; });
}

/// As is_printable(), of texts with names from a scene file, which are UTF-8: no byte is one that terminals obey.
inline bool is_harmless(const std::string& text) {
  return std::all_of(text.begin(), text.end(),
                     [](char c) { return static_cast<unsigned char>(c) >= 0x20 && c != 0x7f; });
}

/// Of the error that a reader throws. `begin`: what its text begins with.
inline std::string broken_promise(const Error& error, const std::string& begin) {
  const std::string text = error.what();
  if (error.kind() != ErrorKind::input) return "the error is not one of the input: " + text;
  if (text.rfind(begin, 0) != 0) return "the error does not begin with " + begin + ": " + text;
  if (!is_printable(text)) return "the error is not printable: " + text;
  if (text.size() >= 1000) return "the error is too long: " + text;
  return {};
}

/// Of the error that the reader of a cloud throws.
inline std::string broken_promise_of_cloud(const Error& error, const std::string& path) {
  const std::string text = error.what();
  if (text.find(": line ") == std::string::npos && text.find(": byte ") == std::string::npos)
    return "the error names neither line nor byte: " + text;
  return broken_promise(error, path);
}

/// Of a cloud as every reader returns it.
inline std::string broken_promise(const PointCloud& cloud, const CloudReport& report) {
  const std::size_t size = cloud.size();
  if (size == 0) return "the cloud is empty";
  if (report.points_in_file != size) return "the report has another number of points than the cloud";
  for (const std::size_t length :
       {cloud.normal.size(), cloud.colour.size(), cloud.radius.size(), cloud.opacity.size(), cloud.station.size()})
    if (length != 0 && length != size) return "a list of the cloud has another length than its positions";
  for (const Field& field : cloud.fields)
    if (field.values.size() != size) return "a field has another length than the positions";
  for (const std::uint16_t station : cloud.station)
    if (station >= cloud.stations.size()) return "a point has a station that does not exist";
  for (const auto& corners : cloud.triangle)
    for (const std::uint32_t corner : corners)
      if (corner >= size) return "a triangle has a corner that does not exist";
  for (const Eigen::Vector3d& station : cloud.stations)
    if (!station.allFinite()) return "a station is not finite";
  for (const Eigen::Vector3f& colour : cloud.colour) // what is not finite is dropped later
    if (colour.allFinite() && (colour.minCoeff() < 0.0f || colour.maxCoeff() > 1.0f))
      return "a colour is outside of [0, 1]";
  for (const std::vector<std::string>& texts : {report.warnings, report.notes})
    for (const std::string& text : texts)
      if (!is_printable(text)) return "a warning or note is not printable: " + text;
  return {};
}

/// Of a cloud that was read from `file_bytes` bytes, of which a point takes `bytes_each` at least: memory is asked for
/// by counts that were checked.
inline std::string broken_promise(const PointCloud& cloud, const CloudReport& report, std::size_t file_bytes,
                                  double bytes_each) {
  if (static_cast<double>(cloud.position.capacity()) * bytes_each > static_cast<double>(file_bytes + 1))
    return "room was made for more points than the file can hold";
  return broken_promise(cloud, report);
}

} // namespace pointgi::test
