#include "host/stages/prepared_scene.h"
#include "host/passes/build_pools.h"
#include "host/run.h"
#include "host/scene/limits.h"
#include "host/stages/require_memory.h"
#include <algorithm>
#include <cmath>

namespace pointgi {

namespace {

/// Device memory as the variant wants it, plain buffers where the device's images are too small.
DevicePools upload(Session& session, OctreePools&& pools, TraversalVariant& variant, Pool<OctreePoint>& points) {
  if (!images_fit(session.info(), pools, variant.storage)) {
    log_warning("the device's images are missing or too small for the octree: plain buffers are used instead");
    variant.storage = PoolStorage::buffer;
  }
  return move_pools(session, std::move(pools), variant.storage, points);
}

/// In the order of the pool, in place of those of the splats.
Pool<std::uint32_t> ids_of(const Pool<std::uint32_t>& source, const std::vector<std::uint32_t>& of_splats) {
  Pool<std::uint32_t> ids(source.size());
  for (std::size_t k = 0; k < source.size(); ++k)
    ids[k] = of_splats[source[k]];
  return ids;
}

/// The scene's wishes first, then what a profile of this device found, then the defaults of its class.
VariantChoice choose_for(const Scene& scene, const DeviceInfo& device) {
  const StoredWinner stored = stored_winner(device);
  if (!stored.warning.empty()) log_warning("{}", stored.warning);
  const VariantChoice choice = choose_variant(scene.traversal, scene.octree, device, stored.file);
  log_info("variant: {} ({})", name_of(choice.variant), choice.source);
  return choice;
}

} // namespace

PreparedScene prepare_scene(Session& session, Scene& scene, bool bare, StageLog& stages) {
  stages.start("cloud");
  PlacedSplats placed = load_and_place(scene, bare);
  stages.finish(placed.splats.size(), "points");
  PreparedScene ready;
  stages.start("octree");
  ready.frame = placed.frame;
  ready.choice = choose_for(scene, session.info());
  OctreePools pools = build_pools(placed.splats, ready.choice.variant, placed.clips, placed.bends);
  ready.choice.variant.clips = !placed.clips.empty();
  ready.choice.variant.patches = !placed.bends.empty();
  const SplatClips clips = clips_of(pools);
  std::vector<Splat>().swap(placed.splats); // assigning {} would keep its memory
  ready.octree = summary_of(pools);
  ready.first_ids = placed.first_ids;
  ready.file_order = std::move(placed.file_order);
  ready.ids = ids_of(source_of(pools), placed.id);
  require_pool_memory(session, {scene, points_of(pools), ready.ids, ready.first_ids, ready.frame.side}, ready.octree,
                      ready.choice.variant);
  ready.on_device = upload(session, std::move(pools), ready.choice.variant, ready.points);
  stages.finish(ready.octree.nodes, "nodes");
  ready.lighting = device_lighting(scene, ready.frame, ready.points, clips);
  return ready;
}

void apply_quality(const std::string& quality, Scene& scene, bool samples_given) {
  if (quality == "normal") return;
  const bool draft = quality == "draft";
  if (!samples_given)
    scene.render.spp = std::max(1, static_cast<int>(std::lround(scene.render.spp * (draft ? 0.25 : 4.0))));
  int& directions = scene.radiosity.directions;
  directions = draft ? (directions + 1) / 2 : std::min(2 * directions, static_cast<int>(limits::directions.high));
  double& epsilon = scene.radiosity.epsilon;
  epsilon = draft ? std::max(epsilon, std::min(4.0 * epsilon, limits::coarsest_draft_epsilon)) : 0.5 * epsilon;
}

void apply_bake_quality(const std::string& quality, Scene& scene) {
  apply_quality(quality, scene);
  if (!scene.radiosity.light_samples)
    scene.radiosity.light_samples = quality == "draft" ? 16 : quality == "high" ? 256 : 64;
}

} // namespace pointgi
