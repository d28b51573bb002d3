/// Furnaces: a closed room of albedo rho in which all emits E settles at B = E / (1 - rho) (truths.md section 1).
#include "fmm/operators/fmm_operator.h"
#include "fmm/ref/direct_sum.h"
#include "fmm/solve/solve.h"
#include "tests/support/exchange.h"
#include <catch2/catch.hpp>
#include <omp.h>

using namespace pointgi;
using namespace pointgi::test;

namespace {

struct Room {
  ClusterTree tree;
  std::vector<Link> links;
  FmmOperator exchange;
  std::vector<double> area;

  explicit Room(const std::vector<Splat>& splats)
      : tree(build_clusters(splats, {})), links(links_without_visibility(tree)), exchange(tree, links, {}) {
    for (const Splat& s : tree.points)
      area.push_back(s.area);
  }
  std::size_t size() const { return area.size(); }

  Solution solve(const std::array<double, 3>& emission, const std::array<double, 3>& albedo,
                 const SolveOptions& options = {}) {
    std::vector<double> e, rho;
    for (std::size_t i = 0; i < size(); ++i)
      for (int c = 0; c < 3; ++c) {
        e.push_back(emission[c]);
        rho.push_back(albedo[c]);
      }
    return solve_radiosity(exchange, e, rho, area, options);
  }
  double mean(const std::vector<double>& values, int colour) const {
    double sum = 0.0, all = 0.0;
    for (std::size_t i = 0; i < size(); ++i) {
      sum += area[i] * values[3 * i + colour];
      all += area[i];
    }
    return sum / all;
  }
};

void check_furnace(Room& room) {
  const double albedo[] = {0.5, 0.9, 0.99}, allowed[] = {0.01, 0.01, 0.03}, emission[] = {1.0, 2.0, 0.25};
  SolveOptions options;
  options.tolerance = 1e-5;
  const Solution s = room.solve({1.0, 2.0, 0.25}, {0.5, 0.9, 0.99}, options);
  CHECK(s.end == SolveEnd::converged);
  CHECK(complaint_of(s).empty());
  CHECK(s.residual <= options.tolerance);
  CHECK(s.krylov_steps > 0); // Jacobi alone takes over a thousand sweeps at 0.99
  CHECK(s.applies < 60);
  for (int c = 0; c < 3; ++c) {
    CAPTURE(albedo[c]);
    CHECK(room.mean(s.radiosity, c) == Approx(emission[c] / (1.0 - albedo[c])).epsilon(allowed[c]));
  }
}

} // namespace

TEST_CASE("furnace: sphere") {
  Room room(inside_sphere(20000));
  check_furnace(room);
  // Closed, nothing absorbs: said so at once, not iterated for ever.
  const Solution s = room.solve({1.0, 1.0, 1.0}, {0.5, 1.0, 0.5});
  CHECK(s.end == SolveEnd::keeps_its_light);
  CHECK(s.rate > 0.9995);
  CHECK(s.applies < 20);
  CHECK(s.history.size() == s.sweeps);
  CHECK_THAT(complaint_of(s), Catch::Contains("lower the albedo"));
}

TEST_CASE("furnace: cube") {
  Room room(inside_cube(58));
  check_furnace(room);
}

TEST_CASE("solvers agree, whatever the number of threads") {
  Room room(inside_sphere(2000));
  SolveOptions options;
  options.tolerance = 1e-6;
  const Solution krylov = room.solve({1.0, 0.0, 0.5}, {0.9, 0.9, 0.8}, options);
  options.krylov = false;
  const Solution jacobi = room.solve({1.0, 0.0, 0.5}, {0.9, 0.9, 0.8}, options);
  CHECK(jacobi.krylov_steps == 0);
  CHECK(jacobi.end == SolveEnd::converged);
  CHECK(krylov.applies < jacobi.applies / 2);
  // Residuals of 1e-6, which 1 / (1 - 0.9) makes 1e-5.
  CHECK(relative_l2(krylov.radiosity, jacobi.radiosity) < 2e-5);
  CHECK(room.mean(krylov.radiosity, 1) == 0.0);

  options.krylov = true;
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const Solution alone = room.solve({1.0, 0.0, 0.5}, {0.9, 0.9, 0.8}, options);
  omp_set_num_threads(3);
  const Solution three = room.solve({1.0, 0.0, 0.5}, {0.9, 0.9, 0.8}, options);
  omp_set_num_threads(threads);
  CHECK(alone.radiosity == krylov.radiosity);
  CHECK(three.radiosity == krylov.radiosity);
}

TEST_CASE("mid links: the linear operator agrees with the one that judges, and answers to both signs") {
  const ClusterTree tree = build_clusters(inside_cube(16), {});
  auto links = links_without_visibility(tree);
  for (Link& link : links)
    if (link.kind == LinkKind::far) link.kind = LinkKind::mid;
  FmmOperator exchange(tree, links, {});
  const auto b = varied_radiosity(tree.points);
  std::vector<double> now, before, minus = b, negative;
  CHECK_THROWS_AS(exchange.apply(b, Judge::before, now), std::invalid_argument);
  exchange.apply(b, Judge::now, now);
  exchange.apply(b, Judge::before, before);
  CHECK(now == before);
  for (double& value : minus)
    value = -value;
  exchange.apply(minus, Judge::before, negative);
  for (double& value : negative)
    value = -value;
  CHECK(negative == now);
  // A source as one flux vector, at 0.55 of the distance: some per cent.
  std::vector<std::uint32_t> all;
  for (std::uint32_t i = 0; i < tree.points.size(); ++i)
    all.push_back(i);
  CHECK(relative_l2(now, direct_sum(tree.points, b, all)) < 0.05);
}

TEST_CASE("a dark scene is solved, and sizes that differ are refused") {
  Room room(inside_sphere(200));
  const Solution s = room.solve({0.0, 0.0, 0.0}, {0.5, 0.5, 0.5});
  CHECK(s.end == SolveEnd::converged);
  CHECK(s.applies == 0);
  CHECK(room.mean(s.radiosity, 0) == 0.0);
  const std::vector<double> few(3, 0.0);
  CHECK_THROWS_AS(solve_radiosity(room.exchange, few, few, few, {}), std::invalid_argument);
}
