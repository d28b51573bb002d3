#include "host/cloud/complete.h"
#include "host/cloud/cloud_warnings.h"
#include "host/cloud/disc_borders.h"
#include "host/cloud/drop_points.h"
#include "host/cloud/find_kind.h"
#include "host/cloud/find_normals.h"
#include "host/cloud/keep_points.h"
#include "host/cloud/mesh_borders.h"
#include "host/cloud/size_limits.h"
#include "host/cloud/splat_size.h"
#include "host/cloud/strays.h"
#include "host/cloud/turn_normals.h"
#include "host/error.h"
#include "octree/parallel.h"
#include <algorithm>
#include <array>
#include <memory>
#include <tuple>
#include <utility>

namespace pointgi {

namespace {

constexpr double consistent_share = 0.05; // of opposed neighbours: more, and "inward as a whole" means nothing
constexpr double unsigned_share = 0.15;   // more, and signs do not tell the sides of a sheet apart
constexpr unsigned kept_neighbours = 20;  // as many as spacings and most cells need

void refuse_missing(const PointCloud& cloud, const CompleteOptions& options) {
  if (options.normals == NormalSource::file && cloud.normal.empty() && cloud.triangle.empty())
    throw Error(ErrorKind::input,
                "normals = \"file\": the cloud has neither normals (nx ny nz) nor faces to take them from; "
                "use \"auto\" or \"estimate\"");
  if (options.radii == RadiusSource::file && cloud.radius.empty())
    throw Error(ErrorKind::input, "radii from the file: the cloud has no property \"radius\"; let them be estimated");
}

/// Faces that are stored both ways round: their points are those of sheets, with two sides.
bool has_doubled_faces(const PointCloud& cloud) {
  struct Face {
    std::array<std::uint32_t, 3> corners; ///< ascending
    bool turned;                          ///< the winding is the other one of two
  };
  std::vector<Face> faces;
  faces.reserve(cloud.triangle.size());
  for (const auto& t : cloud.triangle) {
    const bool turned = ((t[0] > t[1]) != (t[1] > t[2])) != (t[0] > t[2]);
    faces.push_back({t, turned});
    std::sort(faces.back().corners.begin(), faces.back().corners.end());
  }
  std::sort(faces.begin(), faces.end(),
            [](const Face& a, const Face& b) { return std::tie(a.corners, a.turned) < std::tie(b.corners, b.turned); });
  std::size_t doubled = 0;
  for (std::size_t i = 1; i < faces.size(); ++i)
    doubled += faces[i].corners == faces[i - 1].corners && faces[i].turned != faces[i - 1].turned;
  return 5 * doubled > 2 * faces.size(); // nearly every face has its twin
}

/// What kind of surface each point is on. `of_site`: a value a site; empty: all are on one.
void set_structure(PointCloud& cloud, const Sites& sites, const std::vector<Structure>& of_site) {
  cloud.structure.assign(cloud.size(), Structure::surface);
  parallel_ranges(of_site.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s)
      for (const std::uint32_t point : sites.points(static_cast<std::uint32_t>(s)))
        cloud.structure[point] = of_site[s];
  });
}

/// Normals, radii and areas of a cloud without strays. `distances`: spacings_of(sites).
void complete_body(PointCloud& cloud, const Sites& sites, std::vector<float>&& distances,
                   const CompleteOptions& options, CloudReport& report) {
  const bool sampled = !cloud.area.empty();
  warn_of_degenerate(sites, cloud.size(), report);
  rein_in_isolated(sites, distances);
  std::vector<Structure> structure; // a value a site; empty where normals are given
  const bool signs_given = find_normals(cloud, sites, options, distances, structure, report);
  const SiteSpacing spacing = with_normals(sites, cloud.normal, std::move(distances));
  if (signs_given) find_kind(cloud, sites, options, spacing, report);
  warn_of_opposite(spacing.opposite, signs_given, report);

  // A mesh's vertices lie on its surface, a scan's points about it.
  SplatSizes sizes =
      splat_sizes(sites, cloud.normal, spacing, spacing.opposite < unsigned_share, cloud.triangle.empty());
  const bool own_radii = !cloud.radius.empty() && options.radii != RadiusSource::estimate;
  report.radii_from = own_radii ? "file" : "estimated (covering each point's cell)";
  report.areas_from = sampled ? "given" : "estimated (Voronoi cells in the tangent planes)";
  if (!own_radii) cloud.radius = std::move(sizes.radius);
  if (!sampled) cloud.area = std::move(sizes.area);
  set_structure(cloud, sites, structure);
  if (cloud.triangle.empty() && !own_radii && !sampled) limit_sizes(cloud, sites, spacing, structure, report.kind);
  if (!signs_given && report.kind == CloudKind::foliage) // leaves are seen from both sides
    std::replace(cloud.structure.begin(), cloud.structure.end(), Structure::surface, Structure::sheet);
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
  if (own_radii) return;
  const bool from_faces = sampled || !cloud.triangle.empty();
  if (!cloud.triangle.empty()) borders_from_faces(cloud);
  BorderEvidence evidence;
  evidence.rims = from_faces ? std::exchange(cloud.clipped, {}) : std::move(sizes.rims);
  evidence.from_faces = from_faces;
  evidence.normals_given = signs_given;
  evidence.areas_given = sampled;
  evidence.followed_cosine = options.followed_cosine;
  if (report.stations.size() == 1 && options.normals != NormalSource::flip) evidence.sensor = report.stations[0];
  clip_discs(cloud, sites, spacing, std::move(evidence));
}

/// The cloud's strays, a value a point; empty: none, or not looked for.
std::vector<char> strays_of(const PointCloud& cloud, const Sites& sites, const std::vector<float>& spacing,
                            const CompleteOptions& options) {
  if (options.strays == StrayPolicy::keep || !cloud.triangle.empty()) return {};
  const std::vector<char> found = find_strays(sites, spacing);
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

/// The points between them are completed on their own; then each stray gets the normal and the disc of the nearest of
/// them.
void complete_around_strays(PointCloud& cloud, const std::vector<char>& strays, const CompleteOptions& options,
                            CloudReport& report) {
  PointCloud body;
  body.position = without(cloud.position, strays);
  body.normal = without(cloud.normal, strays);
  body.normals_unsigned = cloud.normals_unsigned;
  body.radius = without(cloud.radius, strays);
  body.area = without(cloud.area, strays);
  body.station = without(cloud.station, strays);
  body.stations = cloud.stations;
  std::vector<std::uint32_t> number, place(cloud.size()); // of each point of the body in the cloud, and back
  for (std::uint32_t i = 0; i < cloud.size(); ++i)
    if (!strays[i]) {
      place[i] = static_cast<std::uint32_t>(number.size());
      number.push_back(i);
    }
  for (const ClippedPoint& c : std::exchange(cloud.clipped, {}))
    if (!strays[c.point]) body.clipped.push_back({place[c.point], c.clip});
  Sites sites(body.position);
  complete_body(body, sites, keep_neighbours_and_spacings(sites, kept_neighbours), options, report);
  for (const ClippedPoint& c : body.clipped)
    cloud.clipped.push_back({number[c.point], c.clip});
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

  const bool normals_of_faces = cloud.normal.empty() && options.normals != NormalSource::estimate;
  if (normals_of_faces && !cloud.triangle.empty() && !has_doubled_faces(cloud)) split_at_edges(cloud);
  auto sites = std::make_unique<Sites>(cloud.position);
  std::vector<float> spacing = keep_neighbours_and_spacings(*sites, kept_neighbours);
  const std::vector<char> strays = strays_of(cloud, *sites, spacing, options);
  if (strays.empty()) {
    complete_body(cloud, *sites, std::move(spacing), options, report);
    return;
  }
  sites.reset();
  spacing = {};
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
  complete_body(cloud, *sites, keep_neighbours_and_spacings(*sites, kept_neighbours), options, report);
}

} // namespace pointgi
