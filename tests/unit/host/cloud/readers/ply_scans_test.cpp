#include "host/cloud/readers/ply.h"
#include "tests/support/scans.h"
#include <catch2/catch.hpp>

using namespace pointgi;

TEST_CASE("ply read: scans have the points and triangles that their makers count") {
  struct Scan {
    std::string name;
    std::size_t points, triangles;
    bool normals, colours;
  };
  const std::vector<Scan> scans{{"bunny.ply", 35947, 69451, false, false},
                                {"horse.ply", 48485, 96966, true, false},
                                {"pond.ply", 70051, 0, true, true},
                                {"teapot.ply", 3644, 6320, false, false},
                                {"autzen_trim.ply", 110000, 0, false, true}};
  for (const Scan& scan : scans) {
    const auto path = test::scan_path(scan.name);
    if (!path) {
      WARN("skipped: no scan " << scan.name);
      continue;
    }
    CloudReport report;
    const PointCloud cloud = read_ply(*path, {}, report);
    CHECK(cloud.size() == scan.points);
    CHECK(report.triangles == scan.triangles);
    CHECK(cloud.normal.empty() != scan.normals);
    CHECK(cloud.colour.empty() != scan.colours);
    CHECK(report.warnings.empty());
  }
}
