#pragma once
/// What every reader owes to every file: a cloud that the file can account for, or an input error that says where.
#include "host/cloud/readers/readers.h"
#include "host/error.h"
#include "tests/support/temporary_folder.h"
#include <algorithm>
#include <catch2/catch.hpp>

namespace pointgi::test {

/// Reads the file, of which a point takes `bytes_each` bytes at least; fails the test unless the outcome is one of the
/// two that are allowed. True when it was a cloud.
inline bool survives(PointCloud (*read)(const std::string&, const ReadRequest&, CloudReport&), const std::string& path,
                     std::size_t file_size, double bytes_each) {
  CloudReport report;
  try {
    const PointCloud cloud = read(path, {0.0, {}, true}, report);
    // Memory is asked for by counts that were checked.
    REQUIRE(static_cast<double>(cloud.position.capacity()) * bytes_each <= static_cast<double>(file_size + 1));
    for (const std::size_t length :
         {cloud.normal.size(), cloud.colour.size(), cloud.radius.size(), cloud.opacity.size(), cloud.station.size()})
      REQUIRE((length == 0 || length == cloud.size()));
    for (const Field& field : cloud.fields)
      REQUIRE(field.values.size() == cloud.size());
    for (const std::uint16_t station : cloud.station)
      REQUIRE(station < cloud.stations.size());
    for (const auto& corners : cloud.triangle)
      for (const std::uint32_t corner : corners)
        REQUIRE(corner < cloud.size());
    for (const Eigen::Vector3d& station : cloud.stations)
      REQUIRE(station.allFinite());
    for (const Eigen::Vector3f& colour : cloud.colour) // what is not finite is dropped later
      REQUIRE((!colour.allFinite() || (colour.minCoeff() >= 0.0f && colour.maxCoeff() <= 1.0f)));
    REQUIRE(cloud.size() > 0);
    REQUIRE(report.points_in_file == cloud.size());
    // As errors are, what is told is fit for a terminal.
    for (const std::vector<std::string>& texts : {report.warnings, report.notes})
      for (const std::string& text : texts)
        REQUIRE(std::all_of(text.begin(), text.end(), [](char c) { return c >= 0x20 && c < 0x7f; }));
    return true;
  } catch (const Error& error) {
    const std::string text = error.what();
    INFO(text);
    REQUIRE(error.kind() == ErrorKind::input);
    REQUIRE(text.find(path) == 0);
    REQUIRE((text.find(": line ") != std::string::npos || text.find(": byte ") != std::string::npos));
    // Fit for a terminal: nothing of the file's bytes as they are.
    REQUIRE(std::all_of(text.begin(), text.end(), [](char c) { return c >= 0x20 && c < 0x7f; }));
    REQUIRE(text.size() < 1000);
    return false;
  }
}

} // namespace pointgi::test
