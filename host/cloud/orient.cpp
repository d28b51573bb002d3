#include "host/cloud/orient.h"
#include "host/cloud/quantile.h"
#include "host/cloud/spanning_forest.h"
#include "octree/parallel.h"
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

namespace pointgi {

namespace {

constexpr double farthest_sensor = 10.0; // times the size of the cloud
constexpr unsigned patch_samples = 200;  // sites of a patch that are asked what they see
constexpr double clear_vote = 0.15;      // of the votes of a patch: less is nearly a tie
constexpr double gravity_weight = 0.7;
constexpr std::size_t smallest_patch = 30;

// |sum of A n| / sum of A: 0 for closed surfaces, 1 for planes, 1/2 for a hemisphere.
constexpr double open_surface = 0.5;
constexpr double clearly_convex = 0.4; // of TreeShape::outward, for open surfaces: a dome, the scan of a statue's front
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
  const double usual = median(forest.spacing2.size(), [&](std::size_t s) { return forest.spacing2[s]; });
  const double most = std::max(100.0 * usual, 1e-30);
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

/// Some of the sites of each patch, evenly along the curve.
std::vector<std::vector<std::uint32_t>> sample_patches(const SpanningForest& forest,
                                                       const std::vector<TreeShape>& shapes) {
  std::vector<std::vector<std::uint32_t>> samples(forest.trees);
  std::vector<std::size_t> seen(forest.trees, 0);
  for (std::uint32_t s = 0; s < forest.tree.size(); ++s) {
    const std::uint32_t t = forest.tree[s];
    const std::size_t step = std::max<std::size_t>(1, shapes[t].sites / patch_samples);
    if (seen[t]++ % step == 0) samples[t].push_back(s);
  }
  return samples;
}

/// What camera and lamps see of a patch: 1 its fronts, -1 its backs, 0 neither for sure.
double vote_of_eyes(const Sites& sites, const std::vector<Eigen::Vector3d>& eyes, const FreeSpace& space,
                    const std::vector<std::uint32_t>& sample, const std::vector<Eigen::Vector3f>& normals) {
  double votes = 0, all = 0;
  for (const std::uint32_t s : sample)
    for (const Eigen::Vector3d& eye : eyes) {
      const Eigen::Vector3d way = eye - sites.position(s);
      const double cosine = normals[s].cast<double>().dot(way) / std::max(way.norm(), 1e-30);
      if (std::abs(cosine) < 0.1 || !space.clear(sites.position(s), eye)) continue;
      votes += cosine;
      all += std::abs(cosine);
    }
  const double enough = 0.02 * static_cast<double>(sample.size());
  return all > enough ? votes / all : 0.0;
}

/// From which side of a patch more of the free space is seen: 1 its fronts, -1 its backs (Takayama et al. 2014).
double vote_of_space(const Sites& sites, const FreeSpace& space, const std::vector<std::uint32_t>& sample,
                     const std::vector<Eigen::Vector3f>& normals) {
  double front = 0, back = 0;
  for (const std::uint32_t s : sample) {
    const Eigen::Vector3d n = normals[s].cast<double>();
    front += space.openness(sites.position(s), n);
    back += space.openness(sites.position(s), -n);
  }
  return front + back > 0.05 * static_cast<double>(sample.size()) ? (front - back) / (front + back) : 0.0;
}

/// 1 to leave a patch, -1 to turn it, 0: nothing tells. `up`: how much of a patch of a map faces up, -1 .. 1; what is
/// scanned there is mostly seen from above.
int side_of(const TreeShape& shape, double eyes, double space, double up, bool inward) {
  if (std::abs(eyes) > clear_vote) return eyes < 0 ? -1 : 1;
  const bool closed = shape.openness() < 0.1 && std::abs(shape.outward()) > 0.2;
  if (closed) return (shape.volume < 0) != inward ? -1 : 1;
  const double vote = inward ? -space : space + gravity_weight * up;
  return std::abs(vote) > clear_vote ? (vote < 0 ? -1 : 1) : 0;
}

/// What single places see: 1 mostly their front faces open space, -1 mostly their back does, 0 anything else. The
/// inside of a closed patch (`goes_round`, a value a tree) may see a mouth; what an open one's other side sees says
/// little.
std::vector<int> votes_of_places(const Sites& sites, const SpanningForest& forest, const std::vector<char>& goes_round,
                                 const FreeSpace& space, std::uint32_t step,
                                 const std::vector<Eigen::Vector3f>& normals) {
  constexpr double open = 0.4, shut = 0.05, mouth = 0.3; // mouth: of the other side's openness
  std::vector<int> votes((sites.size() + step - 1) / step);
  parallel_ranges(votes.size(), 512, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const auto s = static_cast<std::uint32_t>(v * step);
      const Eigen::Vector3d n = normals[s].cast<double>();
      const double front = space.openness(sites.position(s), n), back = space.openness(sites.position(s), -n);
      const double most_shut = std::max(shut, goes_round[forest.tree[s]] ? mouth * std::max(front, back) : 0.0);
      votes[v] = front > open && back < most_shut ? 1 : back > open && front < most_shut ? -1 : 0;
    }
  });
  return votes;
}

/// Islands that the chain of neighbours left on the wrong side, as on the terraces of voxels: turned where all places
/// around that see open space see it at their backs.
void turn_islands(const Sites& sites, const SpanningForest& forest, const std::vector<char>& goes_round,
                  const FreeSpace& space, std::vector<Eigen::Vector3f>& normals) {
  constexpr std::uint32_t most_votes = 200'000;
  constexpr unsigned jury = 12;
  const std::uint32_t step = (sites.size() + most_votes - 1) / most_votes;
  const std::vector<int> votes = votes_of_places(sites, forest, goes_round, space, step, normals);
  if (std::count(votes.begin(), votes.end(), -1) == 0) return;
  std::vector<Eigen::Vector3d> places;
  for (std::size_t v = 0; v < votes.size(); ++v)
    places.push_back(sites.position(static_cast<std::uint32_t>(v * step)));
  const Sites voters(places);
  std::vector<char> turn(sites.size(), 0);
  parallel_ranges(sites.size(), 1024, [&](std::size_t begin, std::size_t end) {
    std::array<Neighbour, jury> near;
    for (std::size_t s = begin; s < end; ++s) {
      const Eigen::Vector3d& place = sites.position(static_cast<std::uint32_t>(s));
      const unsigned count = voters.nearest_to(voters.to_local(place), jury, near.data());
      int against = 0, with = 0;
      for (unsigned j = 0; j < count; ++j) {
        const std::uint32_t v = *voters.points(near[j].site).begin();
        const float cosine = normals[s].dot(normals[std::size_t(v) * step]);
        if (std::abs(cosine) < 0.5f) continue;
        const int vote = cosine > 0 ? votes[v] : -votes[v];
        against += vote < 0;
        with += vote > 0;
      }
      turn[s] = against > 0 && against > 3 * with;
    }
  });
  for (std::uint32_t s = 0; s < sites.size(); ++s)
    if (turn[s]) normals[s] = -normals[s];
}

Orientation turn_patches(const Sites& sites, const OrientationEvidence& evidence, const FreeSpace& space,
                         std::vector<Eigen::Vector3f>& normals) {
  const SpanningForest forest = agree_normals(sites, normals);
  const std::vector<TreeShape> shapes = tree_shapes(sites, forest, normals);
  const auto samples = sample_patches(forest, shapes);
  std::vector<Eigen::Vector3d> eyes;
  for (const Eigen::Vector3d& eye : evidence.eyes)
    eyes.push_back(sites.to_local(eye));
  const bool inward = evidence.kind.kind == CloudKind::room;
  const Eigen::Vector3d up =
      evidence.kind.kind == CloudKind::map && evidence.kind.up ? *evidence.kind.up : Eigen::Vector3d(0, 0, 0);
  std::vector<int> side(forest.trees, 0);
  std::vector<char> decided(forest.trees, 0), by_eyes(forest.trees, 0);
  parallel_ranges(forest.trees, 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      if (shapes[t].sites < smallest_patch && forest.trees > 1) continue;
      const double seen = eyes.empty() ? 0.0 : vote_of_eyes(sites, eyes, space, samples[t], normals);
      by_eyes[t] = std::abs(seen) > clear_vote;
      const double seen_from = by_eyes[t] ? 0.0 : vote_of_space(sites, space, samples[t], normals);
      side[t] = side_of(shapes[t], seen, seen_from, shapes[t].vector_area.dot(up) / shapes[t].area, inward);
      decided[t] = side[t] != 0;
    }
  });
  const auto by_sites = [](const TreeShape& a, const TreeShape& b) { return a.sites < b.sites; };
  const auto largest =
      static_cast<std::size_t>(std::max_element(shapes.begin(), shapes.end(), by_sites) - shapes.begin());
  if (std::count(decided.begin(), decided.end(), 1) == 0) {
    side[largest] = must_flip(shapes[largest]) ? -1 : 1;
    decided[largest] = 1;
  }
  for (std::uint32_t s = 0; s < sites.size(); ++s)
    if (side[forest.tree[s]] < 0) normals[s] = -normals[s];
  std::size_t in_doubt = 0;
  if (std::find(decided.begin(), decided.end(), 0) != decided.end()) {
    const std::vector<int> signs = fragment_signs(sites, forest, decided, normals);
    for (std::uint32_t s = 0; s < sites.size(); ++s) {
      const std::uint32_t t = forest.tree[s];
      if (decided[t]) continue;
      in_doubt += signs[t] == 0;
      if (signs[t] != 0 ? signs[t] < 0 : must_flip(shapes[t])) normals[s] = -normals[s];
    }
  }
  if (!inward && std::count(by_eyes.begin(), by_eyes.end(), 1) == 0) {
    std::vector<char> goes_round;
    for (const TreeShape& shape : shapes)
      goes_round.push_back(shape.openness() < open_surface);
    turn_islands(sites, forest, goes_round, space, normals);
  }
  Orientation result;
  result.doubt = static_cast<double>(in_doubt) / static_cast<double>(sites.size());
  result.how = by_eyes[largest] ? "towards the scene's camera and lights"
               : inward         ? "inwards, as a room's"
                                : description(shapes[largest]);
  return result;
}

/// Each site to the station that saw its first point; without that knowledge to the nearest that can see it.
void turn_towards_stations(const Sites& sites, const OrientationEvidence& evidence,
                           const std::vector<Eigen::Vector3d>& stations, const FreeSpace& space,
                           std::vector<Eigen::Vector3f>& normals) {
  parallel_ranges(sites.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      const Eigen::Vector3d& place = sites.position(static_cast<std::uint32_t>(s));
      const std::uint32_t point = *sites.points(static_cast<std::uint32_t>(s)).begin();
      Eigen::Vector3d station = stations.front();
      if (!evidence.station.empty()) {
        station = stations[std::min<std::size_t>(evidence.station[point], stations.size() - 1)];
      } else if (stations.size() > 1) {
        double nearest = 1e300;
        for (const Eigen::Vector3d& other : stations) {
          const double distance = (other - place).norm() * (space.clear(place, other) ? 1.0 : 1e6);
          if (distance < nearest) nearest = distance, station = other;
        }
      }
      if (normals[s].cast<double>().dot(station - place) < 0) normals[s] = -normals[s];
    }
  });
}

/// Height fields: what is nearly upright goes with the patch it belongs to.
void turn_upwards(const Sites& sites, const Eigen::Vector3d& up, std::vector<Eigen::Vector3f>& normals) {
  const Eigen::Vector3f direction = up.cast<float>();
  parallel_ranges(sites.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s)
      if (normals[s].dot(direction) < 0.0f) normals[s] = -normals[s];
  });
}

std::string axis_name(const Eigen::Vector3d& direction) {
  int axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  return std::string(direction[axis] < 0 ? "-" : "") + "xyz"[axis];
}

} // namespace

bool may_have_seen(const Sites& sites, const Eigen::Vector3d& station) {
  const Eigen::Vector3d place = sites.to_local(station);
  const double usual = median(
      sites.size(), [&](std::size_t s) { return (sites.position(static_cast<std::uint32_t>(s)) - place).norm(); });
  return usual <= farthest_sensor * 4.0; // half of the cloud lies within 1 local unit of its median
}

Orientation orient_normals(const Sites& sites, const OrientationEvidence& evidence, const FreeSpace& space,
                           std::vector<Eigen::Vector3f>& normals) {
  if (evidence.viewpoint) {
    turn_towards(sites, sites.to_local(*evidence.viewpoint), normals);
    return {"towards the viewpoint", 0.0};
  }
  if (!evidence.stations.empty()) {
    std::vector<Eigen::Vector3d> stations;
    for (const Eigen::Vector3d& station : evidence.stations)
      stations.push_back(sites.to_local(station));
    turn_towards_stations(sites, evidence, stations, space, normals);
    return {stations.size() == 1 ? "towards the scanner"
                                 : "towards the " + std::to_string(stations.size()) + " scanner positions",
            0.0};
  }
  if (evidence.kind.sensor) {
    turn_towards(sites, sites.to_local(*evidence.kind.sensor), normals);
    return {"towards the sensor at the origin", 0.0};
  }
  if (evidence.kind.kind == CloudKind::terrain) {
    turn_upwards(sites, *evidence.kind.up, normals);
    return {"upwards along " + axis_name(*evidence.kind.up), 0.0};
  }
  return turn_patches(sites, evidence, space, normals);
}

} // namespace pointgi
