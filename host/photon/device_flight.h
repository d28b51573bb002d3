#pragma once
/// Photons of a plan on the device, ready to fly.
#include "host/passes/device_lights.h"
#include "host/passes/device_pools.h"
#include "host/photon/emission_plan.h"

namespace pointgi {

struct PhotonRequest {
  const DeviceLighting& lighting; ///< materials, seed, most bounces
  const PhotonSources& sources;
  const SpecularLeaves& leaves;
  const EmissionPlan& plan;
  const Buffer<cl_float4>& normal_field;
  TraversalVariant variant;
  double side = 1.0; ///< of the root cube, world units
  PhotonStart start = PhotonStart::aimed;
  std::size_t batch = 0;    ///< photons a launch; 0: found by the launches' times
  std::uint32_t flight = 0; ///< photons of other flights have other random numbers
};

/// All that the photons of a request fly by. Borrows the session; keeps nothing of the request.
class DeviceFlight {
public:
  /// `pools`: of the request's variant; leaves, emitters and the normal field refer to its points. Throws
  /// Error(device), Error(memory).
  DeviceFlight(Session& session, const DevicePools& pools, const PhotonRequest& request);

  /// Numbers of photons that there are.
  std::size_t photons() const { return photons_; }

  /// Photons `first` ... `first + count` - 1 fly; flights[i] tells what became of photon first + i. The device's
  /// seconds.
  double launch(const Buffer<PhotonFlight>& flights, std::size_t first, std::size_t count);

private:
  Session& session_;
  DevicePools pools_;
  cl::Kernel kernel_;
  std::size_t photons_;
  DeviceLights lights_;
  Buffer<cl_float4> normal_field_;
  Buffer<std::array<float, 4>> radiance_;
  Buffer<EmissionBatch> batches_;
  Buffer<PhotonLeaf> leaves_;
  Buffer<std::uint32_t> leaf_splats_, leaf_of_;
};

} // namespace pointgi
