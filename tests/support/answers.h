#pragma once
/// Answers of rays, held against each other.
#include "host/tune/variant_list.h"
#include "shared/traversal_types.h"
#include "tests/support/device.h"
#include <algorithm>
#include <cmath>
#include <vector>

namespace pointgi::test {

/// Rays that find another splat, unless both lie at exactly one distance, or a t further off than 1e-5. (Both kernels
/// round alike, so t should in fact be bit-identical on one device.)
inline std::size_t differences(const std::vector<RayAnswer>& a, const std::vector<RayAnswer>& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const bool same_splat = a[i].splat == b[i].splat;
    const bool tie = a[i].splat != NO_SPLAT && b[i].splat != NO_SPLAT && a[i].t == b[i].t;
    if (!(same_splat || tie) || !(std::fabs(a[i].t - b[i].t) <= 1e-5f)) ++count;
  }
  return count;
}

/// The list that all shared tests go through: those whose tracing differs, as far as this device takes them.
inline std::vector<TraversalVariant> valid_variants() {
  std::vector<TraversalVariant> variants;
  for (const TraversalVariant& variant : tracing_variants())
    if (why_not(variant, session().info()).empty()) variants.push_back(variant);
  return variants;
}

inline std::size_t hits(const std::vector<RayAnswer>& answers) {
  return static_cast<std::size_t>(
      std::count_if(answers.begin(), answers.end(), [](const RayAnswer& a) { return a.splat != NO_SPLAT; }));
}

} // namespace pointgi::test
