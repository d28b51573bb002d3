#pragma once
/// The render stage: a window of the image, band after band (kernels/render).
#include "host/image/picture_writer.h"
#include "host/passes/device_cones.h"
#include "host/passes/device_pools.h"
#include "host/photon/device_photon_map.h"
#include "host/render/light_paths.h"
#include "host/scene/lighting.h"
#include <functional>

namespace pointgi {

/// Eye rays at one object, as far as pixels tell: all of a pixel's go to what its first sample met.
struct ObjectRays {
  std::uint64_t on_splats = 0, on_backs = 0;
};

/// Rows of a band: enough for the EXR's blocks of 16, few enough that a picture 65536 wide stays small in memory.
constexpr int band_rows = 16;

/// What the device made of the window.
struct RenderTotals {
  std::uint64_t eye_rays = 0;
  std::uint64_t rays = 0; ///< eye and shadow rays
  std::uint64_t eye_rays_on_splats = 0;
  std::uint64_t eye_rays_on_back_faces = 0;
  double eye_seconds = 0.0;          ///< of the device, for the nearest hits of the eye rays
  double device_seconds = 0.0;       ///< in all
  std::vector<ObjectRays> of_object; ///< in the order of RenderRequest::first_ids
  bool lit = false;                  ///< some pixel of R, G and B is above 0
  bool interrupted = false;
  int rows_done = 0;

  /// Of the eye rays that hit a splat, the share that met its back; 0 when none hit.
  double back_face_share() const {
    return eye_rays_on_splats > 0
               ? static_cast<double>(eye_rays_on_back_faces) / static_cast<double>(eye_rays_on_splats)
               : 0.0;
  }
};

/// The EXR channels of a band, in the order of its values (interface.md): those whose stages exist. `indirect`: light
/// from surface to surface is among them; `specular`: what is seen by way of specular surfaces is; `caustic`: what
/// diffuse surfaces receive by way of them is; `auxiliary`: what guides a denoiser is, behind all others.
std::vector<ChannelName> film_channels(bool indirect, bool specular, bool caustic, bool auxiliary = false);

struct RenderRequest {
  PixelWindow window;
  const DeviceLighting& lighting;
  const Frame& frame;
  View<std::uint32_t> point_ids; ///< id to write for each point of the pool
  TraversalVariant variant;
  std::optional<LightPaths> paths;               ///< by path tracing, of these; else direct light and `irradiance`
  const Buffer<cl_float4>* irradiance = nullptr; ///< of each point of the pool, from surfaces; null: none
  const DeviceCones* cones = nullptr; ///< by which pixels gather light between surfaces besides; null: they do not
  const Buffer<cl_float4>* stored_direct = nullptr; ///< what points know of their direct light (StoredDirect); null:
                                                    ///< nothing, all is left to shadow rays
  bool shadow_rays = true; ///< at pixels; false: direct light is in `irradiance` already (method.md §6)
  const Buffer<cl_float4>* normal_field = nullptr; ///< slopes of each point's normal; null: nothing is specular

  const DevicePhotonMap* photons = nullptr; ///< gathered on diffuse surfaces; null: none
  View<std::uint32_t> first_ids{}; ///< rising: the first id of each object, of which the totals then tell; empty: none
  Backfaces backfaces = Backfaces::shade;
  bool auxiliary = false; ///< the channels Denoise.Albedo, Denoise.N and Denoise.Emission, too

  bool has_indirect() const { return paths.has_value() || irradiance != nullptr; }
  bool has_specular() const { return normal_field != nullptr; }
  bool has_caustics() const { return photons != nullptr && has_specular() && !paths; }
};

/// Renders the window's rows from the top and hands finished bands to `take`, after each launch `progress` (share done,
/// 0..1); stops between launches when `stop` says so (the rows finished so far have been handed over). `take` is called
/// from another thread, for one band at a time, while the next is rendered. Bands that this thread's checkpoint has are
/// handed over as an earlier run made them.
RenderTotals render(Session& session, const DevicePools& pools, const RenderRequest& request,
                    const std::function<void(const Band&)>& take, const std::function<void(double)>& progress,
                    const std::function<bool()>& stop);

} // namespace pointgi
