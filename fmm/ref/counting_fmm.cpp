#include "fmm/ref/counting_fmm.h"

namespace pointgi {

std::vector<std::uint64_t> count_sources(const ClusterTree& tree, const InteractionLists& lists) {
  const std::size_t clusters = tree.nodes.size();
  std::vector<std::uint64_t> moment(clusters, 0), local(clusters, 0), read(tree.points.size(), 0);
  for (std::size_t k = clusters; k-- > 0;) {
    if (tree.nodes[k].child_count == 0) moment[k] = tree.nodes[k].count;
    if (k != 0) moment[tree.nodes[k].parent] += moment[k];
  }
  for (std::size_t k = 0; k < clusters; ++k) {
    if (k != 0) local[k] = local[tree.nodes[k].parent];
    for (std::uint32_t e = lists.far.begin[k]; e < lists.far.begin[k + 1]; ++e)
      local[k] += moment[lists.far.source[e]];
  }
  for (std::size_t i = 0; i < read.size(); ++i) {
    read[i] = local[tree.leaf_of[i]];
    for (std::uint32_t k = tree.leaf_of[i];; k = tree.nodes[k].parent) {
      for (const SourceLists* rows : {&lists.mid, &lists.near_})
        for (std::uint32_t e = rows->begin[k]; e < rows->begin[k + 1]; ++e)
          read[i] += tree.nodes[rows->source[e]].count;
      if (k == 0) break;
    }
  }
  return read;
}

} // namespace pointgi
