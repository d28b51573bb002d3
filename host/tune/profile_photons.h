#pragma once
/// The photons that `pointgi profile` times: of the scene's lights, the same ones whatever the tree.
#include "host/photon/trace_photons.h"
#include "host/tune/profile.h"

namespace pointgi {

/// Plans photons over the splats of a profile, and has them fly through the pools of any variant: what the plan says of
/// splats is told in the order of each pool.
class ProfilePhotons {
public:
  ProfilePhotons(Session& session, const ProfileRequest& request);

  /// Why the scene has none, which a plan may find out; empty when it has.
  const std::string& reason_against() const { return reason_; }

  /// About so many photons that set out from specular splats, by what `variant` finds hidden in its pools. Returns how
  /// many fly, those that pass their leaf by among them; 0 where no light reaches a specular splat. Throws
  /// Error(device), Error(memory).
  std::size_t plan(const TraversalVariant& variant, const DevicePools& pools, std::size_t photons);

  /// The planned photons among the points of a pool, `source` being the input index of each. Throws as plan().
  DeviceFlight flight(const TraversalVariant& variant, const DevicePools& pools,
                      const std::vector<std::uint32_t>& source) const;

  /// Room for what became of them; the same for all variants, which overwrite it in turn.
  const Buffer<PhotonFlight>& flights() const { return flights_; }

private:
  Session& session_;
  const ProfileRequest& request_;
  DeviceLighting lighting_; ///< emitters refer to the splats of the request
  std::string reason_;
  PhotonSources sources_;
  std::vector<cl_float4> normal_field_; ///< of the splats of the request
  AimedPhotons aimed_;
  Buffer<PhotonFlight> flights_;
};

} // namespace pointgi
