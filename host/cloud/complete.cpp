#include "host/cloud/complete.h"
#include "host/cloud/drop_points.h"
#include "host/cloud/knn.h"
#include "host/cloud/normals.h"
#include "host/cloud/orient.h"
#include "host/cloud/splat_size.h"
#include "host/error.h"
#include <Eigen/Dense>
#include <cmath>
#include <cstdio>

namespace pointgi {

namespace {

// Closed surfaces have a vector area near 0 (scans with a hole underneath up to 0.1); an outwardness below -0.1 is far
// from what noise or a mixture of signs gives (a sphere facing inwards has -1, a long-legged animal -0.3).
constexpr double closed_openness = 0.1;
constexpr double inward_outwardness = -0.1;
constexpr double consistent_share = 0.05; // of opposed neighbours: more, and "inward as a whole" means nothing
constexpr double warn_opposite = 0.02;
constexpr double unsigned_share = 0.15; // more, and signs do not tell the sides of a sheet apart
constexpr double line_like = 1e-8;      // ratio of variances (of their roots: 1e-4)

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f %%", 100.0 * share);
  return text;
}

void normalise(std::vector<Eigen::Vector3f>& normals) {
  for (Eigen::Vector3f& n : normals)
    n = n.cast<double>().normalized().cast<float>(); // squares of the smallest floats need double
}

/// Turns all normals round, and the winding of all faces if it went with them.
void turn_round(PointCloud& cloud) {
  for (Eigen::Vector3f& n : cloud.normal)
    n = -n;
  double agreement = 0;
  for (const auto& face : cloud.triangle) {
    const Eigen::Vector3d& corner = cloud.position[face[0]];
    const Eigen::Vector3d side = (cloud.position[face[1]] - corner).cross(cloud.position[face[2]] - corner);
    const Eigen::Vector3f normals = cloud.normal[face[0]] + cloud.normal[face[1]] + cloud.normal[face[2]];
    agreement += side.dot(normals.cast<double>());
  }
  if (agreement < 0)
    for (auto& face : cloud.triangle)
      std::swap(face[1], face[2]);
}

void refuse_missing(const PointCloud& cloud, const CompleteOptions& options) {
  if (options.normals == NormalSource::file && cloud.normal.empty() && cloud.triangle.empty())
    throw Error(ErrorKind::input,
                "normals = \"file\": the cloud has neither normals (nx ny nz) nor faces to take them from; "
                "use \"auto\" or \"estimate\"");
  if (options.radii == RadiusSource::file && cloud.radius.empty())
    throw Error(ErrorKind::input, "radii from the file: the cloud has no property \"radius\"; let them be estimated");
}

/// Fills cloud.normal and report.normals_from; true when the signs are the file's own.
bool find_normals(PointCloud& cloud, const Sites& sites, const CompleteOptions& options, CloudReport& report) {
  const bool estimate = options.normals == NormalSource::estimate;
  if (!estimate && !cloud.normal.empty()) {
    normalise(cloud.normal);
    report.normals_from = "file";
    return true;
  }
  if (!estimate && !cloud.triangle.empty()) {
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
  }
  std::vector<Eigen::Vector3f> normals = estimate_normals(sites);
  report.normals_from = "estimated (" + orient_normals(sites, options.viewpoint, normals) + ")";
  cloud.normal.resize(cloud.size());
  for (std::uint32_t s = 0; s < sites.size(); ++s)
    for (const std::uint32_t point : sites.points(s))
      cloud.normal[point] = normals[s];
  return false;
}

struct FacingCheck {
  double openness = 0;    ///< |sum of A n| / sum of A: 0 for a closed surface, 1 for a plane
  double outwardness = 0; ///< sum of A n.(x - c) / sum of A |x - c|: 1 for a sphere, -1 when it faces inwards
};

FacingCheck facing(const PointCloud& cloud, const Sites& sites) {
  double area = 0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero(), vector_area = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double a = static_cast<double>(cloud.area[i]);
    area += a;
    centre += a * sites.to_local(cloud.position[i]);
    vector_area += a * cloud.normal[i].cast<double>();
  }
  centre /= area;
  double volume = 0, arms = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d arm = sites.to_local(cloud.position[i]) - centre;
    volume += static_cast<double>(cloud.area[i]) * cloud.normal[i].cast<double>().dot(arm);
    arms += static_cast<double>(cloud.area[i]) * arm.norm();
  }
  return {vector_area.norm() / area, arms > 0 ? volume / arms : 0.0};
}

void turn_inside_out_if_inward(PointCloud& cloud, const Sites& sites, CloudReport& report) {
  const FacingCheck f = facing(cloud, sites);
  if (f.openness > closed_openness || f.outwardness > inward_outwardness) return;
  turn_round(cloud);
  report.normals_from += ", flipped";
  report.warnings.push_back(
      "the surface is closed and its normals (from the " +
      std::string(report.normals_from.rfind("faces", 0) == 0 ? "faces" : "file") +
      ") point inwards as a whole: all were flipped to face outwards; set normals = \"file\" to keep "
      "them, for instance for a room seen from inside");
}

/// Points, lines and single places: something can be shown, but it is hardly what was meant.
void warn_of_degenerate(const Sites& sites, std::size_t points, CloudReport& report) {
  if (sites.size() == 1) {
    report.warnings.push_back(points == 1
                                  ? "the cloud is a single point: it becomes one splat of radius 1 that faces +z; "
                                    "give it a radius property"
                                  : "all " + std::to_string(points) +
                                        " points are in one place: they become splats of radius 1 there; check "
                                        "the file's coordinates");
    return;
  }
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (std::uint32_t s = 0; s < sites.size(); ++s)
    mean += sites.position(s) / sites.size();
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (std::uint32_t s = 0; s < sites.size(); ++s)
    moments += (sites.position(s) - mean) * (sites.position(s) - mean).transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments / moments.trace(), Eigen::EigenvaluesOnly);
  if (solver.eigenvalues()[1] < line_like * solver.eigenvalues()[2])
    report.warnings.push_back("all points lie on a line: the normals across it and the splats' sizes are guesses; give "
                              "normals and radii in the file");
}

} // namespace

void complete_cloud(PointCloud& cloud, const CompleteOptions& options, CloudReport& report) {
  if (report.points_in_file == 0) report.points_in_file = cloud.size();
  refuse_missing(cloud, options);
  const std::size_t dropped = drop_unusable_points(cloud, options);
  report.points_dropped += dropped;
  report.triangles = cloud.triangle.size();
  if (cloud.size() == 0)
    throw Error(ErrorKind::input, dropped == 0
                                      ? "the cloud has no points; at least one is needed"
                                      : "none of the cloud's " + std::to_string(dropped) +
                                            " points can be used: every one has a value that is not finite, a normal "
                                            "of length 0 or a radius not above 0; check the file's columns");
  const std::size_t outliers = drop_outliers(cloud);
  report.points_dropped += outliers;
  if (outliers > 0)
    report.warnings.push_back(std::to_string(outliers) + " of " + std::to_string(outliers + cloud.size()) +
                              " points were dropped: they lie over a thousand times the size of the others away; clean "
                              "the scan, or split it into clouds, if they are meant");
  if (dropped > 0)
    report.warnings.push_back(
        std::to_string(dropped) + " of " + std::to_string(dropped + cloud.size()) +
        " points were dropped: values that are not finite, normals of length 0 or radii not above 0; "
        "clean the file if they matter");

  const bool sampled = !cloud.area.empty(); // by our own sampler: normals, radii and areas are meant as they are
  if (sampled && !cloud.normal.empty() && !cloud.radius.empty() && options.radii != RadiusSource::estimate &&
      options.normals != NormalSource::estimate) {
    normalise(cloud.normal);
    if (options.normals == NormalSource::flip) turn_round(cloud);
    report.normals_from = options.normals == NormalSource::flip ? "file, flipped" : "file";
    report.radii_from = "file";
    report.areas_from = "given";
    return;
  }

  const Sites sites(cloud.position);
  warn_of_degenerate(sites, cloud.size(), report);
  const bool signs_given = find_normals(cloud, sites, options, report);
  const SiteSpacing spacing = site_spacing(sites, cloud.normal);
  if (spacing.opposite > warn_opposite)
    report.warnings.push_back(
        "the normals oppose each other between " + percent(spacing.opposite) + " of the neighbouring points: " +
        (signs_given ? "their sides are not consistent in the file; normals = \"estimate\" finds new ones"
                     : "no consistent side was found; a viewpoint, or normals in the file, would tell"));

  // A mesh's vertices lie on its surface, a scan's points about it.
  SplatSizes sizes =
      splat_sizes(sites, cloud.normal, spacing, spacing.opposite < unsigned_share, cloud.triangle.empty());
  const bool own_radii = !cloud.radius.empty() && options.radii != RadiusSource::estimate;
  report.radii_from = own_radii ? "file" : "estimated (covering each point's cell)";
  report.areas_from = sampled ? "given" : "estimated (Voronoi cells in the tangent planes)";
  if (!own_radii) cloud.radius = std::move(sizes.radius);
  if (!sampled) cloud.area = std::move(sizes.area);

  if (signs_given && !sampled && spacing.opposite < consistent_share && options.normals == NormalSource::automatic)
    turn_inside_out_if_inward(cloud, sites, report);
  if (options.normals == NormalSource::flip) {
    turn_round(cloud);
    report.normals_from += ", turned round as asked for";
  }
}

} // namespace pointgi
