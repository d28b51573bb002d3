#include "host/cloud/normals.h"
#include "octree/parallel.h"
#include <Eigen/Dense>
#include <array>
#include <cmath>

namespace pointgi {

namespace {

constexpr unsigned pca_neighbours = 18;  // with the weights below about as smooth as 12 equal ones
constexpr unsigned wide_neighbours = 72; // four scan lines, where 18 are all on one
// Where noise hides the surface wider neighbourhoods show it again: as many neighbours as it takes, as long as each
// step makes the plane clearly flatter for its size. Noise gives 0.71 for twice the neighbours, an edge 1, a curve 2.
constexpr std::array<unsigned, 4> scales = {pca_neighbours, 36, 72, 144};
constexpr double noise_like = 0.06; // roughness from which a wider look is worth its time
constexpr double flatter = 0.88;
constexpr double formless = 0.3; // least variance over the middle one; a sheet whose noise is its spacing: 0.15 at most
constexpr float lively = 0.5f;   // cosine under which neighbours' normals are another face's
constexpr float another_piece =
    4.0f; // times the median distance of the neighbours: beyond, a fragment ends and something else is
constexpr double flat_enough = 0.01; // ratio of the middle to the largest variance under which points are a line
constexpr double on_a_line = 1e-6;   // ... and under which nothing tells one direction across it from another

// Across an edge the plane through all neighbours lies slanted. What tells is its roughness: root mean square distance
// from the plane over the distance of the last neighbour.
constexpr float rough_enough = 0.03f;   // the curvature of a well sampled surface; an edge of 90° gives 0.1 to 0.2
constexpr float clearly_flatter = 0.4f; // the chance that noise makes one of 18 neighbours look so is small
constexpr double on_plane = 0.02;       // distance from a neighbour's plane that counts as on it, over that distance

struct Plane {
  Eigen::Vector3d normal;
  double middle_to_large; ///< ratio of variances
  double least_to_middle;
  double roughness;
};

struct Estimate {
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();
  float roughness = 0;
  bool noisy = false; ///< the plane was found in more neighbours than usual
  Structure structure = Structure::surface;
};

/// Each neighbour counts with 1 - d²/d_k²: the last one has no weight, so which of several equally far ones the search
/// returned makes no difference.
Plane fit_plane(const Sites& sites, std::uint32_t site, const Neighbour* neighbours, unsigned count) {
  const Eigen::Vector3d& origin = sites.position(site);
  const double reach = std::sqrt(static_cast<double>(neighbours[count - 1].distance2));
  // With two or three neighbours the last one is needed.
  const double fade = count < 6 ? 0.5 : 1.0;
  const double scale = reach > 0 ? 1.0 / reach : 1.0;
  double weights = 1.0; // the site itself, at offset zero
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (unsigned i = 0; i < count; ++i) {
    const Eigen::Vector3d offset = (sites.position(neighbours[i].site) - origin) * scale;
    const double weight = std::max(0.0, 1.0 - fade * offset.squaredNorm());
    weights += weight;
    mean += weight * offset;
    moments += weight * offset * offset.transpose();
  }
  mean /= weights;
  const Eigen::Matrix3d covariance = moments / weights - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  const double large = solver.eigenvalues()[2];
  const double middle = std::max(0.0, solver.eigenvalues()[1]), least = std::max(0.0, solver.eigenvalues()[0]);
  return {solver.eigenvectors().col(0), large > 0 ? middle / large : 0.0, middle > 0 ? least / middle : 0.0,
          std::sqrt(least)};
}

/// The coordinate axis that is most across, made exactly perpendicular: the same for all points of a line.
Eigen::Vector3d across(const Eigen::Vector3d& line) {
  int axis = 0;
  line.cwiseAbs().minCoeff(&axis);
  const Eigen::Vector3d unit = Eigen::Vector3d::Unit(axis);
  return (unit - line * line[axis] / line.squaredNorm()).normalized();
}

unsigned neighbours_in_piece(const Sites& sites, std::uint32_t site, unsigned k, Neighbour* neighbours) {
  unsigned count = sites.nearest(site, k, neighbours);
  const unsigned half = (count + 1) / 2;
  while (count > half && neighbours[count - 1].distance2 > another_piece * another_piece * neighbours[half].distance2)
    --count;
  return count;
}

/// What the neighbourhood is made of, by its variances.
Structure structure_of(const Plane& plane) {
  constexpr double thin = 0.01;
  if (plane.middle_to_large < thin) return Structure::line;
  return plane.least_to_middle > formless ? Structure::volume : Structure::surface;
}

Estimate estimate(const Sites& sites, std::uint32_t site) {
  std::array<Neighbour, scales.back()> neighbours;
  unsigned count = neighbours_in_piece(sites, site, pca_neighbours, neighbours.data());
  if (count == 0) return {};
  Plane plane = fit_plane(sites, site, neighbours.data(), count);
  bool noisy = false;
  if (plane.middle_to_large < flat_enough && sites.size() > pca_neighbours + 1) {
    count = neighbours_in_piece(sites, site, wide_neighbours, neighbours.data());
    plane = fit_plane(sites, site, neighbours.data(), count);
  } else {
    for (std::size_t scale = 1; scale < scales.size() && plane.roughness > noise_like && sites.size() > scales[scale];
         ++scale) {
      const unsigned wider = neighbours_in_piece(sites, site, scales[scale], neighbours.data());
      const Plane next = fit_plane(sites, site, neighbours.data(), wider);
      // Among noise as large as the neighbourhood nothing is flat yet: the scale after the next may tell.
      if (next.roughness > (plane.least_to_middle > formless ? 1.0 : flatter) * plane.roughness) break;
      plane = next;
      count = wider;
      noisy = true;
    }
  }
  Eigen::Vector3d normal = plane.normal;
  if (plane.middle_to_large < on_a_line)
    normal = across((sites.position(neighbours[count - 1].site) - sites.position(site)).normalized());
  if (!(normal.squaredNorm() > 0.5) || !normal.allFinite()) normal = Eigen::Vector3d::UnitZ();
  return {normal.normalized().cast<float>(), static_cast<float>(plane.roughness), noisy,
          count < pca_neighbours ? Structure::surface : structure_of(plane)};
}

/// Beside an edge: the normal of the flattest neighbour whose plane the site lies on, so that edges stay sharp and both
/// their sides keep their area. Elsewhere: its own.
Eigen::Vector3f sharpened(const Sites& sites, const std::vector<Estimate>& estimates, std::uint32_t site) {
  Estimate best = estimates[site];
  if (best.roughness < rough_enough) return best.normal;
  std::array<Neighbour, pca_neighbours> near;
  const unsigned count = sites.nearest(site, pca_neighbours, near.data());
  const double reach = count > 0 ? std::sqrt(static_cast<double>(near[count - 1].distance2)) : 0.0;
  float flattest = best.roughness * clearly_flatter;
  for (unsigned j = 0; j < count; ++j) {
    const Estimate& other = estimates[near[j].site];
    const float roughness = std::max(other.roughness, 0.1f * rough_enough); // below that all are flat: the nearest wins
    if (roughness >= flattest) continue;
    const Eigen::Vector3d e = sites.position(near[j].site) - sites.position(site);
    if (std::abs(e.dot(other.normal.cast<double>())) > (on_plane + static_cast<double>(other.roughness)) * reach)
      continue;
    flattest = roughness;
    best = other;
  }
  return best.normal;
}

/// Normals of noisy places, averaged with those of their neighbours that do not belong to another face. Signs do not
/// matter.
std::vector<Eigen::Vector3f> evened(const Sites& sites, const std::vector<Estimate>& estimates,
                                    const std::vector<Eigen::Vector3f>& normals) {
  std::vector<Eigen::Vector3f> result(normals);
  parallel_ranges(sites.size(), 1024, [&](std::size_t begin, std::size_t end) {
    std::array<Neighbour, scales[1]> near;
    for (std::size_t s = begin; s < end; ++s) {
      if (!estimates[s].noisy) continue;
      const unsigned count = sites.nearest(static_cast<std::uint32_t>(s), scales[1], near.data());
      Eigen::Vector3f sum = normals[s];
      for (unsigned j = 0; j < count; ++j) {
        const Eigen::Vector3f& other = normals[near[j].site];
        const float cosine = other.dot(normals[s]);
        if (std::abs(cosine) < lively) continue;
        const float weight = 1.0f - near[j].distance2 / std::max(near[count - 1].distance2, 1e-30f);
        sum += std::copysign(weight, cosine) * other;
      }
      result[s] = sum.normalized();
    }
  });
  return result;
}

} // namespace

Eigen::Vector3f estimate_normal(const Sites& sites, std::uint32_t site) {
  return estimate(sites, site).normal;
}

std::vector<Eigen::Vector3f> estimate_normals(const Sites& sites, std::vector<Structure>* structure) {
  std::vector<Estimate> estimates(sites.size());
  parallel_ranges(sites.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s)
      estimates[s] = estimate(sites, static_cast<std::uint32_t>(s));
  });
  std::vector<Eigen::Vector3f> normals(sites.size());
  parallel_ranges(sites.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s)
      normals[s] =
          estimates[s].noisy ? estimates[s].normal : sharpened(sites, estimates, static_cast<std::uint32_t>(s));
  });
  const auto is_noisy = [](const Estimate& e) { return e.noisy; };
  if (std::any_of(estimates.begin(), estimates.end(), is_noisy))
    for (int pass = 0; pass < 2; ++pass)
      normals = evened(sites, estimates, normals);
  if (structure != nullptr) {
    structure->resize(sites.size());
    for (std::uint32_t s = 0; s < sites.size(); ++s)
      (*structure)[s] = estimates[s].structure;
  }
  return normals;
}

std::vector<Eigen::Vector3f> face_normals(const PointCloud& cloud) {
  // Faces of one vertex are added in file order, by one thread: sums in another order would have other last bits.
  std::vector<Eigen::Vector3d> sums(cloud.size(), Eigen::Vector3d::Zero());
  for (const auto& face : cloud.triangle) {
    if (face[0] >= cloud.size() || face[1] >= cloud.size() || face[2] >= cloud.size()) continue;
    std::array<Eigen::Vector3d, 3> edge;
    double longest = 0;
    for (int c = 0; c < 3; ++c) {
      edge[c] = cloud.position[face[(c + 1) % 3]] - cloud.position[face[c]];
      longest = std::max(longest, edge[c].cwiseAbs().maxCoeff());
    }
    if (!(longest > 0)) continue;
    for (auto& e : edge)
      e /= longest; // so that faces of any size keep their digits
    const Eigen::Vector3d twice_area = edge[0].cross(edge[1]);
    const double length = twice_area.norm();
    if (!(length > 1e-12)) continue; // a sliver whose normal is rounding
    for (int c = 0; c < 3; ++c)
      sums[face[c]] += twice_area * (std::atan2(length, -edge[c].dot(edge[(c + 2) % 3])) / length);
  }
  std::vector<Eigen::Vector3f> normals(cloud.size());
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const double length = sums[i].norm(); // an angle; faces that cancel leave nothing to go by
    normals[i] = length > 1e-6 ? Eigen::Vector3f((sums[i] / length).cast<float>()) : Eigen::Vector3f::Zero();
  }
  return normals;
}

std::size_t fill_missing_normals(const PointCloud& cloud, const Sites& sites, std::vector<Eigen::Vector3f>& normals) {
  std::vector<std::uint32_t> known_point;
  for (std::size_t i = 0; i < normals.size(); ++i)
    if (!normals[i].isZero(0)) known_point.push_back(static_cast<std::uint32_t>(i));
  const std::size_t missing = normals.size() - known_point.size();
  if (missing == 0) return 0;

  std::vector<Eigen::Vector3d> known_position;
  for (const std::uint32_t point : known_point)
    known_position.push_back(cloud.position[point]);
  const std::unique_ptr<Sites> known = known_position.empty() ? nullptr : std::make_unique<Sites>(known_position);

  const std::vector<Eigen::Vector3f> given = normals;
  parallel_ranges(sites.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      const auto site = static_cast<std::uint32_t>(s);
      bool any = false;
      for (const std::uint32_t point : sites.points(site))
        any = any || given[point].isZero(0);
      if (!any) continue;
      Eigen::Vector3f normal = estimate_normal(sites, site);
      if (known) {
        std::array<Neighbour, 6> near;
        const std::uint32_t first = *sites.points(site).begin();
        const unsigned count = known->nearest_to(known->to_local(cloud.position[first]), 6, near.data());
        float agreement = 0;
        for (unsigned j = 0; j < count; ++j)
          agreement += normal.dot(given[known_point[*known->points(near[j].site).begin()]]);
        if (agreement < 0) normal = -normal;
      }
      for (const std::uint32_t point : sites.points(site))
        if (given[point].isZero(0)) normals[point] = normal;
    }
  });
  return missing;
}

} // namespace pointgi
