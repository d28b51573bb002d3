#pragma once
/// Launches over blocks of FMM_LANES nodes or points, one or more work-items each as suits the device.
#include "host/cl/pace.h"
#include "host/cl/session.h"
#include "host/passes/variant.h"

namespace pointgi {

/// `work`: a guess for the first launch. A launch has as many blocks as keep the device busy.
inline Pace pace_of_blocks(const Session& session, double work) {
  return Pace(work, busy_work_items(session.info()) / fmm_items_on(session.info()));
}

/// For `blocks` of them, padded to whole groups of `group` work-items.
inline LaunchShape line_of_blocks(const Session& session, std::size_t blocks, std::size_t group) {
  return LaunchShape::line(blocks * fmm_items_on(session.info()), group);
}

} // namespace pointgi
