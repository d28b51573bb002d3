/// The library on a device: light that is solved once, views that differ, runs that end.
#include "host/api/parts.h"
#include "host/error.h"
#include "tests/support/device.h"
#include "tests/support/run_program.h"
#include <catch2/catch.hpp>
#include <cmath>

using namespace pointgi;
using namespace pointgi::test;
using Catch::Contains;

namespace {

/// A ball in a corner: light goes from surface to surface.
api::Scene corner() {
  return api::Scene::from_text(
      std::string(small_scene()) +
      "[[shape]]\ntype = \"quad\"\ncorner = [-1.5, -0.9, -1.5]\nedge_u = [0.0, 0.0, 3.0]\nedge_v = [3.0, 0.0, 0.0]\n"
      "spacing = 0.1\nmaterial = \"grey\"\n[radiosity]\nmethod = \"fmm\"\n");
}

std::size_t ran(const api::Context& context, const std::string& stage) {
  std::size_t times = 0;
  for (const StageRecord& record : context.parts()->stages.records())
    times += record.name == stage && record.ran ? 1 : 0;
  return times;
}

api::FilmOptions seen_from(double x) {
  api::FilmOptions options;
  options.camera = api::Camera{{x, 0.6, 3.0}, {0.0, 0.0, 0.0}};
  return options;
}

} // namespace

TEST_CASE("two views of one light solve it once, and each is what its own light would show", "[api]") {
  const api::Context context;
  const api::Prepared prepared(context, corner());
  const api::Light light(prepared);
  const auto solved = context.parts()->session.kernel_times();
  const api::Film front(light), side(light, seen_from(2.0));
  CHECK(ran(context, "vmap") == 1);
  CHECK(ran(context, "fmm") == 1);
  CHECK(ran(context, "render") == 2);
  for (const char* kernel : {"segments_blocked", "direct_irradiance_of_points"}) {
    CAPTURE(kernel);
    const auto before = solved.find(kernel), after = context.parts()->session.kernel_times().find(kernel);
    if (before != solved.end()) CHECK(after->second.launches == before->second.launches);
  }
  CHECK(front.channel("G") != side.channel("G"));
  // The camera of the options is the scene's camera of another scene.
  api::Scene turned = corner();
  turned.set("camera", {{"position", {2.0, 0.6, 3.0}}, {"look_at", {0, 0, 0}}, {"fov_deg", 40}});
  const api::Light own(api::Prepared(context, turned));
  const api::Film alone(own);
  for (const std::string& channel : side.channels())
    CHECK(side.channel(channel) == alone.channel(channel));
  CHECK(side.point_ids() == alone.point_ids());
}

TEST_CASE("two lights of one context, each by its own method, are each what a context of its own gives", "[api]") {
  const auto by = [](const char* method) {
    api::Scene scene = corner();
    scene.set("radiosity", {{"method", method}, {"tolerance", 1e-4}});
    return scene;
  };
  const auto alone = [&](const char* method) {
    return api::Light(api::Prepared(api::Context(), by(method))).radiosity();
  };
  const auto difference = [](const std::vector<float>& a, const std::vector<float>& b) {
    double square = 0.0, norm = 0.0;
    for (std::size_t i = 0; i < b.size(); ++i) {
      square += std::pow(double{a[i]} - double{b[i]}, 2);
      norm += std::pow(double{b[i]}, 2);
    }
    return std::sqrt(square / norm);
  };
  const api::Context context;
  const api::Prepared of_gather(context, by("gather")), of_directions(context, by("directions"));
  const api::Light gather(of_gather), directions(of_directions); // both are there before either is read
  CHECK(ran(context, "gather") == 1);
  CHECK(ran(context, "directions") == 1);
  const std::vector<float> by_gather = gather.radiosity(), by_directions = directions.radiosity();
  CHECK(by_gather == alone("gather"));
  CHECK(by_directions == alone("directions"));
  CHECK(api::Film(gather).channel("G") != api::Film(directions).channel("G"));
  CHECK(gather.radiosity() == by_gather);
  // What both are near: a ray for every pair. A pass is a bounce: gather leaves a residual of the tolerance. Directions
  // near an edge see what pairs of points do not (tests/analytic/methods_test.cpp).
  const std::vector<float> truth = alone("direct");
  CHECK(difference(by_gather, truth) < 2e-4);
  CHECK(difference(by_directions, truth) < 0.05);
}

TEST_CASE("a film has the size, the window and the channels that it is asked for", "[api]") {
  const api::Light light(api::Prepared(api::Context(), corner()));
  api::FilmOptions options;
  options.width = 32;
  options.height = 24;
  const api::Film all(light, options);
  options.window = {4, 20, 8, 24};
  const api::Film part(light, options);
  REQUIRE(all.width() == 32);
  REQUIRE(part.width() == 16);
  REQUIRE(part.height() == 16);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x)
      CHECK(part.channel("R")[16 * y + x] == all.channel("R")[32 * (y + 8) + x + 4]);
  CHECK_THROWS_WITH(all.channel("Caustic.R"), Contains("no channel \"Caustic.R\"") && Contains("Diffuse.R"));
  options.window = {4, 40, 8, 24};
  CHECK_THROWS_WITH(api::Film(light, options), Contains("film.window") && Contains("x1 <= 32"));
  options = seen_from(0.0);
  options.camera->look_at = options.camera->position;
  CHECK_THROWS_WITH(api::Film(light, options), Contains("film") && Contains("camera.look_at"));
  options = {};
  options.paths = "LDE";
  CHECK_THROWS_WITH(api::Film(light, options), Contains("only path-traced light"));

  const TemporaryFolder folder;
  part.write_exr(folder.file("part.exr"));
  part.write_png(folder.file("part.png"));
  const Picture file = read_exr(folder.file("part.exr"));
  CHECK(file.full_width == 32);
  CHECK(file.channels.at("R") == part.channel("R"));
  CHECK(file.uints.at("PointId") == part.point_ids());
  CHECK_THROWS_WITH(part.write_exr(folder.file("none/x.exr")), Contains("none"));
}

TEST_CASE("radiosity stands in the order of the points, and is what a closed form says", "[api]") {
  // A floor under a far lamp: B = albedo power / (4 pi h²), within what the lamp's height takes off the points' own.
  api::Scene scene;
  scene.add("material", {{"name", "grey"}, {"type", "diffuse"}, {"albedo", {0.5, 0.25, 0.125}}});
  scene.add("shape", {{"type", "quad"},
                      {"corner", {-0.5, 0, -0.5}},
                      {"edge_u", {0, 0, 1}},
                      {"edge_v", {1, 0, 0}},
                      {"spacing", 0.1},
                      {"material", "grey"}});
  scene.add("light", {{"type", "point"}, {"position", {0, 100, 0}}, {"power_w", {1e5, 1e5, 1e5}}});
  const api::Prepared prepared(api::Context(), scene);
  const api::Light light(prepared);
  const std::vector<float> radiosity = light.radiosity();
  const std::vector<double> positions = prepared.positions();
  REQUIRE(radiosity.size() == 3 * prepared.size());
  REQUIRE(positions.size() == 3 * prepared.size());
  const double irradiance = 1e5 / (4.0 * 3.14159265358979 * 1e4);
  for (std::size_t p = 0; p < prepared.size(); ++p) {
    CHECK(std::abs(positions[3 * p]) < 0.5);
    CHECK(std::abs(positions[3 * p + 1]) < 1e-6);
    for (std::size_t c = 0; c < 3; ++c) // the farthest point is 0.7 off: cos^3 of that is 1 - 7e-5
      CHECK(radiosity[3 * p + c] == Approx(irradiance * (c == 0 ? 0.5 : c == 1 ? 0.25 : 0.125)).epsilon(1e-4));
  }
  const api::Light traced(prepared, {true, true});
  CHECK_THROWS_WITH(traced.radiosity(), Contains("path tracing"));
}

TEST_CASE("a run of the library ends where it is asked to, and can be begun anew", "[api]") {
  const api::Context context;
  std::string stage;
  bool stop = false;
  const RunControl run{
      [&] { return stop; }, [&](const StageProgress& p) { stop = stop || (!stage.empty() && p.stage == stage); }, {}};
  const auto ends_in = [&](const std::string& name, const auto& work) {
    stage = name;
    stop = false;
    CHECK_THROWS_WITH(work(), Contains("interrupted in the stage " + name));
    stage.clear();
    stop = false;
  };
  ends_in("octree", [&] { api::Prepared(context, corner(), run); });
  const api::Prepared prepared(context, corner(), run);
  ends_in("fmm", [&] { api::Light(prepared, {}, run); });
  const api::Light light(prepared, {}, run);
  ends_in("render", [&] { api::Film(light, {}, run); });
  CHECK(api::Film(light, {}, run).channel("R") == api::Film(api::Light(api::Prepared(context, corner()))).channel("R"));
}
