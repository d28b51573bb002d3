#include "host/cloud/turn_normals.h"
#include "octree/parallel.h"
#include <Eigen/Geometry>
#include <algorithm>

namespace pointgi {

namespace {

// Closed surfaces have a vector area near 0 (scans with a hole underneath up to 0.1); an outwardness below -0.1 is far
// from what noise or a mixture of signs gives (a sphere facing inwards has -1, a long-legged animal -0.3).
constexpr double closed_openness = 0.1;
constexpr double inward_outwardness = -0.1;
constexpr std::size_t grain = 1 << 16;

struct Areas {
  double area = 0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero(); ///< sum of A x
  Eigen::Vector3d vector_area = Eigen::Vector3d::Zero();

  Areas& operator+=(const Areas& other) {
    area += other.area;
    centre += other.centre;
    vector_area += other.vector_area;
    return *this;
  }
};

struct Volume {
  double volume = 0; ///< sum of A n.(x - c): three times the volume
  double arms = 0;   ///< sum of A |x - c|

  Volume& operator+=(const Volume& other) {
    volume += other.volume;
    arms += other.arms;
    return *this;
  }
};

struct Bounds {
  Eigen::AlignedBox3d box;

  Bounds& operator+=(const Bounds& other) {
    box.extend(other.box);
    return *this;
  }
};

/// |sum of A n| / sum of A is 0 for a closed surface, 1 for a plane; sum of A n.(x - c) / sum of A |x - c| is 1 for a
/// sphere, -1 when it faces inwards.
bool is_closed_and_inward(const PointCloud& cloud, const Sites& sites) {
  Areas areas = parallel_sum(cloud.size(), grain, Areas(), [&](Areas& sum, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto a = static_cast<double>(cloud.area[i]);
      sum.area += a;
      sum.centre += a * sites.to_local(cloud.position[i]);
      sum.vector_area += a * cloud.normal[i].cast<double>();
    }
  });
  if (areas.vector_area.norm() / areas.area > closed_openness) return false;
  const Eigen::Vector3d centre = areas.centre / areas.area;
  const Volume v = parallel_sum(cloud.size(), grain, Volume(), [&](Volume& sum, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d arm = sites.to_local(cloud.position[i]) - centre;
      sum.volume += static_cast<double>(cloud.area[i]) * cloud.normal[i].cast<double>().dot(arm);
      sum.arms += static_cast<double>(cloud.area[i]) * arm.norm();
    }
  });
  return (v.arms > 0 ? v.volume / v.arms : 0.0) <= inward_outwardness;
}

} // namespace

void turn_round(PointCloud& cloud) {
  parallel_ranges(cloud.normal.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      cloud.normal[i] = -cloud.normal[i];
  });
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

void turn_inside_out_if_inward(PointCloud& cloud, const Sites& sites, CloudReport& report) {
  if (!is_closed_and_inward(cloud, sites)) return;
  turn_round(cloud);
  report.normals_from += ", flipped";
  report.warnings.push_back(
      "the surface is closed and its normals (from the " +
      std::string(report.normals_from.rfind("faces", 0) == 0 ? "faces" : "file") +
      ") point inwards as a whole: all were flipped to face outwards; set normals = \"file\" to keep "
      "them, for instance for a room seen from inside");
}

bool is_seen_from_inside(const PointCloud& cloud, const std::vector<Eigen::Vector3d>& eyes) {
  if (eyes.empty()) return false;
  const Eigen::AlignedBox3d box =
      parallel_sum(cloud.size(), grain, Bounds(), [&](Bounds& sum, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
          sum.box.extend(cloud.position[i]);
      }).box;
  return std::any_of(eyes.begin(), eyes.end(), [&](const Eigen::Vector3d& eye) {
    return (eye.array() > box.min().array()).all() && (eye.array() < box.max().array()).all();
  });
}

} // namespace pointgi
