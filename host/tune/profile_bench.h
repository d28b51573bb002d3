#pragma once
/// The launches of a profile: one variant's kernels over its pools, and what they answer.
#include "host/passes/build_pools.h"
#include "host/render/tile_renderer.h"
#include "host/tune/profile.h"
#include "host/tune/profile_answers.h"
#include "host/tune/profile_photons.h"
#include <memory>

namespace pointgi {

/// What variants share that differ in storage only.
struct ProfiledTree {
  std::vector<std::uint32_t> source; ///< input index of each point of the pool
  DeviceLighting lighting;           ///< emitters refer to the pool
  std::uint64_t bytes = 0;
};

struct ProfiledPools {
  std::shared_ptr<const ProfiledTree> tree;
  DevicePools device;
  std::shared_ptr<DeviceFlight> flight; ///< null where no photons fly, or before they are planned
};

/// Variants with the same text may share a tree, or pools on the device.
std::string tree_key(const TraversalVariant& variant);
std::string pools_key(const TraversalVariant& variant);

/// Rays and windows of a profile on the device, one size for all variants; launches and checks.
class ProfileBench {
public:
  ProfileBench(Session& session, const ProfileRequest& request);

  /// Builds the variant's pools; the tree of the last call is taken again where it fits. Throws Error, also where
  /// images are too small.
  ProfiledPools load(const TraversalVariant& variant);

  /// Chooses how many rays a launch takes, by the reference, proves the reference by a linear scan and keeps its
  /// answers as the truth; `pools` get the photons that were planned. Throws Error(device) when it is wrong.
  void take_reference(const TraversalVariant& reference, ProfiledPools& pools, Profile& profile);

  /// Device seconds of one launch.
  double launch(ProfiledKernel kernel, const TraversalVariant& variant, const ProfiledPools& pools);

  /// The same, compared with the truth.
  Differences launch_and_compare(ProfiledKernel kernel, const TraversalVariant& variant, const ProfiledPools& pools);

  std::uint64_t rays(ProfiledKernel kernel) const { return rays_[static_cast<std::size_t>(kernel)]; }
  std::uint64_t bytes(ProfiledKernel kernel, const TraversalVariant& variant, const ProfiledPools& pools) const;

private:
  struct Answers {
    std::vector<RayAnswer> hits;
    std::vector<std::uint32_t> blocked;
    std::vector<PhotonFlight> flights;
    std::vector<float> film;
  };

  double trace(ProfiledKernel kernel, const TraversalVariant& variant, const ProfiledPools& pools);
  double segments(const TraversalVariant& variant, const ProfiledPools& pools);
  double render(const TraversalVariant& variant, const ProfiledPools& pools, Answers* answers);
  Answers answers(ProfiledKernel kernel, const TraversalVariant& variant, const ProfiledPools& pools);
  void set_rays(ProfiledKernel kernel, std::size_t count);
  void set_photons(const TraversalVariant& reference, ProfiledPools& pools, std::size_t count);
  bool measures(ProfiledKernel kernel) const;
  void prove(const TraversalVariant& reference, Profile& profile);

  Session& session_;
  const ProfileRequest& request_;
  std::string last_key_;
  OctreePools last_pools_;
  std::shared_ptr<const ProfiledTree> last_tree_;
  PixelWindow eye_window_, render_window_;
  Buffer<RayQuery> eye_, bounced_;
  Buffer<RayPacketQuery> eye_packets_; ///< the rays of eye_
  Buffer<RayAnswer> answers_;
  Buffer<RayPacketAnswer> packet_answers_;
  Buffer<cl_uint> blocked_;
  Buffer<Splat> splats_; ///< of the request: ends of segments
  Buffer<SegmentQuery> segments_;
  Buffer<cl_uchar> hidden_; ///< of segments
  ProfilePhotons photons_;
  std::array<std::uint64_t, profiled_kernels> rays_{};
  std::array<Answers, profiled_kernels> truth_;
};

} // namespace pointgi
