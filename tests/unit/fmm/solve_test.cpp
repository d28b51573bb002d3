/// The solver over the operator in double.
#include "fmm/operators/fmm_operator.h"
#include "fmm/ref/direct_sum.h"
#include "fmm/solve/solve.h"
#include "tests/support/room.h"
#include <catch2/catch.hpp>
#include <omp.h>

using namespace pointgi;
using namespace pointgi::test;

namespace {

Room room_of(const std::vector<Splat>& splats) {
  return {splats, [](const ClusterTree& tree, View<Link> links) {
            return std::make_unique<FmmOperator>(tree, links, FmmOptions{});
          }};
}

} // namespace

TEST_CASE("solvers agree, whatever the number of threads") {
  Room room = room_of(inside_sphere(2000));
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
  CHECK_THROWS_AS(exchange.apply(b, LinearisationPoint::kept, now), std::invalid_argument);
  exchange.apply(b, LinearisationPoint::current, now);
  exchange.apply(b, LinearisationPoint::kept, before);
  CHECK(now == before);
  for (double& value : minus)
    value = -value;
  exchange.apply(minus, LinearisationPoint::kept, negative);
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
  Room room = room_of(inside_sphere(200));
  const Solution s = room.solve({0.0, 0.0, 0.0}, {0.5, 0.5, 0.5});
  CHECK(s.end == SolveEnd::converged);
  CHECK(s.applies == 0);
  CHECK(room.mean(s.radiosity, 0) == 0.0);
  const std::vector<float> few(3, 0.0f);
  CHECK_THROWS_AS(solve_radiosity(*room.exchange, few, few, few, {}), std::invalid_argument);
}
