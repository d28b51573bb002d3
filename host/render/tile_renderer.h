#pragma once
/// A tile of the picture on the device: hits of its eye rays, then its film.
#include "host/passes/device_cones.h"
#include "host/passes/device_lights.h"
#include "host/passes/device_pools.h"
#include "host/photon/device_photon_map.h"
#include "host/render/light_paths.h"
#include "host/scene/lighting.h"

namespace pointgi {

/// Scalars a pixel of a film: with specular surfaces their followed channels besides, with photons those of caustics;
/// behind them, where asked for, what guides a denoiser.
inline std::size_t film_scalars(bool specular, bool photons, bool auxiliary) {
  const std::size_t light = photons ? FILM_CHANNELS_CAUSTIC : specular ? FILM_CHANNELS_SPECULAR : FILM_CHANNELS;
  return light + (auxiliary ? AUXILIARY_CHANNELS : 0);
}

/// Device seconds of a tile's two kernels.
struct TileSeconds {
  double eye = 0.0;   ///< nearest hits of the eye rays
  double shade = 0.0; ///< everything after these
  double all() const { return eye + shade; }
};

/// The picture's kernels in a variant, with all of their arguments but the tile's place. Borrows session and pools.
class TileRenderer {
public:
  /// `side`: of the root cube, world units; `paths`: by path tracing; else
  /// `irradiance`, of each point, is reflected too where it is there, and what pixels gather by `cones`, and instead of
  /// shadow rays' light without `shadow_rays`. Without a `normal_field` no surface is specular: all but diffuse ones
  /// look black. `stored_direct`: what the points of the pool, `pool_points`, know of their direct light; shadow rays
  /// find the rest. `auxiliary`: the film has what guides a denoiser. Builds the programs where they are not built yet.
  TileRenderer(Session& session, const DevicePools& pools, const DeviceLighting& lighting, double side,
               const TraversalVariant& variant, const std::optional<LightPaths>& paths = {},
               const Buffer<cl_float4>* irradiance = nullptr, bool shadow_rays = true,
               const Buffer<cl_float4>* normal_field = nullptr, const DevicePhotonMap* photons = nullptr,
               Backfaces backfaces = Backfaces::shade, const DeviceCones* cones = nullptr,
               const Buffer<cl_float4>* stored_direct = nullptr, std::size_t pool_points = 0, bool auxiliary = false);

  pg_uint samples() const { return params_.samples; }

  /// From the next launch on: how many samples a pixel has in all, which the last pass is laid out by.
  void set_samples(pg_uint samples);

  /// The next launch adds to this film of a tile of as many pixels, film_channels() scalars each.
  void go_on_from(const std::vector<float>& film);

  /// One pass of up to 32 samples over a tile of the image; returns the device's seconds.
  TileSeconds launch(int x, int y, int columns, int rows, pg_uint first_sample);

  /// film_scalars() of its film.
  std::size_t film_channels() const { return film_channels_; }

  /// The film of the last tile, film_channels() a pixel: sums over the samples of all passes since the first.
  std::vector<float> film(int columns, int rows);

  /// What the eye rays of its last pass met, pixel after pixel; GRID_RAYS a pixel whatever the number of samples.
  std::vector<EyeHits> hits(int columns, int rows);

private:
  Session& session_;
  Buffer<cl_float4> nothing_stored_;        ///< where programs take what the scene has none of
  std::vector<cl::Memory> octree_, points_; ///< OCTREE_PARAMS and POOL_PARAMS (kernels/lib/pools.cl)
  RenderParams params_;
  RayGrouping grouping_;
  WorkGroup eye_group_, shade_group_;
  cl::Kernel eye_rays_, shade_;
  DeviceLights lights_;
  std::size_t film_channels_;
  Buffer<EyeHits> hits_;
  Buffer<float> film_;
};

} // namespace pointgi
