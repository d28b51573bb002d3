#include "host/stages/device_need.h"
#include "fmm/operators/grids.h"
#include "host/lights/environment_map.h"
#include "host/radiosity/direct.h"
#include "host/radiosity/direction_set.h"
#include "host/radiosity/directions.h"
#include "host/radiosity/gather.h"
#include "host/radiosity/voxel_pyramid.h"
#include "host/render/render.h"
#include "shared/photon_types.h"
#include "shared/sky_types.h"
#include <algorithm>

namespace pointgi {

namespace {

constexpr std::uint64_t texel = sizeof(cl_float4);

/// Points as planes of floats: seven of each, three of what it receives, three of what it sends.
std::uint64_t plane_bytes(std::uint64_t points) {
  return 13 * sizeof(cl_float) * points;
}

/// Hits of all points, or those that fit (bytes_for_hits); places and irradiance of the points, what an apply sends.
DeviceNeed directions_need(const RadiositySettings& settings, const ExchangedCount& count, std::uint64_t left) {
  const DirectionPattern pattern =
      settings.direction_set == "hemicube" ? DirectionPattern::hemicube : DirectionPattern::stratified;
  const std::uint64_t a_point =
      sizeof(cl_uint) * direction_set(pattern, static_cast<unsigned>(settings.directions)).weights.size();
  const std::uint64_t always = (sizeof(cl_uint) + texel) * count.points + texel * count.pool + 5 * a_point;
  constexpr std::uint64_t block = 16; // of points, the least that are traced at a time
  return {always + block * a_point,
          always + std::min(a_point * (count.points + block), bytes_for_hits(left, count.pool))};
}

DeviceNeed pairs_need(const ExchangedCount& count, bool keeps) {
  const std::uint64_t always = plane_bytes(count.points) + sizeof(Splat) * count.points;
  constexpr std::uint64_t scratch = 64u << 20; // of what is traced and forgotten, about
  const std::uint64_t bits = direct_bytes(count.points);
  return {always + (keeps ? bits : 0), always + (keeps ? bits : std::min(bits, scratch))};
}

DeviceNeed gather_need(const RadiositySettings& settings, const ExchangedCount& count) {
  const bool keeps = settings.visibility_cache.value_or(true);
  DeviceNeed need;
  if (settings.sampling == "all")
    need = pairs_need(count, keeps);
  else {
    const std::size_t senders = count.points / static_cast<std::size_t>(settings.window) + 1;
    const bool can_keep = keeps && settings.sampling != "monte_carlo" && settings.sampling != "adaptive";
    const std::uint64_t always = plane_bytes(count.points + senders) + sizeof(Splat) * (count.points + senders);
    const std::uint64_t bits = gather_cache_bytes(GatherSampling::mipmap, count.points, senders);
    constexpr std::uint64_t scratch = 64u << 20;
    need = {always + (can_keep ? bits : 0), always + (can_keep ? bits : std::min(bits, scratch))};
  }
  const auto side = static_cast<std::uint64_t>(settings.voxels);
  const std::uint64_t grid = settings.visibility == "voxels" ? side * side * side / 8 : 0;
  return {need.least + grid, need.usual + grid};
}

DeviceNeed cones_need(const RadiositySettings& settings, const ExchangedCount& count) {
  std::uint64_t voxels = 0;
  for (auto side = static_cast<std::uint64_t>(settings.voxels); side > 0; side /= 2)
    voxels += (side + 2) * (side + 2) * (side + 2);
  constexpr std::uint64_t shares_a_splat = 3;
  const std::uint64_t texels = texels_of(settings.anisotropic);
  const std::uint64_t bytes =
      voxels * (texels * texel + 1) + count.pool * (sizeof(Splat) + texel) + count.points * 4 * sizeof(cl_uint);
  return {bytes, bytes + count.pool * shares_a_splat * (sizeof(cl_uint) + sizeof(cl_float))};
}

} // namespace

DeviceNeed exchange_need(const std::string& method, const RadiositySettings& settings, const ExchangedCount& count,
                         std::uint64_t left) {
  if (count.points == 0) return {};
  if (method == "directions") return directions_need(settings, count, left);
  if (method == "direct") return pairs_need(count, true);
  if (method == "gather") return gather_need(settings, count);
  if (method == "cones") return cones_need(settings, count);
  return {};
}

std::uint64_t fmm_bytes(const ClusterTree& tree, unsigned order, const LinkEstimate& links) {
  if (tree.points.empty()) return 0;
  GridOptions options;
  options.order = order;
  // A node: its place, moments, local expansion, and its jobs, which are of blocks of eight.
  constexpr std::uint64_t a_node = (3 + 2 * FMM_VALUES) * sizeof(cl_float) + 3 * sizeof(cl_uint4) / FMM_LANES;
  // A cluster: itself, its grid, where four lists begin, and, while it is applied, its flux to about three sides.
  constexpr std::uint64_t a_cluster = sizeof(FmmCluster) + sizeof(FmmGrid) + 4 * sizeof(cl_uint) + 3 * sizeof(FmmFlux);
  constexpr std::uint64_t an_entry = 2 * sizeof(cl_uint) + sizeof(cl_float); // two of them a link
  const double shares = std::max(0.0, links.bytes - links.links * sizeof(Link));
  return a_node * make_grids(tree, options).nodes() + a_cluster * tree.nodes.size() + plane_bytes(tree.points.size()) +
         static_cast<std::uint64_t>(2.0 * an_entry * links.links + shares);
}

std::uint64_t vmap_bytes(std::size_t points, std::size_t segments) {
  return sizeof(Splat) * points + (sizeof(Segment) + 1) * segments;
}

std::uint64_t photon_map_bytes(std::uint64_t photons, std::size_t pool) {
  const std::uint64_t buckets = (photons + PHOTON_LANES - 1) / PHOTON_LANES;
  // A node has eight buckets below it, and each level an eighth of the nodes of the next.
  return buckets * (PHOTON_BUCKET_WORDS * sizeof(float) + sizeof(PhotonNode) / 7) + texel * pool;
}

std::uint64_t tile_bytes(std::size_t columns, std::size_t film_channels) {
  return columns * band_rows * (sizeof(EyeHits) + film_channels * sizeof(float));
}

std::uint64_t sky_bytes(const DeviceLighting& lighting) {
  if (lighting.sky == nullptr) return 0;
  const auto width = static_cast<std::uint64_t>(lighting.sky->width),
             height = static_cast<std::uint64_t>(lighting.sky->height);
  return width * height * (sizeof(SkyTexel) + sizeof(float)) + height * sizeof(SkyRow);
}

} // namespace pointgi
