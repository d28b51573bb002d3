/// What is told of a picture's cost against what it costs, in bytes, rays, photons and pixels: never in seconds.
#include "host/api/estimate.h"
#include "host/api/parts.h"
#include "host/cache/vmap_cache.h"
#include "host/error.h"
#include "tests/support/run_program.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;
using Catch::Contains;

namespace {

/// A ball in a corner, or above a mirror.
api::Scene corner(double spacing, bool mirror) {
  const std::string of_spacing = "spacing = " + std::to_string(spacing) + "\n";
  return api::Scene::from_text(
      (mirror ? mirror_scene() : std::string(small_scene())) +
      "[[shape]]\ntype = \"quad\"\ncorner = [-1.5, -1.1, -1.5]\nedge_u = [0.0, 0.0, 3.0]\nedge_v = [3.0, 0.0, 0.0]\n" +
      of_spacing + "material = \"grey\"\n" +
      "[[shape]]\ntype = \"quad\"\ncorner = [-1.5, -1.1, -1.5]\nedge_u = [3.0, 0.0, 0.0]\nedge_v = [0.0, 3.0, 0.0]\n" +
      of_spacing + "material = \"grey\"\n");
}

struct Made {
  double bytes = 0.0, exchange_rays = 0.0, picture_rays = 0.0, photons = 0.0;
  std::string method;
};

Made make(const api::Context& context, const api::Prepared& prepared) {
  const NoVMapsKept anew;
  Session& session = context.parts()->session;
  session.forget_peak();
  const api::Light light(prepared);
  api::FilmJob job(*light.parts(), {});
  const RenderTotals totals = job.render([](const Band&) {});
  Made made;
  made.bytes = static_cast<double>(session.peak_bytes());
  made.exchange_rays = static_cast<double>(light.parts()->light.indirect.rays);
  made.method = light.parts()->light.indirect.method->name;
  made.picture_rays = static_cast<double>(totals.rays);
  if (light.parts()->light.ledger) made.photons = static_cast<double>(light.parts()->light.ledger->aimed);
  return made;
}

void check_factor(double told, double true_value, double factor) {
  CHECK(told < factor * true_value);
  CHECK(told > true_value / factor);
}

} // namespace

TEST_CASE("bytes and rays of a picture are told within a factor of 2, by every method", "[estimate][long]") {
  const api::Context context;
  const char* cases[][2] = {
      {"method=\"fmm\"", ""},
      {"method=\"directions\"", ""},
      {"method=\"direct\"", ""},
      {"method=\"cones\"", ""},
      {"method=\"cones\"", "at=\"pixels\""},
      {"method=\"gather\"", ""},
      {"method=\"gather\"", "sampling=\"mipmap\""},
      {"method=\"auto\"", ""},
  };
  for (const auto& options : cases) {
    api::Scene scene = corner(0.05, false);
    for (const char* option : options)
      if (*option != '\0') scene.set(std::string("radiosity.") + option);
    const api::Prepared prepared(context, scene);
    const api::PictureEstimate told = api::estimate_picture(prepared);
    const Made made = make(context, prepared);
    CAPTURE(options[0], options[1], told.peak_bytes(), made.bytes, told.exchange_rays, made.exchange_rays);
    check_factor(static_cast<double>(told.peak_bytes()), made.bytes, 2.0);
    const api::StageEstimate* method = told.stage(made.method);
    REQUIRE(method != nullptr);
    CHECK(method->runs);
    CHECK(method->seconds > 0.0);
    CHECK(told.stage("vmap")->runs == (made.method == "fmm"));
    if (made.exchange_rays > 0.0) check_factor(told.exchange_rays, made.exchange_rays, 2.0);
    const api::StageEstimate* picture = told.stage("render");
    REQUIRE(picture != nullptr);
    check_factor(picture->items, made.picture_rays, 1.5);
  }
}

TEST_CASE("photons are told, and stages that a scene has no use for with the reason", "[estimate][long]") {
  const api::Context context;
  api::Scene scene = corner(0.1, true);
  scene.set("caustics.photons=100000");
  const api::Prepared prepared(context, scene);
  const std::size_t stages = context.parts()->stages.records().size();
  const api::PictureEstimate told = api::estimate_picture(prepared);
  CHECK(context.parts()->stages.records().size() == stages); // the log is the picture's own
  const Made made = make(context, prepared);
  REQUIRE(told.stage("photon") != nullptr);
  check_factor(told.stage("photon")->items, made.photons, 2.0);
  check_factor(static_cast<double>(told.peak_bytes()), made.bytes, 2.0);
  const api::PictureEstimate plain = api::estimate_picture(api::Prepared(context, corner(0.1, false)));
  CHECK_FALSE(plain.stage("photon")->runs);
  CHECK_FALSE(plain.stage("normals")->runs);
  CHECK_THAT(plain.stage("photon")->why, Contains("no specular material"));
}

TEST_CASE("what is told grows as pixels and samples do", "[estimate][long]") {
  const api::Context context;
  const api::Prepared prepared(context, corner(0.1, false));
  const auto rays = [&](int width, int height, int spp) {
    api::FilmOptions film;
    film.width = width;
    film.height = height;
    film.spp = spp;
    return api::estimate_picture(prepared, film).stage("render")->items;
  };
  const double one = rays(160, 120, 8);
  CHECK(rays(320, 240, 8) == Approx(4.0 * one).epsilon(0.1));
  CHECK(rays(160, 120, 64) == Approx(8.0 * one).epsilon(0.1));
}
