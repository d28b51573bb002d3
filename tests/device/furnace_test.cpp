/// Furnaces: a closed room of albedo rho in which all emits E settles at B = E / (1 - rho) (truths.md section 1).
#include "host/radiosity/fmm.h"
#include "tests/support/device.h"
#include "tests/support/room.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;

namespace {

/// Order 4: order 3 takes 5e-4 too little in a sphere, which albedo 0.99 makes 5 %.
Room room_of(const std::vector<Splat>& splats) {
  return {splats, [](const ClusterTree& tree, View<Link> links) {
            FmmOptions options;
            options.grid.order = 4;
            return std::make_unique<DeviceFmm>(session(), tree, links, options);
          }};
}

void check_furnace(Room& room) {
  const double albedo[] = {0.5, 0.9, 0.99}, allowed[] = {0.01, 0.01, 0.03}, emission[] = {1.0, 2.0, 0.25};
  SolveOptions options;
  options.tolerance = 1e-4; // of E; what a float H says of B = 100 E is worth 1e-5
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

TEST_CASE("furnace: sphere", "[long]") {
  Room room = room_of(inside_sphere(20000));
  check_furnace(room);
  // Closed, nothing absorbs: said so at once, not iterated for ever.
  const Solution s = room.solve({1.0, 1.0, 1.0}, {0.5, 1.0, 0.5});
  CHECK(s.end == SolveEnd::keeps_its_light);
  CHECK(s.rate > 0.9995);
  CHECK(s.applies < 20);
  CHECK(s.history.size() == s.sweeps);
  CHECK_THAT(complaint_of(s), Catch::Contains("lower the albedo"));
}

TEST_CASE("furnace: cube", "[long]") {
  Room room = room_of(inside_cube(58));
  check_furnace(room);
}
