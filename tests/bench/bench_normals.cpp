/// How well complete_cloud() finds normals and sides where a file has none: mean angle and share of right sides,
/// against the normals of the mesh whose vertices the points are, at several noises and with strays. bench_normals
/// MESH.ply...        the meshes must be closed, or nearly so, for their sides to mean anything
#include "host/cloud/complete.h"
#include "host/cloud/normals.h"
#include "host/cloud/readers/ply.h"
#include "host/run.h"
#include <Eigen/Geometry>
#include <chrono>
#include <cstdio>
#include <random>

using namespace pointgi;

namespace {

/// Side of a square that holds one point.
double spacing_of(const PointCloud& mesh) {
  double area = 0;
  for (const auto& t : mesh.triangle)
    area += 0.5 * (mesh.position[t[1]] - mesh.position[t[0]]).cross(mesh.position[t[2]] - mesh.position[t[0]]).norm();
  return std::sqrt(area / static_cast<double>(mesh.size()));
}

struct Result {
  double mean_angle_deg = 0, right_sides = 0, seconds = 0;
  std::string how;
};

Result measure(const PointCloud& mesh, const std::vector<Eigen::Vector3f>& truth, double noise, double strays,
               unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> gauss;
  const double spacing = spacing_of(mesh);
  PointCloud cloud;
  std::vector<std::size_t> of;
  Eigen::Vector3d low = mesh.position[0], high = low;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    low = low.cwiseMin(mesh.position[i]), high = high.cwiseMax(mesh.position[i]);
    if (truth[i].isZero()) continue;
    of.push_back(i);
    const Eigen::Vector3d n = truth[i].cast<double>();
    cloud.position.push_back(mesh.position[i] + (noise > 0 ? noise * spacing * gauss(random) : 0.0) * n);
  }
  const std::size_t points = of.size();
  std::uniform_real_distribution<double> unit(-1.0, 1.0), far(std::log(1.0), std::log(40.0));
  for (std::size_t k = 0; k < static_cast<std::size_t>(strays * static_cast<double>(points)); ++k) {
    const Eigen::Vector3d direction(gauss(random), gauss(random), gauss(random));
    cloud.position.push_back(0.5 * (low + high) + direction.normalized() * (high - low).norm() * std::exp(far(random)));
  }
  CloudReport report;
  CompleteOptions options;
  options.strays = StrayPolicy::shrink;
  const auto begin = std::chrono::steady_clock::now();
  complete_cloud(cloud, options, report);
  Result result;
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::size_t right = 0;
  for (std::size_t i = 0; i < points; ++i) {
    const double cosine = static_cast<double>(cloud.normal[i].dot(truth[of[i]]));
    result.mean_angle_deg += std::acos(std::min(1.0, std::fabs(cosine))) * 57.29577951;
    right += cosine > 0;
  }
  result.mean_angle_deg /= static_cast<double>(points);
  result.right_sides = static_cast<double>(right) / static_cast<double>(points);
  result.how = report.normals_from;
  return result;
}

} // namespace

int main(int argc, char** argv) {
  for (int a = 1; a < argc; ++a) {
    CloudReport report;
    PointCloud mesh = read_ply(argv[a], {}, report);
    std::vector<Eigen::Vector3f> truth = face_normals(mesh);
    double volume = 0;
    for (const auto& t : mesh.triangle)
      volume += mesh.position[t[0]].dot(mesh.position[t[1]].cross(mesh.position[t[2]]));
    if (volume < 0)
      for (Eigen::Vector3f& n : truth)
        n = -n;
    std::printf("%s: %zu points\n", argv[a], mesh.size());
    for (const double noise : {0.0, 0.5, 1.0})
      for (const double strays : {0.0, 0.01}) {
        const unsigned draws = strays > 0 ? 10 : 1;
        double worst = 1.0, angle = 0.0;
        Result r;
        for (unsigned d = 0; d < draws; ++d) {
          r = measure(mesh, truth, noise, strays, d + 1);
          worst = std::min(worst, r.right_sides), angle = std::max(angle, r.mean_angle_deg);
        }
        std::printf("  noise %.1f spacings, strays %.0f %%: mean angle %.2f deg, right sides %.2f %% (worst of %u), "
                    "%.2f s, %s\n",
                    noise, 100.0 * strays, angle, 100.0 * worst, draws, r.seconds, r.how.c_str());
        std::fflush(stdout);
      }
  }
}
