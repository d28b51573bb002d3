#pragma once
/// Truth of where a clipped disc ends.
#include "octree/splat.h"

namespace pointgi {

/// Whether a place of the disc, `off` from its centre, lies past its border; in double precision.
inline bool is_clipped_off(const DiscClip& clip, const double off[3]) {
  for (const ClipStrip& strip : clip.strip) {
    const double along = strip.axis[0] * off[0] + strip.axis[1] * off[1] + strip.axis[2] * off[2];
    if (along < strip.low || along > strip.high) return true;
  }
  return false;
}

} // namespace pointgi
