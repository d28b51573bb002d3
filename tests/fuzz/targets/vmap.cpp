/// A kept V-map, as it is and with the right hash: links that the tree can have, or a warning.
#include "host/cache/vmap_cache.h"
#include "tests/fuzz/targets/cache_case.h"
#include "tests/fuzz/targets/target.h"
#include "tests/support/promises.h"
#include <filesystem>

using namespace pointgi;
using namespace pointgi::test;

namespace {

std::string broken_promise(const KeptVMap& kept, const ClusterTree& tree) {
  if (!kept.map) return kept.warning.empty() ? "a file is not used, and no warning says so" : "";
  if (!kept.warning.empty()) return "a file is used, and a warning says that it is not";
  for (const Link& link : kept.map->links) {
    if (link.a > link.b || link.b >= tree.nodes.size()) return "a link leads to no cluster";
    if (!(link.visible > 0.0f && link.visible <= 1.0f)) return "a link's share is none";
    if (link.point_shares != no_point_shares &&
        std::uint64_t{link.point_shares} + tree.nodes[link.a].count + tree.nodes[link.b].count >
            kept.map->point_shares.size())
      return "the points of a link have no shares";
  }
  return {};
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const ClusterTree tree = small_tree();
  static const std::string name = [] { // write_input() writes below the folder of POINTGI_CACHE_DIR
    const std::filesystem::path path = vmap_file(cache_key);
    std::filesystem::create_directories(path.parent_path());
    return std::filesystem::relative(path, scratch_folder()).string();
  }();
  const std::string file(view_of(data, size));
  constexpr std::size_t hash_place = 48 + sizeof(LinkStatistics);
  for (const std::string& bytes : {file, with_hash(file, hash_place, 0)}) {
    write_input(name, bytes);
    require_kept(broken_promise(load_vmap(cache_key, tree), tree));
  }
  return 0;
}
