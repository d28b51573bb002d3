#pragma once
/// An FMM that counts: it proves the lists before the maths (exafmm-t's DummyFmm).
#include "fmm/lists/interaction_lists.h"

namespace pointgi {

/// How many sources each point reads, in tree order, when every point is a unit charge that goes through the lists as
/// light does: up to the clusters, over far rows, down to the points, and over mid and near rows. A link's share is
/// ignored; a leaf linked to itself counts the point itself, too.
std::vector<std::uint64_t> count_sources(const ClusterTree& tree, const InteractionLists& lists);

} // namespace pointgi
