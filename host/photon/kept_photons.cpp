#include "host/photon/kept_photons.h"
#include "octree/mixed_bits.h"
#include <utility>

namespace pointgi {

namespace {

/// How many halvings a photon survives, at most 32: one half of all none, a quarter one, an eighth two, ...
std::uint8_t thinning_level(std::uint32_t number, std::uint32_t seed) {
  auto bits = static_cast<std::uint32_t>(mixed_bits((std::uint64_t{seed} << 32) + number) >> 32);
  std::uint8_t halvings = 0;
  for (; halvings < 32 && (bits & 1u) == 0; bits >>= 1)
    ++halvings;
  return halvings;
}

} // namespace

void KeptPhotons::add(const Photon& photon, std::uint32_t number) {
  const std::uint8_t level = thinning_level(number, seed_);
  if (level < halvings_) return;
  photons_.push_back(photon);
  thinning_level_.push_back(level);
  while (photons_.size() > most_)
    halve();
}

void KeptPhotons::halve() {
  ++halvings_;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < photons_.size(); ++i)
    if (thinning_level_[i] >= halvings_) {
      photons_[kept] = photons_[i];
      thinning_level_[kept++] = thinning_level_[i];
    }
  photons_.resize(kept);
  thinning_level_.resize(kept);
}

std::vector<Photon> KeptPhotons::take() {
  for (Photon& photon : photons_)
    for (float& power : photon.power)
      power *= static_cast<float>(one_of());
  return std::move(photons_);
}

} // namespace pointgi
