#include "host/passes/build_pools.h"
#include "host/radiosity/radiosity_map.h"
#include "host/scene/lighting.h"
#include "host/scene/sheet_sides.h"
#include "host/stages/lit_cloud.h"
#include "host/tune/variant_list.h"
#include "tests/support/clouds.h"
#include <catch2/catch.hpp>
#include <numeric>

using namespace pointgi;
using namespace pointgi::test;

namespace {

/// A wall, a leaf and a lamp: materials 0, 1 and 2, of which the latter two are two-sided.
Scene scene_of_three() {
  Scene scene;
  scene.camera.position = Vector3d(0, 0, 5);
  scene.camera.look_at = Vector3d(0, 0, 0);
  scene.materials.resize(3);
  for (MaterialSettings& m : scene.materials)
    m.flags = MATERIAL_REFLECTS_DIFFUSELY;
  for (const std::size_t m : {1u, 2u})
    scene.materials[m].flags |= MATERIAL_TWO_SIDED;
  scene.materials[2].emission = Vector3d(3, 2, 1);
  return scene;
}

struct Divided {
  Scene scene = scene_of_three();
  std::vector<Splat> splats;
  std::vector<std::uint32_t> id;
  std::size_t sheets = 0;

  explicit Divided(std::vector<Splat> of) : splats(std::move(of)) {
    for (std::size_t i = 0; i < splats.size(); ++i)
      splats[i].material = static_cast<float>(i % 3);
    id.resize(splats.size());
    std::iota(id.begin(), id.end(), 0u);
    sheets = divide_sheets(scene, splats, id);
  }
};

bool is_pair(const Splat& front, const Splat& back) {
  for (int a = 0; a < 3; ++a)
    if (front.position[a] != back.position[a] || front.normal[a] != -back.normal[a] ||
        front.colour[a] != back.colour[a])
      return false;
  return front.radius == back.radius && front.area == back.area && material_of(front) == material_of(back) &&
         is_sheet(front) && !is_back_of_sheet(front) && is_back_of_sheet(back);
}

} // namespace

TEST_CASE("splats of a two-sided material become a front and a back, each as large as the splat") {
  const auto before = random_splats(7, 5);
  const Divided divided(before);
  CHECK(divided.sheets == 4);
  CHECK(divided.id == std::vector<std::uint32_t>{0, 1, 1, 2, 2, 3, 4, 4, 5, 5, 6});
  for (std::size_t k = 0; k < divided.splats.size(); ++k) {
    const Splat &s = divided.splats[k], &of = before[divided.id[k]];
    CHECK(material_of(s) == divided.id[k] % 3);
    CHECK(is_sheet(s) == (divided.id[k] % 3 != 0));
    CHECK(s.area == of.area);
    if (!is_back_of_sheet(s)) {
      CHECK(std::equal(s.normal, s.normal + 3, of.normal));
      continue;
    }
    CHECK(is_pair(divided.splats[k - 1], s));
  }
}

TEST_CASE("nothing is two-sided: the splats stay as they are") {
  Scene scene = scene_of_three();
  auto splats = random_splats(5, 6);
  std::vector<std::uint32_t> id(5, 9u);
  CHECK(divide_sheets(scene, splats, id) == 0);
  CHECK(splats.size() == 5);
  CHECK_FALSE(is_sheet(splats[0]));
}

TEST_CASE("a sheet's sides follow each other in the pool of every tree, also where many lie in one place") {
  auto splats = mixed_splats();
  for (std::size_t i = 0; i < 200; ++i) { // in threes, of three materials
    std::copy_n(splats[i - i % 3].position, 3, splats[i].position);
    std::copy_n(splats[i + 500].normal, 3, splats[i].normal);
  }
  const Divided divided(splats);
  for (const TraversalVariant& variant : tracing_variants()) {
    CAPTURE(name_of(variant));
    const OctreePools pools = build_pools(divided.splats, variant);
    std::visit([](const auto& p) { verify(p); }, pools);
    const View<Splat> points = points_of(pools);
    std::size_t pairs = 0;
    for (std::size_t k = 0; k < points.size; ++k)
      if (is_sheet(points[k]) && !is_back_of_sheet(points[k])) {
        REQUIRE(k + 1 < points.size);
        REQUIRE(is_pair(points[k], points[k + 1]));
        ++pairs;
      }
    CHECK(pairs == divided.sheets);
  }
}

TEST_CASE("both sides of a lamp are emitters, and both sides of a leaf exchange light") {
  const Divided divided(random_splats(30, 8));
  const DeviceLighting lighting = device_lighting(divided.scene, {}, divided.splats);
  double area = 0.0; // of one side of all lamps
  for (const Splat& s : divided.splats)
    if (material_of(s) == 2 && !is_back_of_sheet(s)) area += s.area;
  REQUIRE(lighting.emitters.size() == 20);
  double of_backs = 0.0, before = 0.0;
  for (const Emitter& e : lighting.emitters) {
    if (is_back_of_sheet(divided.splats[e.point])) of_backs += e.cumulative - before;
    before = e.cumulative;
  }
  CHECK(of_backs == Approx(0.5).epsilon(1e-5)); // shares are multiples of 2^-24
  // Density of light sampling per area: one lamp of twice the area.
  CHECK(lighting.materials[2].emitter_density == Approx(1.0 / (2.0 * area)).epsilon(1e-5));
  const std::vector<std::uint8_t> exchanges{0, 1, 0}; // the leaves
  const DevicePools none{};
  const TraversalVariant variant;
  const ExchangeScene exchange{none, variant, divided.splats, exchanges};
  const auto places = exchanging_points(exchange);
  REQUIRE(places.size() == 20);
  for (std::size_t k = 0; k < places.size(); k += 2)
    CHECK(is_pair(divided.splats[places[k]], divided.splats[places[k + 1]]));
}

TEST_CASE("a lit cloud has a point for each side, with light of its own") {
  std::vector<Splat> one = random_splats(2, 9);
  const Divided divided({one[0], one[1]}); // a wall and a leaf
  REQUIRE(divided.splats.size() == 3);
  const TraversalVariant variant;
  const Frame frame;
  const DeviceLighting lighting = device_lighting(divided.scene, frame, divided.splats);
  IndirectLight light;
  light.direct = {1, 1, 1, 4, 4, 4, 0, 0, 0};
  light.from_surfaces = {0, 0, 0, 2, 2, 2, 8, 8, 8};
  const LitCloud lit = lit_cloud({variant, divided.scene, frame, lighting, divided.splats}, light, 0.0);
  REQUIRE(lit.cloud.size() == 3);
  CHECK(lit.cloud.normal[1] == -lit.cloud.normal[2]);
  CHECK(lit.cloud.position[1] == lit.cloud.position[2]);
  const auto scale = static_cast<float>(lighting.radiance.scale);
  CHECK(lit.columns[1].values == std::vector<float>{0.5f * scale, 3.0f * scale, 4.0f * scale});
}

TEST_CASE("two splats in one place that face opposite ways are the sides of a sheet, each with its colour") {
  Scene scene;
  scene.materials.resize(1);
  scene.materials[0].flags = MATERIAL_REFLECTS_DIFFUSELY;
  std::vector<Splat> splats{make_splat(0.5f, 0.5f, 0.5f, 0, 0, 1, 0.1f), make_splat(0.2f, 0.5f, 0.5f, 0, 0, 1, 0.1f),
                            make_splat(0.5f, 0.5f, 0.5f, 0, 0, -1, 0.2f)};
  splats[2].colour[0] = 0.9f;
  std::vector<std::uint32_t> id{7, 8, 9};
  std::vector<CoincidentSides> sides;
  CHECK(merge_coincident(splats, id, &sides).empty());
  REQUIRE(sides.size() == 1);
  CHECK(divide_sheets(scene, splats, id, {}, sides) == 1);
  REQUIRE(splats.size() == 3);
  CHECK(id == std::vector<std::uint32_t>{7, 9, 8});
  CHECK(splats[0].material == SHEET_FRONT);
  CHECK(splats[1].material == SHEET_BACK);
  CHECK(splats[1].colour[0] == 0.9f);
  CHECK(splats[0].radius == splats[1].radius);
  CHECK(splats[1].normal[2] == -1.0f);
}

TEST_CASE("points without a side are sheets, unless their material forbids it") {
  Scene scene;
  scene.materials.resize(1);
  scene.materials[0].flags = MATERIAL_REFLECTS_DIFFUSELY;
  for (const bool forbidden : {false, true}) {
    scene.materials[0].one_sided = forbidden;
    std::vector<Splat> splats{make_splat(0.5f, 0.5f, 0.5f, 0, 0, 1, 0.1f), make_splat(0.2f, 0.5f, 0.5f, 0, 0, 1, 0.1f)};
    std::vector<std::uint32_t> id{1, 0};
    CHECK(divide_sheets(scene, splats, id, {Structure::surface, Structure::volume}) == (forbidden ? 0 : 1));
  }
}
