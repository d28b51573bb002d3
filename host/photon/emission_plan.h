#pragma once
/// How many photons each light sends to each specular leaf (method.md §5).
#include "host/photon/specular_leaves.h"
#include "octree/vmap/make_links.h"
#include "shared/render_types.h"
#include <array>

namespace pointgi {

/// What sends photons, as the device has it.
struct PhotonSources {
  std::vector<LightSource> light_sources;
  std::vector<Emitter> emitters;              ///< chosen by their shares; all of them are one source
  std::vector<std::array<float, 4>> radiance; ///< of each emitter's front, scaled; [3] 0
  std::array<float, 3> environment{};         ///< radiance from every direction, of a map the mean, scaled

  bool has_environment() const { return environment[0] + environment[1] + environment[2] > 0.0f; }
};

/// Who says what stands between points of a table: indices of the segments are into it.
using AskSegments = std::function<std::vector<std::uint8_t>(View<Splat> table, View<Segment> segments)>;

struct EmissionOptions {
  std::uint64_t photons = 400'000; ///< that shall set out from leaves; 0 to 1e8
  bool equal_power = false;        ///< as in the thesis; else unbiased
  std::uint32_t seed = 1;
};

struct EmissionPlan {
  std::vector<EmissionBatch> batches; ///< one after the other in the photons' numbers; none without photons
  std::uint32_t photons = 0;          ///< numbers in all: more than asked for, as some fly past their leaf
};

/// Pairs of a source and a leaf that are told apart, about: how many leaves there may be follows.
constexpr std::size_t most_photon_pairs = std::size_t{1} << 17;

/// Unbiased: a pair gets photons in proportion to what the source sends into the leaf's sphere. A pair between which K
/// segments find everything blocked gets an eighth of that, which weigh eightfold: what the segments missed is not
/// lost. Where less than one photon falls on a pair, chance decides whether one flies, with the power that makes the
/// mean right. Photons that pass their leaf by count for nothing; so that about `photons` do count, more fly, fourfold
/// at most. Equal power: the leaf is its average disc; N = n_e SA / 4pi with n_e such that `photons` fly in all;
/// nothing to leaves that no segment reaches. Light that is neither a point nor a direction goes by its flux through
/// the disc.
EmissionPlan plan_emission(const SpecularLeaves& leaves, View<Splat> points, const PhotonSources& sources,
                           const AskSegments& ask, const EmissionOptions& options);

} // namespace pointgi
