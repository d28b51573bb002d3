#pragma once
/// What every reader owes to every file: a cloud that the file can account for, or an input error that says where.
#include "host/cloud/readers/readers.h"
#include "tests/support/promises.h"
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>

namespace pointgi::test {

/// Reads the file, of which a point takes `bytes_each` bytes at least; fails the test unless the outcome is one of the
/// two that are allowed. True when it was a cloud.
inline bool survives(PointCloud (*read)(const std::string&, const ReadRequest&, CloudReport&), const std::string& path,
                     std::size_t file_size, double bytes_each) {
  CloudReport report;
  try {
    const PointCloud cloud = read(path, {0.0, {}, true}, report);
    REQUIRE(broken_promise(cloud, report, file_size, bytes_each) == "");
    return true;
  } catch (const Error& error) {
    REQUIRE(broken_promise_of_cloud(error, path) == "");
    return false;
  }
}

} // namespace pointgi::test
