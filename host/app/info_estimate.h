#pragma once
#include "host/app/command_run.h"
#include "host/app/commands.h"

namespace pointgi {

/// What `info` tells of the picture that `render` would make: its stages, why they run or not, seconds and memory. Says
/// so where there is no device, or where render would refuse. Throws Error as render does, but of memory.
void print_estimate(const InfoOptions& options, CommandRun& run);

} // namespace pointgi
