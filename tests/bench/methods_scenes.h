#pragma once
/// What bench_methods solves: rooms, shrubs, scene files and bare clouds, on the device.
#include "host/api/parts.h"
#include "host/cloud/readers/readers.h"
#include "host/radiosity/point_irradiance.h"
#include "host/stages/indirect_stages.h"
#include "host/stages/prepared_scene.h"
#include "tests/support/lit_room.h"
#include "tests/support/shrub.h"
#include "tests/support/temporary_folder.h"
#include <fmt/format.h>

namespace pointgi::bench {

/// Points on the device, and the light that enters.
struct BenchScene {
  std::string name;
  DevicePools pools;
  TraversalVariant variant;
  std::vector<Splat> points;
  std::vector<std::uint8_t> exchanges;
  std::vector<float> direct, emitted; ///< [points x 3]; emitted may be empty
  double side = 1.0;

  ExchangeScene exchange() const { return {pools, variant, points, exchanges, side, 1}; }
};

/// With beams of directions where the device has them, as its default variant.
inline BenchScene room(Session& session, std::size_t count) {
  test::LitRoom lit(session, count);
  TraversalVariant variant = lit.variant;
  variant.grouping = RayGrouping::packet;
  if (!why_not(variant, session.info()).empty()) variant = lit.variant;
  return {fmt::format("room, {} points", lit.points.size()), lit.pools, variant, lit.points, {}, lit.direct, {}, 1.0};
}

/// A scene file or a bare cloud; `within`: what shines takes part in the exchange.
inline BenchScene from_file(Session& session, const std::string& name, const std::string& file,
                            const std::vector<std::string>& overrides = {}, bool within = false) {
  Scene scene = api::Scene::from_file(file, overrides).parts()->description();
  StageLog stages;
  PreparedScene ready = prepare_scene(session, scene, file.find(".toml") == std::string::npos, stages);
  BenchScene bench{name, ready.on_device, ready.choice.variant, {}, {}, {}, {}, ready.frame.side};
  bench.points.assign(ready.points.begin(), ready.points.end());
  bench.exchanges = exchanging_materials(scene);
  bench.direct =
      session.download(direct_irradiance_of_points(session, bench.pools, bench.variant, ready.lighting, bench.side,
                                                   bench.points.size(), 64, !within, [] { return false; }),
                       3 * bench.points.size());
  if (within) bench.emitted = emitted_radiosity(ready.lighting, bench.points);
  bench.name += fmt::format(", {} points", bench.points.size());
  return bench;
}

/// A closed box with a square lamp of side s on its ceiling, whose light is exchanged with that of the walls.
inline BenchScene lamp_room(Session& session, double side) {
  const test::TemporaryFolder folder;
  const std::string text = fmt::format(
      "version = 1\n[camera]\nposition = [0, 0, 0.9]\nlook_at = [0, 0, 0]\n[radiosity]\ndirect_light = \"radiosity\"\n"
      "[[material]]\nname = \"white\"\ntype = \"diffuse\"\nalbedo = [0.7, 0.7, 0.7]\n"
      "[[material]]\nname = \"lamp\"\ntype = \"diffuse\"\nalbedo = [0, 0, 0]\nemission = [10, 10, 10]\n"
      "[[shape]]\ntype = \"box\"\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\ninward = true\nspacing = 0.04\nmaterial = "
      "\"white\"\n"
      "[[shape]]\ntype = \"quad\"\ncorner = [{0}, 0.99, {0}]\nedge_u = [{1}, 0, 0]\nedge_v = [0, 0, {1}]\nspacing = "
      "{2}\n"
      "material = \"lamp\"\n",
      -side / 2, side, std::min(0.04, side / 4));
  return from_file(session, fmt::format("box with a lamp of {}", side), folder.write("lamp.toml", text), {}, true);
}

/// A cloud whose y points up, on the floor of a closed box with a lamp, as large as the box allows.
inline BenchScene boxed(Session& session, const std::string& file) {
  CloudReport report;
  const PointCloud cloud = read_cloud(file, {}, report);
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& p : cloud.position)
    bounds.extend(p);
  const double scale = 1.5 / bounds.sizes().maxCoeff();
  const Eigen::Vector3d middle = scale * bounds.center();
  const test::TemporaryFolder folder;
  const std::string text = fmt::format(
      "version = 1\n[camera]\nposition = [0, 0, 0.9]\nlook_at = [0, 0, 0]\n"
      "[[material]]\nname = \"white\"\ntype = \"diffuse\"\nalbedo = [0.7, 0.7, 0.7]\n"
      "[[cloud]]\nfile = \"{}\"\nmaterial = \"white\"\nscale = {}\ntranslate = [{}, {}, {}]\n"
      "[[shape]]\ntype = \"box\"\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\ninward = true\nspacing = 0.04\nmaterial = "
      "\"white\"\n"
      "[[light]]\ntype = \"point\"\nposition = [0.5, 0.9, 0.5]\npower_w = [40, 40, 40]\n",
      std::filesystem::absolute(file).string(), scale, -middle.x(), -1.0 - scale * bounds.min().y(), -middle.z());
  return from_file(session, std::filesystem::path(file).stem().string() + " in a box",
                   folder.write("boxed.toml", text));
}

/// A bare cloud of leaves: two-sided, on its ground.
inline BenchScene shrub(Session& session, std::size_t count) {
  const test::TemporaryFolder folder;
  return from_file(session, fmt::format("shrub of {}", count), folder.write("shrub.xyz", test::shrub_text(count)));
}

} // namespace pointgi::bench
