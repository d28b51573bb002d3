#include "host/passes/device_pools.h"
#include <algorithm>

namespace pointgi {

namespace {

cl::Memory upload_texels(Session& session, const void* texels, std::size_t count, bool is_float, PoolStorage storage) {
  switch (storage) {
  case PoolStorage::image1d_buffer:
    return session.upload_image1d(texels, count, is_float);
  case PoolStorage::image2d:
    return session.upload_image2d(texels, count, is_float, image_width_log2);
  case PoolStorage::buffer:
    break;
  }
  return session.upload(static_cast<const OctreeNode*>(texels), count).handle; // any 16-byte texel
}

/// A point of patches as the device has it (shared/octree_types.h).
struct BentPoint {
  OctreePoint point;
  PatchBend bend;
};
static_assert(sizeof(BentPoint) == 64, "four texels");

/// `done(pool)` is called with each pool that is on the device.
template <class Pools, class Done>
DevicePools upload_step(Session& session, Pools& pools, PoolStorage storage, const Done& done) {
  static_assert(sizeof(OctreeNode) == 16, "pools are counted in 16-byte texels");
  DevicePools device;
  device.nodes = upload_texels(session, pools.nodes.data(), pools.nodes.size(), false, storage);
  done(pools.nodes);
  if (storage == PoolStorage::buffer) {
    device.leaves = session.upload(pools.begin_end).handle;
  } else { // four entries a texel (kernels/lib/pools.cl)
    Pool<std::uint32_t> padded = pools.begin_end;
    padded.resize((padded.size() + 3) / 4 * 4, 0u);
    device.leaves = upload_texels(session, padded.data(), padded.size() / 4, false, storage);
  }
  done(pools.begin_end);
  device.points = upload_points(session, pools.points, pools.bends, storage);
  return device;
}

template <class Pools, class Done>
DevicePools upload_wide(Session& session, Pools& pools, const Done& done) {
  DevicePools device;
  device.nodes = session.upload(pools.nodes).handle;
  done(pools.nodes);
  device.leaves = session.upload(pools.blocks).handle;
  done(pools.blocks);
  device.points = upload_points(session, pools.points, pools.bends, PoolStorage::buffer);
  return device;
}

constexpr auto keep = [](const auto&) {};
constexpr auto release = [](auto& pool) { std::decay_t<decltype(pool)>().swap(pool); };

} // namespace

cl::Memory upload_points(Session& session, View<OctreePoint> points, View<PatchBend> bends, PoolStorage storage) {
  if (bends.size == 0) return upload_texels(session, points.data, points.size * POINT_TEXELS, true, storage);
  Pool<BentPoint> bent(points.size);
  for (std::size_t k = 0; k < bent.size(); ++k)
    bent[k] = {points[k], bends[k]};
  return upload_texels(session, bent.data(), bent.size() * sizeof(BentPoint) / 16, true, storage);
}

DevicePools upload_pools(Session& session, const StepPools& pools, PoolStorage storage) {
  return upload_step(session, pools, storage, keep);
}

DevicePools upload_pools(Session& session, const WidePools& pools) {
  return upload_wide(session, pools, keep);
}

DevicePools move_pools(Session& session, OctreePools&& pools, PoolStorage storage, Pool<OctreePoint>& points) {
  OctreePools moved = std::move(pools);
  auto* wide = std::get_if<WidePools>(&moved);
  const DevicePools device = wide != nullptr ? upload_wide(session, *wide, release)
                                             : upload_step(session, std::get<StepPools>(moved), storage, release);
  points = std::visit([](auto& p) { return std::move(p.points); }, moved);
  return device;
}

DevicePools upload_pools(Session& session, const OctreePools& pools, PoolStorage storage) {
  if (const auto* wide = std::get_if<WidePools>(&pools)) return upload_pools(session, *wide);
  return upload_pools(session, std::get<StepPools>(pools), storage);
}

bool images_fit(const DeviceInfo& device, const OctreePools& pools, PoolStorage storage) {
  const auto* step = std::get_if<StepPools>(&pools);
  if (step == nullptr || storage == PoolStorage::buffer) return true;
  const std::size_t texels = std::max(
      {step->nodes.size(), step->points.size() * POINT_TEXELS + step->bends.size(), step->begin_end.size() / 4 + 1});
  if (!device.images || 16 * texels > device.max_allocation_bytes) return false;
  if (storage == PoolStorage::image1d_buffer) return texels <= device.image_buffer_texels;
  const std::size_t width = std::size_t{1} << image_width_log2;
  return width <= device.image2d_width && (texels + width - 1) / width <= device.image2d_height;
}

} // namespace pointgi
