#include "host/tune/profile_photons.h"
#include <algorithm>

namespace pointgi {

ProfilePhotons::ProfilePhotons(Session& session, const ProfileRequest& request)
    : session_(session), request_(request),
      lighting_(device_lighting(request.scene, request.frame, request.splats, request.clips)),
      reason_(reason_against_photons(lighting_, request.scene.caustics)) {
  if (!reason_.empty()) return;
  sources_ = photon_sources(lighting_, request.splats);
  // Patches have normals of their own.
  if (request.bends.empty()) normal_field_ = normal_field_texels(lighting_, request.splats);
}

std::size_t ProfilePhotons::plan(const TraversalVariant& variant, const DevicePools& pools, std::size_t photons) {
  CausticSettings settings = request_.scene.caustics;
  settings.photons = static_cast<long long>(photons);
  aimed_ = aim_photons(session_, pools, variant, lighting_, sources_, request_.splats, settings, request_.frame.side);
  flights_ = {};
  if (aimed_.plan.photons == 0) {
    reason_ = "no light reaches a specular surface";
    return 0;
  }
  flights_ = session_.allocate<PhotonFlight>(aimed_.plan.photons);
  return aimed_.plan.photons;
}

DeviceFlight ProfilePhotons::flight(const TraversalVariant& variant, const DevicePools& pools,
                                    const std::vector<std::uint32_t>& source) const {
  std::vector<std::uint32_t> pool_index(source.size());
  for (std::size_t i = 0; i < source.size(); ++i)
    pool_index[source[i]] = static_cast<std::uint32_t>(i);
  PhotonSources sources = sources_;
  for (Emitter& emitter : sources.emitters)
    emitter.point = pool_index[emitter.point];
  SpecularLeaves leaves = aimed_.leaves;
  for (std::uint32_t& splat : leaves.splats)
    splat = pool_index[splat];
  std::vector<cl_float4> normals(std::max<std::size_t>(1, normal_field_.size()));
  for (std::size_t i = 0; i < source.size(); ++i) {
    leaves.leaf_of[i] = aimed_.leaves.leaf_of[source[i]];
    if (!normal_field_.empty()) normals[i] = normal_field_[source[i]];
  }
  return DeviceFlight(
      session_, pools,
      {lighting_, sources, leaves, aimed_.plan, session_.upload(normals), variant, request_.frame.side, aimed_.start});
}

} // namespace pointgi
