#pragma once
/// What the launches of a profile found, and how it compares.
#include "octree/view.h"
#include "shared/photon_types.h"
#include "shared/traversal_types.h"
#include <cstdint>
#include <vector>

namespace pointgi {

struct Differences {
  std::size_t wrong = 0;
  std::size_t ties = 0; ///< another splat at exactly the same distance

  Differences operator+(const Differences& other) const { return {wrong + other.wrong, ties + other.ties}; }
};

/// Answers to the same rays; splats are input indices. Wrong: another splat, or a t further off than 1e-5 of the larger
/// of t and the root cube's side. Trees of another order may keep another of two discs that are hit at one distance.
Differences compare_answers(View<RayAnswer> found, View<RayAnswer> truth);

/// Blocked or not, of the same rays.
Differences compare_blocked(View<std::uint32_t> found, View<std::uint32_t> truth);

/// What became of the same photons. Those that end otherwise, further off than a thousandth of the root cube's side, or
/// with powers that differ by more than a hundredth are wrong where they are more than one in a hundred of those that
/// set out, else forgiven: what rounds otherwise on one curved mirror is far off behind the next. Those that set out
/// here and passed their leaf by there are ties, for discs of one plane are met at one distance and may be of two
/// leaves; as many must have set out, but for one in a hundred and for chance: any more or fewer are wrong.
Differences compare_flights(View<PhotonFlight> found, View<PhotonFlight> truth);

/// Films of the same pixels. Pixels that differ are wrong where they are more than one in a hundred, else forgiven:
/// blending adds up in another order, and a hit that rounds to the other side of a rim changes a sample.
/// `lit_alike`: direct light is compared too; not where emitters stand in another order and are drawn differently.
Differences compare_films(View<float> found, View<float> truth, bool lit_alike);

/// Pool indices become input indices.
void to_inputs(std::vector<RayAnswer>& answers, const std::vector<std::uint32_t>& source);

} // namespace pointgi
