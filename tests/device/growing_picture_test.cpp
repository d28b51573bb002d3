/// Pictures that get better: what they end as, and what is there when they are stopped.
#include "host/api/parts.h"
#include "host/app/grow_picture.h"
#include "host/measure/reference.h"
#include "tests/support/device.h"
#include "tests/support/render.h"
#include <catch2/catch.hpp>
#include <cstring>

using namespace pointgi;

namespace {

/// Wider than a launch's first tile, and no multiple of a band high.
const std::string room = R"(
version = 1
[render]
size = [50, 41]
spp = 70
[camera]
position = [0.0, 0.6, 3.0]
look_at = [0.0, 0.5, 0.0]
[environment]
radiance = [0.3, 0.4, 0.5]
[[light]]
type = "directional"
direction = [-0.4, -1.0, -0.3]
irradiance = [2.0, 2.0, 1.8]
[[material]]
name = "grey"
type = "diffuse"
albedo = [0.6, 0.6, 0.6]
[[material]]
name = "mirror"
type = "mirror"
reflectance = [0.9, 0.9, 0.9]
[[shape]]
type = "quad"
corner = [-2.0, 0.0, -2.0]
edge_u = [0.0, 0.0, 4.0]
edge_v = [4.0, 0.0, 0.0]
spacing = 0.2
material = "grey"
[[shape]]
type = "sphere"
centre = [0.0, 0.5, 0.0]
radius = 0.5
spacing = 0.1
material = "mirror"
)";

void check_same(const Picture& a, const Picture& b) {
  REQUIRE(a.channels.size() == b.channels.size());
  for (const auto& [name, values] : a.channels) {
    INFO(name);
    CHECK(std::memcmp(values.data(), b.channels.at(name).data(), values.size() * sizeof(float)) == 0);
  }
  CHECK(a.uints == b.uints);
  CHECK(a.attributes.text == b.attributes.text);
  CHECK(a.attributes.number.at("samplesPerPixel") == b.attributes.number.at("samplesPerPixel"));
}

} // namespace

TEST_CASE("a picture that grew is bit for bit the one that was made at once", "[long]") {
  const Picture at_once = test::render_text(room);
  const Picture grown = test::render_text(room, [](RenderOptions& options) { options.progressive = true; });
  check_same(grown, at_once);
  const auto by_paths = [](bool progressive) {
    return [=](RenderOptions& options) {
      options.integrator = "path";
      options.progressive = progressive;
    };
  };
  check_same(test::render_text(room, by_paths(true)), test::render_text(room, by_paths(false)));
}

TEST_CASE("a picture that an error ends has no more noise than that, and its samples make it again", "[long]") {
  constexpr double error = 4e-4;
  const auto ended = [&](RenderOptions& options) { options.error = error; };
  const Picture picture = test::render_text(room, ended);
  CHECK(Reference(picture).noise(picture) <= error);
  const auto samples = static_cast<int>(picture.attributes.number.at("samplesPerPixel"));
  CHECK(samples > 32);
  CHECK(samples < 4096);
}

TEST_CASE("a time that is short still gives a whole picture", "[long]") {
  const Picture picture = test::render_text(room, [](RenderOptions& options) { options.seconds = 1e-3; });
  // Of two samples a pixel, without light between surfaces at worst; no row is missing, mirrors are there.
  CHECK(test::mean(picture, "R") == Approx(test::mean(test::render_text(room), "R")).epsilon(0.1));
  CHECK(picture.attributes.number.at("samplesPerPixel") == 2);
}

TEST_CASE("a film that is stopped keeps all rows, some of them with more samples") {
  const test::TemporaryFolder folder;
  const std::string file = folder.file("room.toml");
  std::ofstream(file) << room;
  const api::Context context("cpu");
  const api::Prepared prepared(context, api::Scene::from_file(file));
  const api::Light light(prepared);
  api::FilmJob job(*light.parts(), {});
  GrowingFilm film = job.growing();
  const auto nothing = [](double) {};
  film.grow(32, nothing, [] { return false; });
  int asked = 0;
  film.grow(64, nothing, [&] { return ++asked > 1; });
  CHECK(film.samples() == 32);
  double least = 1e300;
  int rows = 0;
  const RenderTotals totals = film.resolve([&](const Band& band) {
    rows += band.rows;
    for (const float value : band.values[0])
      least = std::min<double>(least, value);
  });
  CHECK(totals.interrupted);
  CHECK(totals.rows_done == 41);
  CHECK(rows == 41);
  CHECK(least > 0.0);
  film.grow(64, nothing, [] { return false; }); // goes on where it was
  CHECK(film.samples() == 64);
}
