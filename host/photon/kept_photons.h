#pragma once
#include "shared/photon_types.h"
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pointgi {

/// Stored photons in bounded memory. When there are too many, one half of them goes, chosen by their numbers, and the
/// other gets its power: as bright on the mean. Which are kept in the end depends on which photons there were alone.
class KeptPhotons {
public:
  /// `most` >= 1.
  KeptPhotons(std::size_t most, std::uint32_t seed) : most_(most), seed_(seed) {}

  /// `number`: no two photons have the same.
  void add(const Photon& photon, std::uint32_t number);

  /// Of so many photons one is kept: 1, 2, 4, ...
  std::uint64_t one_of() const { return std::uint64_t{1} << halvings_; }

  /// Those that are kept, in the order in which they were added, one_of() times as powerful. Ends the object's use.
  std::vector<Photon> take();

private:
  void halve();

  std::size_t most_;
  std::uint32_t seed_;
  unsigned halvings_ = 0;
  std::vector<Photon> photons_;
  std::vector<std::uint8_t> thinning_level_; ///< halvings, of each photon
};

} // namespace pointgi
