#include "host/cloud/complete.h"
#include "host/cloud/drop_points.h"
#include "host/cloud/keep_points.h"
#include "host/cloud/knn.h"
#include "host/cloud/normals.h"
#include "host/cloud/orient.h"
#include "host/cloud/splat_size.h"
#include "host/cloud/strays.h"
#include "host/error.h"
#include "octree/parallel.h"
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>

namespace pointgi {

namespace {

// Closed surfaces have a vector area near 0 (scans with a hole underneath up to 0.1); an outwardness below -0.1 is far
// from what noise or a mixture of signs gives (a sphere facing inwards has -1, a long-legged animal -0.3).
constexpr double closed_openness = 0.1;
constexpr double inward_outwardness = -0.1;
constexpr double consistent_share = 0.05; // of opposed neighbours: more, and "inward as a whole" means nothing
constexpr double pi = 3.14159265358979323846;
constexpr double warn_opposite = 0.02;
constexpr double unsigned_share = 0.15; // more, and signs do not tell the sides of a sheet apart
constexpr double line_like = 1e-8;      // ratio of variances (of their roots: 1e-4)
constexpr unsigned grid_side = 128;     // of FreeSpace
constexpr double tell_doubt = 0.02;     // share of points
constexpr unsigned limit_neighbours = 8;
constexpr unsigned kept_neighbours = 20; // as many as spacings and most cells need
constexpr float most_spacings = 2.5f;    // radius over the spacing around: beside a 16-fold step in density 2 is right

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f %%", 100.0 * share);
  return text;
}

/// Unit normals; those that are missing, of length 0 or not finite, become zero. Returns how many are.
std::size_t normalise(std::vector<Eigen::Vector3f>& normals) {
  std::size_t missing = 0;
  for (Eigen::Vector3f& n : normals) {
    n = n.allFinite() ? Eigen::Vector3f(n.cast<double>().normalized().cast<float>()) // squares of the smallest floats
                      : Eigen::Vector3f::Zero();                                     // need double
    if (n.isZero(0)) ++missing;
  }
  return missing;
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

/// What the estimation of normals finds on its way, a value a site.
struct Found {
  std::vector<float> spacing;
  std::vector<Structure> structure;
};

KindHints hints_for(const Sites& sites, const PointCloud& cloud, const CompleteOptions& options, bool signs_given,
                    const CloudReport& report) {
  KindHints hints;
  hints.up = options.up ? options.up : report.up;
  hints.signs_given = signs_given;
  hints.has_stations =
      !cloud.stations.empty() && std::any_of(cloud.stations.begin(), cloud.stations.end(),
                                             [&](const Eigen::Vector3d& s) { return may_have_seen(sites, s); });
  return hints;
}

void tell_kind(const RecognisedKind& found, const PointCloud& cloud, const KindHints& hints, CloudReport& report) {
  report.kind = found.kind;
  report.kind_reason = found.reason;
  report.up = found.up;
  report.stations = hints.has_stations ? cloud.stations : std::vector<Eigen::Vector3d>();
  if (found.sensor) report.stations = {*found.sensor};
}

/// Normals of sites from how their neighbours lie, or as the cloud has them if it has planes without sides; with sides.
std::vector<Eigen::Vector3f> normals_of_sites(const Sites& sites, const PointCloud& cloud,
                                              const CompleteOptions& options, Found& found, CloudReport& report) {
  std::vector<Eigen::Vector3f> normals = estimate_normals(sites, &found.structure);
  for (std::uint32_t s = 0; s < sites.size() && !cloud.normal.empty(); ++s) {
    const Eigen::Vector3f& given = cloud.normal[*sites.points(s).begin()];
    if (!given.isZero(0)) normals[s] = given;
  }
  const FreeSpace space(sites, found.spacing, grid_side);
  const KindHints hints = hints_for(sites, cloud, options, false, report);
  OrientationEvidence evidence{options.viewpoint, {}, {}, options.eyes, {}};
  if (hints.has_stations) {
    evidence.stations = cloud.stations;
    evidence.station = cloud.station;
  }
  evidence.kind = recognise_kind(sites, found.spacing, normals, found.structure, space, hints);
  tell_kind(evidence.kind, cloud, hints, report);
  const Orientation orientation = orient_normals(sites, evidence, space, normals);
  report.normals_from = (cloud.normal.empty() ? "estimated (" : "file (sides: ") + orientation.how + ")";
  if (orientation.doubt > tell_doubt)
    report.notes.push_back("the side of " + percent(orientation.doubt) +
                           " of the points was nearly a tie; a viewpoint, or normals in the file, would tell");
  return normals;
}

/// Fills cloud.normal and report.normals_from; true when the signs are the file's own.
bool find_normals(PointCloud& cloud, const Sites& sites, const CompleteOptions& options, Found& found,
                  CloudReport& report) {
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
  const std::vector<Eigen::Vector3f> normals = normals_of_sites(sites, cloud, options, found, report);
  cloud.normal.resize(cloud.size(), Eigen::Vector3f::Zero());
  for (std::uint32_t s = 0; s < sites.size(); ++s)
    for (const std::uint32_t point : sites.points(s)) {
      Eigen::Vector3f& normal = cloud.normal[point];
      normal = normal.isZero(0) ? normals[s] : normal.dot(normals[s]) < 0 ? Eigen::Vector3f(-normal) : normal;
    }
  return false;
}

/// The kind of a cloud whose normals are given.
void find_kind(const PointCloud& cloud, const Sites& sites, const CompleteOptions& options, const Found& found,
               CloudReport& report) {
  std::vector<Eigen::Vector3f> normals(sites.size(), Eigen::Vector3f::Zero());
  for (std::uint32_t s = 0; s < sites.size(); ++s) {
    for (const std::uint32_t point : sites.points(s))
      normals[s] += cloud.normal[point];
    normals[s] /= static_cast<float>(sites.points(s).size()); // two sides in one place leave nothing
  }
  const KindHints hints = hints_for(sites, cloud, options, true, report);
  const FreeSpace space(sites, found.spacing, grid_side);
  tell_kind(recognise_kind(sites, found.spacing, normals, found.structure, space, hints), cloud, hints, report);
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

/// Discs of a scan no larger than what lies around vouches for: lines as wide as their points are apart, leaves and
/// noise as their own, surfaces by the spacing around; points of structure from motion no wider than their own.
void limit_sizes(PointCloud& cloud, const Sites& sites, const Found& found, bool sparse) {
  const auto unit = static_cast<float>(sites.unit());
  parallel_ranges(sites.size(), 2048, [&](std::size_t begin, std::size_t end) {
    std::array<Neighbour, limit_neighbours> near;
    std::array<float, limit_neighbours> spacing;
    for (std::size_t s = begin; s < end; ++s) {
      const unsigned count = sites.nearest(static_cast<std::uint32_t>(s), limit_neighbours, near.data());
      if (count < 3) continue;
      for (unsigned j = 0; j < count; ++j)
        spacing[j] = found.spacing[near[j].site];
      std::nth_element(spacing.begin(), spacing.begin() + count / 2, spacing.begin() + count);
      const float second = std::sqrt(near[1].distance2), third = std::sqrt(near[2].distance2);
      const Structure structure = found.structure[s];
      const float most = structure == Structure::line     ? second
                         : structure == Structure::volume ? 0.75f * third
                         : sparse                         ? std::min(found.spacing[s], spacing[count / 2])
                                                          : most_spacings * spacing[count / 2];
      for (const std::uint32_t point : sites.points(static_cast<std::uint32_t>(s))) {
        if (cloud.radius[point] <= most * unit) continue;
        cloud.radius[point] = std::max(most * unit, std::numeric_limits<float>::min());
        const double disc = pi * static_cast<double>(cloud.radius[point]) * static_cast<double>(cloud.radius[point]);
        cloud.area[point] = static_cast<float>(std::clamp(disc, 1e-37, static_cast<double>(cloud.area[point])));
      }
    }
  });
}

/// Faces that are stored both ways round: their points are those of sheets, with two sides.
bool has_doubled_faces(const PointCloud& cloud) {
  std::vector<std::array<std::uint32_t, 3>> corners = cloud.triangle;
  for (auto& face : corners)
    std::sort(face.begin(), face.end());
  std::sort(corners.begin(), corners.end());
  std::size_t doubled = 0;
  for (std::size_t i = 1; i < corners.size(); ++i)
    doubled += corners[i] == corners[i - 1];
  return 5 * doubled > 2 * corners.size(); // nearly every face has its twin
}

/// Whether the scene's camera or a lamp is among the points: then normals that face inwards are meant so.
bool is_seen_from_inside(const PointCloud& cloud, const std::vector<Eigen::Vector3d>& eyes) {
  Eigen::Vector3d low = cloud.position[0], high = low;
  for (const Eigen::Vector3d& p : cloud.position)
    low = low.cwiseMin(p), high = high.cwiseMax(p);
  return std::any_of(eyes.begin(), eyes.end(), [&](const Eigen::Vector3d& eye) {
    return (eye.array() > low.array()).all() && (eye.array() < high.array()).all();
  });
}

/// Normals, radii and areas of a cloud without strays.
void complete_body(PointCloud& cloud, const Sites& sites, const CompleteOptions& options, CloudReport& report) {
  const bool sampled = !cloud.area.empty();
  warn_of_degenerate(sites, cloud.size(), report);
  Found found;
  found.spacing = site_spacing(sites, {}).spacing;
  const bool signs_given = find_normals(cloud, sites, options, found, report);
  if (signs_given) find_kind(cloud, sites, options, found, report);
  const SiteSpacing spacing = site_spacing(sites, cloud.normal);
  if (spacing.opposite > warn_opposite && report.kind != CloudKind::foliage)
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
  cloud.structure.assign(cloud.size(), Structure::surface);
  if (!found.structure.empty()) {
    for (std::uint32_t s = 0; s < sites.size(); ++s)
      for (const std::uint32_t point : sites.points(s))
        cloud.structure[point] = found.structure[s];
    if (!own_radii && !sampled) limit_sizes(cloud, sites, found, report.kind == CloudKind::sparse);
    if (report.kind == CloudKind::foliage) // leaves are seen from both sides
      std::replace(cloud.structure.begin(), cloud.structure.end(), Structure::surface, Structure::sheet);
  }
  if (!cloud.triangle.empty() && has_doubled_faces(cloud)) {
    cloud.structure.assign(cloud.size(), Structure::sheet);
    report.notes.push_back(
        "nearly all faces are stored both ways round: the points are taken as sheets with two sides");
  }

  if (signs_given && !sampled && spacing.opposite < consistent_share && options.normals == NormalSource::automatic &&
      report.kind != CloudKind::room && !is_seen_from_inside(cloud, options.eyes))
    turn_inside_out_if_inward(cloud, sites, report);
  if (options.normals == NormalSource::flip) {
    turn_round(cloud);
    report.normals_from += ", turned round as asked for";
  }
}

/// The cloud's strays, a value a point; empty: none, or not looked for.
std::vector<char> strays_of(const PointCloud& cloud, const Sites& sites, const CompleteOptions& options) {
  if (options.strays == StrayPolicy::keep || !cloud.triangle.empty()) return {};
  const std::vector<char> found = find_strays(sites, site_spacing(sites, {}, false).spacing);
  if (std::find(found.begin(), found.end(), 1) == found.end()) return {};
  std::vector<char> strays(cloud.size());
  for (std::uint32_t s = 0; s < sites.size(); ++s)
    for (const std::uint32_t point : sites.points(s))
      strays[point] = found[s];
  return strays;
}

template <class T>
std::vector<T> without(const std::vector<T>& values, const std::vector<char>& strays) {
  std::vector<T> kept;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!strays[i]) kept.push_back(values[i]);
  return kept;
}

/// The points between them are completed on their own; then each stray gets the normal (where it has none) and the disc
/// of the nearest of them.
void complete_around_strays(PointCloud& cloud, const std::vector<char>& strays, const CompleteOptions& options,
                            CloudReport& report) {
  PointCloud body;
  body.position = without(cloud.position, strays);
  body.normal = without(cloud.normal, strays);
  body.radius = without(cloud.radius, strays);
  body.area = without(cloud.area, strays);
  body.station = without(cloud.station, strays);
  body.stations = cloud.stations;
  Sites sites(body.position);
  sites.keep_neighbours(kept_neighbours);
  complete_body(body, sites, options, report);
  cloud.normal.resize(cloud.size());
  cloud.radius.resize(cloud.size());
  cloud.area.resize(cloud.size());
  cloud.structure.assign(cloud.size(), Structure::stray);
  for (std::size_t i = 0, b = 0; i < cloud.size(); ++i) {
    if (!strays[i]) {
      cloud.normal[i] = body.normal[b];
      cloud.radius[i] = body.radius[b];
      cloud.area[i] = body.area[b];
      cloud.structure[i] = body.structure[b++];
      continue;
    }
    Neighbour near{};
    sites.nearest_to(sites.to_local(cloud.position[i]), 1, &near);
    const std::uint32_t other = *sites.points(near.site).begin();
    cloud.normal[i] = body.normal[other];
    cloud.radius[i] = body.radius[other];
    cloud.area[i] = body.area[other];
  }
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
                                            " points can be used: every one has a value that is not finite, or a "
                                            "radius not above 0; check the file's columns");
  const std::size_t outliers = drop_outliers(cloud);
  report.points_dropped += outliers;
  if (outliers > 0)
    report.warnings.push_back(std::to_string(outliers) + " of " + std::to_string(outliers + cloud.size()) +
                              " points were dropped: they lie over a thousand times the size of the others away; clean "
                              "the scan, or split it into clouds, if they are meant");
  if (dropped > 0)
    report.warnings.push_back(
        std::to_string(dropped) + " of " + std::to_string(dropped + cloud.size()) +
        " points were dropped: values that are not finite, radii not above 0, or opacities below 0.1; "
        "clean the file if they matter");

  const bool sampled = !cloud.area.empty(); // by our own sampler: normals, radii and areas are meant as they are
  if (sampled && !cloud.normal.empty() && !cloud.radius.empty() && options.radii != RadiusSource::estimate &&
      options.normals != NormalSource::estimate) {
    normalise(cloud.normal);
    if (options.normals == NormalSource::flip) turn_round(cloud);
    report.normals_from = options.normals == NormalSource::flip ? "file, flipped" : "file";
    report.radii_from = "file";
    report.areas_from = "given";
    cloud.structure.assign(cloud.size(), Structure::surface);
    return;
  }

  auto sites = std::make_unique<Sites>(cloud.position);
  sites->keep_neighbours(kept_neighbours);
  const std::vector<char> strays = strays_of(cloud, *sites, options);
  if (strays.empty()) {
    complete_body(cloud, *sites, options, report);
    return;
  }
  sites.reset();
  const auto count = static_cast<std::size_t>(std::count(strays.begin(), strays.end(), 1));
  const std::string found = std::to_string(count) + " of " + std::to_string(cloud.size()) +
                            " points are strays, far from what their neighbours lie on: ";
  if (options.strays == StrayPolicy::shrink) {
    report.notes.push_back(found + "they became discs no larger than those of the surface");
    complete_around_strays(cloud, strays, options, report);
    return;
  }
  report.notes.push_back(found + "they were left out; strays = \"shrink\" shows them");
  report.points_dropped += count;
  keep_points(cloud, [&](std::size_t i) { return !strays[i]; });
  sites = std::make_unique<Sites>(cloud.position);
  sites->keep_neighbours(kept_neighbours);
  complete_body(cloud, *sites, options, report);
}

} // namespace pointgi
