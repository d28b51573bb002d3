#pragma once
/// A part of all programs that is small enough to compile for other devices at every test.
#include "host/tune/variant_list.h"
#include <vector>

namespace pointgi {

/// Of `programs`, in their order, some in which every two options of a kernel file meet that meet in any program of it:
/// both there, one there without the other, both absent, in a program for GPUs and in one that is not (pairwise
/// testing; chosen greedily, so not the fewest). Most faults of a build need one option or two; what needs three is for
/// `scripts/crosscompile --all`. Deterministic; time grows as programs x options^2.
std::vector<ProgramUse> cover_of_pairs(const std::vector<ProgramUse>& programs);

} // namespace pointgi
