#pragma once
/// Times every variant on a scene and checks each against the reference: `pointgi profile`.
#include "host/image/picture_writer.h"
#include "host/scene/frame.h"
#include "host/tune/variant_list.h"
#include "octree/splat.h"
#include <array>
#include <functional>

namespace pointgi {

class Session;

/// What is timed of each variant.
enum class ProfiledKernel {
  eye,      ///< nearest hits of the camera's rays, 8x4 a pixel: coherent
  bounced,  ///< nearest hits of cosine rays off random splats: incoherent
  any,      ///< whether these hit anything
  segments, ///< whether anything stands between two splats, of pairs drawn at random: what the V-map asks
  photons,  ///< photons from the lights by way of specular splats, to where they end
  render    ///< eye rays and shading of rows of the picture: what a user waits for
};
constexpr std::size_t profiled_kernels = 6;
const char* name_of(ProfiledKernel kernel);

struct ProfileRequest {
  const Scene& scene;
  const Frame& frame;
  const std::vector<Splat>& splats;
  const SplatClips& clips;                ///< of these splats
  const PatchBends& bends;                ///< as well; empty where they are discs
  std::vector<TraversalVariant> variants; ///< the reference is measured whether it is among them or not
  int rounds = 5;                         ///< timed ones; one more before them warms up
  unsigned seed = 1;
  double launch_seconds = 0.04; ///< that a launch of the reference shall take; shorter ones of others are repeated
  std::uint64_t pool_bytes = std::uint64_t{1} << 30; ///< pools held on the device at a time
};

/// One kernel of one variant.
struct KernelProfile {
  std::vector<double> seconds; ///< device seconds of a launch in each timed round, a mean where launches are short
  std::vector<double> speedup; ///< of each: the reference's last seconds before it, over these
  std::uint64_t rays = 0;
  std::uint64_t bytes = 0; ///< the least that must move: rays in, answers out, the pools once
  /// Rays that differ from the reference; of render eye rays, and pixels where they are more than few, of photons those
  /// that end elsewhere where they are.
  std::size_t wrong = 0;
  /// Rays that find another splat at exactly the same distance; of photons, those that meet such a splat and therefore
  /// miss their leaf in one of the two trees. Counted apart, allowed.
  std::size_t ties = 0;
  bool skipped = false; ///< the scene has nothing for it: Profile::without_photons
};

struct VariantProfile {
  TraversalVariant variant;
  std::string failure; ///< why it could not be measured to the end; empty when it was
  std::uint64_t pool_bytes = 0;
  std::array<KernelProfile, profiled_kernels> kernels;

  bool complete() const; ///< every kernel that the scene has work for has a timed round
  bool wrong() const;    ///< answers differ; never said of fast math, which is approximate by its name
  /// What the ranking goes by: how many times as fast as the reference the picture comes, median of the rounds.
  double speedup(ProfiledKernel kernel = ProfiledKernel::render) const;
};

struct Profile {
  std::vector<VariantProfile> variants;               ///< reference first, then in the order of the request
  std::array<std::uint64_t, profiled_kernels> rays{}; ///< a launch, eye and shadow rays of the reference for render
  PixelWindow eye_window, render_window;
  std::size_t proved_rays = 0; ///< of the reference, by a linear scan
  std::string without_photons; ///< why the scene has none to time; empty when it has
  bool interrupted = false;

  /// Indices into variants, fastest first; only those that are complete and not wrong.
  std::vector<std::size_t> ranking() const;
  /// The fastest of these with exact arithmetic; nothing that is wrong or approximate ever wins.
  const VariantProfile* winner() const;
};

/// The reference is first proved by a linear scan. Then round by round every variant runs once, in an order that moves
/// on, with the reference again and again among them: speed is told as a ratio, for the machine's own speed changes.
/// `progress` (share done) is called and `stop` asked between launches, save for the reference's first. Throws
/// Error(device) when the reference is wrong or cannot run; what happens to another variant is told in its `failure`.
Profile profile_variants(Session& session, const ProfileRequest& request, const std::function<void(double)>& progress,
                         const std::function<bool()>& stop);

} // namespace pointgi
