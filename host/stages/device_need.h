#pragma once
/// Device memory that the stages of light take, by closed forms: told before any of them runs.
#include "host/radiosity/method.h"
#include "host/scene/lighting.h"

namespace pointgi {

/// Bytes of a stage besides what the device holds before it.
struct DeviceNeed {
  std::uint64_t least = 0; ///< without these it cannot run
  std::uint64_t usual = 0; ///< that it takes where there are so many
};

/// Points of which a method is told.
struct ExchangedCount {
  std::size_t points = 0; ///< that exchange light
  std::size_t pool = 0;   ///< all
};

/// Of the stage of a method but "fmm", whose links decide (fmm_bytes). `left`: Session::bytes_left() before it, which
/// bounds the hits that "directions" keeps. Of voxels what splats share is a guess: three a splat.
DeviceNeed exchange_need(const std::string& method, const RadiositySettings& settings, const ExchangedCount& count,
                         std::uint64_t left);

/// Of the stage `fmm`: grids, points, and both directions of so many links, with their points' shares. What dividing
/// the sources of partly hidden links adds is not in it: about a third.
std::uint64_t fmm_bytes(const ClusterTree& tree, unsigned order, const LinkEstimate& links);

/// Of the stage `vmap`: its points, and so many segments at a time.
std::uint64_t vmap_bytes(std::size_t points, std::size_t segments);

/// Of a map of so many photons, gathered at the points of a pool.
std::uint64_t photon_map_bytes(std::uint64_t photons, std::size_t pool);

/// Of a tile of a picture, a band high: its hits and its film.
std::uint64_t tile_bytes(std::size_t columns, std::size_t film_channels);

/// Of the environment's map, or 0.
std::uint64_t sky_bytes(const DeviceLighting& lighting);

} // namespace pointgi
