#include "host/cloud/cloud_warnings.h"
#include "host/cloud/percent.h"
#include "octree/parallel.h"
#include <Eigen/Dense>

namespace pointgi {

namespace {

constexpr double warn_opposite = 0.02;
constexpr double line_like = 1e-8; // ratio of variances (of their roots: 1e-4)
constexpr std::size_t grain = 1 << 16;

} // namespace

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
  const Eigen::Vector3d mean = parallel_sum(sites.size(), grain, Eigen::Vector3d(Eigen::Vector3d::Zero()),
                                            [&](Eigen::Vector3d& sum, std::size_t begin, std::size_t end) {
                                              for (std::size_t s = begin; s < end; ++s)
                                                sum += sites.position(static_cast<std::uint32_t>(s)) / sites.size();
                                            });
  const Eigen::Matrix3d moments = parallel_sum(sites.size(), grain, Eigen::Matrix3d(Eigen::Matrix3d::Zero()),
                                               [&](Eigen::Matrix3d& sum, std::size_t begin, std::size_t end) {
                                                 for (std::size_t s = begin; s < end; ++s) {
                                                   const Eigen::Vector3d arm =
                                                       sites.position(static_cast<std::uint32_t>(s)) - mean;
                                                   sum += arm * arm.transpose();
                                                 }
                                               });
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments / moments.trace(), Eigen::EigenvaluesOnly);
  if (solver.eigenvalues()[1] < line_like * solver.eigenvalues()[2])
    report.warnings.push_back("all points lie on a line: the normals across it and the splats' sizes are guesses; give "
                              "normals and radii in the file");
}

void warn_of_opposite(double opposite, bool signs_given, CloudReport& report) {
  if (opposite <= warn_opposite || report.kind == CloudKind::foliage) return;
  report.warnings.push_back(
      "the normals oppose each other between " + percent(opposite) + " of the neighbouring points: " +
      (signs_given ? "their sides are not consistent in the file; normals = \"estimate\" finds new ones"
                   : "no consistent side was found; a viewpoint, or normals in the file, would tell"));
}

} // namespace pointgi
