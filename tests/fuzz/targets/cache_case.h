#pragma once
/// What the files of the cache are of, for the target and for those who write its corpus.
#include "host/cache/binary_cache.h"
#include "octree/vmap/cluster_tree.h"
#include <cstring>
#include <string>

namespace pointgi::test {

inline const std::string cache_key = "a scene";

/// A root and its two leaves. Links look at nothing but how many points clusters have.
inline ClusterTree small_tree() {
  ClusterTree tree;
  for (const std::uint32_t count : {5u, 2u, 3u}) {
    Cluster cluster{};
    cluster.count = count;
    tree.nodes.push_back(cluster);
  }
  return tree;
}

/// The file as it would be if its hash, at byte `place`, were of the rest from byte `begin` on: no mutation finds that.
inline std::string with_hash(std::string file, std::size_t place, std::size_t begin) {
  if (file.size() < place + sizeof(std::uint64_t) || file.size() < begin) return file;
  std::memset(file.data() + place, 0, sizeof(std::uint64_t));
  const std::uint64_t hash = fnv1a(std::string_view(file).substr(begin));
  std::memcpy(file.data() + place, &hash, sizeof hash);
  return file;
}

} // namespace pointgi::test
