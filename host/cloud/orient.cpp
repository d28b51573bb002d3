#include "host/cloud/orient.h"
#include "host/cloud/spanning_forest.h"
#include "octree/parallel.h"
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

namespace pointgi {

namespace {

// A Kinect's frame reaches 0.995, airborne lidar 0.67, closed objects seen from outside 0.5 to 0.75, a photogrammetric
// cloud seen from an arbitrary origin 0.92.
constexpr double depth_image_threshold = 0.96;
constexpr std::size_t depth_image_sample = 60'000; // sites looked at; enough to tell sheets apart that matter
constexpr double farthest_sensor = 10.0;           // times the size of the cloud
constexpr double near_in_space = 6.0;              // times the distance of the 8th neighbour: slanted walls stretch it

// |sum of A n| / sum of A: 0 for closed surfaces, 1 for planes, 1/2 for a hemisphere.
constexpr double open_surface = 0.5;
constexpr double clearly_convex = 0.4; // of TreeShape::outward, for open surfaces: a dome, the scan of a statue's front
constexpr double fragment_share = 0.01; // trees with fewer sites than this share of the largest are fragments
constexpr unsigned fragment_votes = 32;

/// What decides the side of one tree.
struct TreeShape {
  std::size_t sites = 0;
  double area = 0;
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  Eigen::Vector3d vector_area = Eigen::Vector3d::Zero(); ///< sum of A n
  double volume = 0;                                     ///< sum of A n.(x - centroid): three times the volume
  double arm = 0;                                        ///< sum of A |x - centroid|
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();

  double openness() const { return vector_area.norm() / area; }
  double outward() const { return arm > 0 ? volume / arm : 0.0; } ///< 1 for a sphere facing outwards, -1 inwards
};

void turn_towards(const Sites& sites, const Eigen::Vector3d& sensor, std::vector<Eigen::Vector3f>& normals) {
  parallel_ranges(sites.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s)
      if (normals[s].cast<double>().dot(sensor - sites.position(static_cast<std::uint32_t>(s))) < 0)
        normals[s] = -normals[s];
  });
}

std::vector<TreeShape> tree_shapes(const Sites& sites, const SpanningForest& forest,
                                   const std::vector<Eigen::Vector3f>& normals) {
  std::vector<TreeShape> shapes(forest.trees);
  // An outlier's share would be the square of its distance: no site counts for more than a hundred usual ones.
  std::vector<float> areas = forest.spacing2;
  std::nth_element(areas.begin(), areas.begin() + static_cast<std::ptrdiff_t>(areas.size() / 2), areas.end());
  const double most = std::max(100.0 * static_cast<double>(areas[areas.size() / 2]), 1e-30);
  const auto area = [&](std::uint32_t s) { return std::clamp(static_cast<double>(forest.spacing2[s]), 1e-30, most); };
  for (std::uint32_t s = 0; s < sites.size(); ++s) {
    TreeShape& shape = shapes[forest.tree[s]];
    ++shape.sites;
    shape.area += area(s);
    shape.centroid += area(s) * sites.position(s);
  }
  for (TreeShape& shape : shapes)
    shape.centroid /= shape.area;
  for (std::uint32_t s = 0; s < sites.size(); ++s) {
    TreeShape& shape = shapes[forest.tree[s]];
    const Eigen::Vector3d arm = sites.position(s) - shape.centroid;
    const Eigen::Vector3d normal = normals[s].cast<double>();
    shape.vector_area += area(s) * normal;
    shape.volume += area(s) * normal.dot(arm);
    shape.arm += area(s) * arm.norm();
    shape.moments += area(s) * arm * arm.transpose();
  }
  return shapes;
}

/// The direction in which a tree is thinnest, towards + of the coordinate axis nearest to it.
Eigen::Vector3d upwards(const TreeShape& shape) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(shape.moments / std::max(shape.moments.trace(), 1e-300));
  Eigen::Vector3d up = solver.eigenvectors().col(0);
  int axis = 0;
  up.cwiseAbs().maxCoeff(&axis);
  return up[axis] < 0 ? Eigen::Vector3d(-up) : up;
}

bool goes_by_volume(const TreeShape& shape) {
  return shape.openness() < open_surface || std::abs(shape.outward()) > clearly_convex;
}

bool must_flip(const TreeShape& shape) {
  return goes_by_volume(shape) ? shape.volume < 0 : shape.vector_area.dot(upwards(shape)) < 0;
}

std::string description(const TreeShape& largest) {
  if (goes_by_volume(largest)) return "outwards";
  int axis = 0;
  upwards(largest).cwiseAbs().maxCoeff(&axis);
  return std::string("upwards along ") + "xyz"[axis];
}

/// Signs of the fragments, once those of the larger trees (`large`) have been applied to `normals`: -1, 0 = no clear
/// vote, 1.
std::vector<int> fragment_signs(const Sites& sites, const SpanningForest& forest, const std::vector<char>& large,
                                const std::vector<Eigen::Vector3f>& normals) {
  std::vector<std::uint32_t> base;
  std::vector<std::vector<std::uint32_t>> voters(forest.trees);
  for (std::uint32_t s = 0; s < sites.size(); ++s) {
    if (large[forest.tree[s]])
      base.push_back(s);
    else if (voters[forest.tree[s]].size() < fragment_votes)
      voters[forest.tree[s]].push_back(s);
  }
  std::vector<Eigen::Vector3d> base_position;
  for (const std::uint32_t s : base)
    base_position.push_back(sites.position(s));
  const Sites large_sites(base_position);
  std::vector<int> signs(forest.trees, 0);
  parallel_ranges(forest.trees, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      double votes = 0;
      for (const std::uint32_t s : voters[t]) {
        Neighbour near{};
        large_sites.nearest_to(large_sites.to_local(sites.position(s)), 1, &near);
        const std::uint32_t other = base[*large_sites.points(near.site).begin()];
        // Not mirrored: a fragment straight above a surface is noise from it more often than the back of a sheet.
        votes += static_cast<double>(normals[s].dot(normals[other]));
      }
      if (std::abs(votes) > 0.3 * static_cast<double>(voters[t].size())) signs[t] = votes < 0 ? -1 : 1;
    }
  });
  return signs;
}

std::string turn_trees(const Sites& sites, std::vector<Eigen::Vector3f>& normals) {
  const SpanningForest forest = agree_normals(sites, normals);
  const std::vector<TreeShape> shapes = tree_shapes(sites, forest, normals);
  const auto by_sites = [](const TreeShape& a, const TreeShape& b) { return a.sites < b.sites; };
  const TreeShape& largest = *std::max_element(shapes.begin(), shapes.end(), by_sites);
  std::vector<char> large(shapes.size()), flip(shapes.size(), 0);
  for (std::size_t t = 0; t < shapes.size(); ++t) {
    large[t] = static_cast<double>(shapes[t].sites) >= fragment_share * static_cast<double>(largest.sites);
    // A small body of its own (a bead beside a bust) is told from a fragment by being closed.
    if (shapes[t].sites >= 64 && shapes[t].openness() < 0.1 && std::abs(shapes[t].outward()) > 0.5) large[t] = 1;
    if (large[t]) flip[t] = must_flip(shapes[t]);
  }
  for (std::uint32_t s = 0; s < sites.size(); ++s)
    if (flip[forest.tree[s]]) normals[s] = -normals[s];
  if (std::find(large.begin(), large.end(), 0) != large.end()) {
    const std::vector<int> signs = fragment_signs(sites, forest, large, normals);
    for (std::uint32_t s = 0; s < sites.size(); ++s) {
      const std::uint32_t t = forest.tree[s];
      if (!large[t] && (signs[t] != 0 ? signs[t] < 0 : must_flip(shapes[t]))) normals[s] = -normals[s];
    }
  }
  return description(largest);
}

} // namespace

double depth_image_share(const Sites& sites, const Eigen::Vector3d& sensor) {
  if (sites.size() < 100) return 0;
  const std::size_t step = (sites.size() + depth_image_sample - 1) / depth_image_sample;
  std::vector<Eigen::Vector3d> positions, directions;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  std::vector<double> distances;
  for (std::size_t s = 0; s < sites.size(); s += step) {
    const Eigen::Vector3d offset = sites.position(static_cast<std::uint32_t>(s)) - sensor;
    if (!(offset.norm() > 0)) continue;
    positions.push_back(offset);
    directions.push_back(offset.normalized());
    distances.push_back(offset.norm());
    mean += directions.back();
  }
  if (positions.size() < 100 || !(mean.norm() > 0)) return 0;
  mean.normalize();
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  if (*middle > farthest_sensor * 4.0) return 0; // half of the cloud lies within 1 local unit of its median
  // A surface all around is as likely an object about the origin as a room scanned from its middle: no decision here.
  const auto behind =
      std::count_if(directions.begin(), directions.end(), [&](const auto& d) { return d.dot(mean) < 0.05; });
  if (static_cast<std::size_t>(behind) * 1000 > directions.size()) return 0;

  const Sites in_space(positions), as_seen(directions);
  if (as_seen.size() < 100) return 0; // a line through the sensor
  std::vector<char> agrees(as_seen.size());
  parallel_ranges(as_seen.size(), 1024, [&](std::size_t begin, std::size_t end) {
    std::array<Neighbour, 8> near;
    for (std::size_t s = begin; s < end; ++s) {
      const auto site = static_cast<std::uint32_t>(s);
      const std::uint32_t point = *as_seen.points(site).begin();
      as_seen.nearest(site, 1, near.data());
      const Eigen::Vector3d& other = positions[*as_seen.points(near[0].site).begin()];
      const unsigned count = in_space.nearest_to(in_space.to_local(positions[point]), 8, near.data());
      const double reach = std::sqrt(static_cast<double>(near[count - 1].distance2)) * in_space.unit();
      agrees[s] = (other - positions[point]).norm() <= near_in_space * reach;
    }
  });
  return static_cast<double>(std::count(agrees.begin(), agrees.end(), 1)) / static_cast<double>(agrees.size());
}

std::string orient_normals(const Sites& sites, const std::optional<Eigen::Vector3d>& viewpoint,
                           std::vector<Eigen::Vector3f>& normals) {
  if (viewpoint) {
    turn_towards(sites, sites.to_local(*viewpoint), normals);
    return "towards the viewpoint";
  }
  const Eigen::Vector3d origin = sites.to_local(Eigen::Vector3d::Zero());
  if (depth_image_share(sites, origin) > depth_image_threshold) {
    turn_towards(sites, origin, normals);
    return "towards the sensor at the origin";
  }
  return turn_trees(sites, normals);
}

} // namespace pointgi
