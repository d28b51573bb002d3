#pragma once
/// All the faults of a kind, or some of them.
#include "tests/golden/faults/fault_runs.h"

namespace pointgi::test {

struct FaultTally {
  std::size_t tried = 0, right_pictures = 0, clear_errors = 0, killed = 0, not_met = 0;
  std::vector<std::string> findings;
};

/// "build", "buffer", "image", "enqueue", "read", "event", "device", "lost", "thread", "file", "killed", "allocation",
/// "exhausted".
std::vector<std::string> fault_kinds();

/// Every fault of the kind that the scene's undisturbed run has a call for: each call of each function, each place of
/// allocations. Throws std::invalid_argument for an unknown kind.
std::vector<Fault> faults_of(const std::string& kind, const CallReport& calls);

/// Tries them, two at a time.
FaultTally try_faults(const FaultScene& scene, const std::vector<Fault>& faults);

} // namespace pointgi::test
