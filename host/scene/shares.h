#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pointgi {

/// Numbers in [0,1) that choose by shares are whole multiples of this (kernels/lib/rng.cl).
constexpr double smallest_share = 0x1p-24;

/// entry.cumulative of entries in their order: running shares of weight(entry) >= 0 in their sum, > 0; the last is
/// exactly 1. All are multiples of smallest_share, so that an entry is chosen just as often as its share says: whoever
/// weighs what is chosen by that is right on the mean. Of up to 2^23 entries none of weight > 0 has no share; of more,
/// where most of the shares would be such, rounding decides.
template <typename Entries, typename Weight>
void accumulate_shares(Entries& entries, const Weight& weight) {
  if (entries.empty()) return;
  const double most_entries = 0x1p23;
  const double floor = static_cast<double>(entries.size()) <= most_entries ? smallest_share : 0.0;
  double total = 0.0, sum = 0.0, before = 0.0;
  for (const auto& entry : entries)
    total += weight(entry);
  for (auto& entry : entries) {
    const double w = weight(entry);
    sum += w;
    const double rounded = std::round(sum / total / smallest_share) * smallest_share;
    before = std::max(rounded, w > 0.0 ? before + floor : before);
    entry.cumulative = static_cast<float>(before);
  }
  double most = 1.0; // what the small ones have got, the large ones before them give
  for (std::size_t i = entries.size(); i-- > 0;) {
    const double cumulative = std::min(static_cast<double>(entries[i].cumulative), most);
    entries[i].cumulative = static_cast<float>(cumulative);
    most = weight(entries[i]) > 0.0 ? cumulative - floor : cumulative;
  }
  entries.back().cumulative = 1.0f;
}

} // namespace pointgi
