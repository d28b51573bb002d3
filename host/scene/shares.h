#pragma once
#include <algorithm>
#include <cstddef>

namespace pointgi {

/// Numbers in [0,1) that choose by shares are floats: none lies between shares closer than this.
constexpr float smallest_share = 0x1p-24f;

/// entry.cumulative of entries in their order: running shares of weight(entry) >= 0 in their sum, > 0; the last is
/// exactly 1. An entry of weight > 0 gets no less than smallest_share, so that of 2^24 entries, at most, none is never
/// chosen: whoever weighs what is chosen by the share that it has here is right on the mean.
template <typename Entries, typename Weight>
void accumulate_shares(Entries& entries, const Weight& weight) {
  if (entries.empty()) return;
  double total = 0.0, sum = 0.0;
  for (const auto& entry : entries)
    total += weight(entry);
  float before = 0.0f;
  for (auto& entry : entries) {
    const double w = weight(entry);
    sum += w;
    const float least = w > 0.0 ? before + smallest_share : before;
    before = entry.cumulative = std::max(static_cast<float>(sum / total), least);
  }
  float most = 1.0f; // what the small ones have got, the large ones before them give
  for (std::size_t i = entries.size(); i-- > 0;) {
    entries[i].cumulative = std::min(entries[i].cumulative, most);
    most = weight(entries[i]) > 0.0 ? std::max(entries[i].cumulative - smallest_share, 0.0f) : entries[i].cumulative;
  }
  entries.back().cumulative = 1.0f;
}

} // namespace pointgi
