#pragma once
/// Trades kept in the cache folder, so that a command finds what was measured of its scene.
#include "host/measure/trade.h"

namespace pointgi {

/// Keeps it, in place of an earlier one of the same scene file and device, unless that has more runs of the same state.
/// A full disk or a read-only folder only means that nothing is kept.
void store_trade(const Trade& trade);

/// Of this scene file on this device; absent: none, one of another version, or one that cannot be read.
std::optional<Trade> stored_trade(const std::string& scene, const std::string& device);

} // namespace pointgi
