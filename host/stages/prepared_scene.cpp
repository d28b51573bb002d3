#include "host/stages/prepared_scene.h"
#include "host/passes/build_pools.h"
#include "host/run.h"
#include "host/stages/require_memory.h"
#include "octree/parallel.h"
#include <algorithm>

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
  parallel_ranges(source.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      ids[k] = of_splats[source[k]];
  });
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
  ready.kinds = placed.kinds;
  ready.file_order = std::move(placed.file_order);
  ready.ids = ids_of(source_of(pools), placed.id);
  std::vector<std::uint32_t>().swap(placed.id);
  require_pool_memory(session, {scene, points_of(pools), ready.ids, ready.first_ids, ready.frame.side}, ready.octree,
                      ready.choice.variant);
  ready.on_device = upload(session, std::move(pools), ready.choice.variant, ready.points);
  stages.finish(ready.octree.nodes, "nodes");
  ready.lighting = device_lighting(scene, ready.frame, ready.points, clips);
  return ready;
}

} // namespace pointgi
