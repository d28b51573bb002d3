#include "host/cloud/find_normals.h"
#include "host/cloud/find_kind.h"
#include "host/cloud/normals.h"
#include "host/cloud/orient.h"
#include "host/cloud/percent.h"
#include "octree/parallel.h"

namespace pointgi {

namespace {

constexpr double tell_doubt = 0.02; // share of points
constexpr std::size_t grain = 1 << 14;

/// Normals of sites from how their neighbours lie, or as the cloud has them if it has planes without sides; with sides.
std::vector<Eigen::Vector3f> normals_of_sites(const Sites& sites, const PointCloud& cloud,
                                              const CompleteOptions& options, const std::vector<float>& spacing,
                                              std::vector<Structure>& structure, CloudReport& report) {
  std::vector<Eigen::Vector3f> normals = estimate_normals(sites, &structure);
  parallel_ranges(cloud.normal.empty() ? 0 : sites.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      for (const std::uint32_t point : sites.points(static_cast<std::uint32_t>(s)))
        if (const Eigen::Vector3f& given = cloud.normal[point]; !given.isZero(0)) {
          normals[s] = given;
          break;
        }
    }
  });
  const FreeSpace space(sites, spacing, free_space_side);
  const KindHints hints = hints_for(sites, cloud, options, false, report);
  OrientationEvidence evidence{options.viewpoint, {}, {}, options.eyes, {}};
  if (hints.has_stations) {
    evidence.stations = cloud.stations;
    evidence.station = cloud.station;
  }
  evidence.kind = recognise_kind(sites, spacing, normals, structure, space, hints);
  tell_kind(evidence.kind, cloud, hints, report);
  const Orientation orientation = orient_normals(sites, evidence, space, normals);
  report.normals_from = (cloud.normal.empty() ? "estimated (" : "file (sides: ") + orientation.how + ")";
  if (orientation.doubt > tell_doubt)
    report.notes.push_back("the side of " + percent(orientation.doubt) +
                           " of the points was nearly a tie; a viewpoint, or normals in the file, would tell");
  return normals;
}

} // namespace

std::size_t normalise(std::vector<Eigen::Vector3f>& normals) {
  return parallel_sum(
      normals.size(), grain, std::size_t{0}, [&](std::size_t& missing, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          Eigen::Vector3f& n = normals[i];
          // Squares of the smallest floats need double.
          n = n.allFinite() ? Eigen::Vector3f(n.cast<double>().normalized().cast<float>()) : Eigen::Vector3f::Zero();
          missing += n.isZero(0);
        }
      });
}

bool find_normals(PointCloud& cloud, const Sites& sites, const CompleteOptions& options,
                  const std::vector<float>& spacing, std::vector<Structure>& structure, CloudReport& report) {
  const bool estimate = options.normals == NormalSource::estimate;
  if (!estimate && !cloud.normal.empty()) {
    report.normals_from = "file";
    const std::size_t missing = normalise(cloud.normal);
    if (missing == 0 && !cloud.normals_unsigned) return true;
    if (missing < cloud.size() && !cloud.normals_unsigned) {
      fill_missing_normals(cloud, sites, cloud.normal);
      report.normals_from = "file, " + std::to_string(missing) + " missing ones estimated";
      report.notes.push_back(std::to_string(missing) + " of " + std::to_string(cloud.size()) +
                             " normals are missing in the file (zero or not a number): they were estimated, on the "
                             "side of the given ones beside them");
      return true;
    }
    if (missing == cloud.size()) {
      report.notes.push_back("all normals of the file are zero or not numbers: they were estimated");
      cloud.normal.clear();
    }
  } else if (estimate) {
    cloud.normal.clear();
  }
  if (!estimate && cloud.normal.empty() && !cloud.triangle.empty()) {
    cloud.normal = face_normals(cloud);
    const std::size_t missing = fill_missing_normals(cloud, sites, cloud.normal);
    report.normals_from = "faces";
    if (missing == cloud.size())
      report.normals_from.clear(); // not one face with an area: estimated below
    else if (missing > 0)
      report.warnings.push_back(std::to_string(missing) + " of " + std::to_string(cloud.size()) +
                                " points are in no face (of positive area): their normals were estimated from their "
                                "neighbours; if stray lights or dark specks show, remove these points");
    if (!report.normals_from.empty()) return true;
    cloud.normal.clear();
  }
  const std::vector<Eigen::Vector3f> normals = normals_of_sites(sites, cloud, options, spacing, structure, report);
  cloud.normal.resize(cloud.size(), Eigen::Vector3f::Zero());
  parallel_ranges(sites.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s)
      for (const std::uint32_t point : sites.points(static_cast<std::uint32_t>(s))) {
        Eigen::Vector3f& normal = cloud.normal[point];
        normal = normal.isZero(0) ? normals[s] : normal.dot(normals[s]) < 0 ? Eigen::Vector3f(-normal) : normal;
      }
  });
  return false;
}

} // namespace pointgi
