#pragma once
/// V-maps kept between runs: links depend on the geometry alone, so a second picture of a scene need not ask again.
#include "octree/vmap/make_links.h"
#include <optional>
#include <string>

namespace pointgi {

/// Everything that links depend on, as text: the tree and its points, all splats that block, the options but for
/// `batch`, and who answers (device, driver, variant: two may differ in a rim's rounding).
std::string vmap_key(const ClusterTree& tree, View<Splat> splats, const LinkOptions& options,
                     const std::string& answered_by);

/// Where the V-map of this key is kept: below cache_folder() (host/cache/binary_cache.h); empty when nothing is kept.
std::string vmap_file(const std::string& key);

/// While one lives, this thread neither keeps V-maps nor takes those that are kept: what is measured is then the making
/// of one.
class NoVMapsKept {
public:
  NoVMapsKept();
  ~NoVMapsKept();
  NoVMapsKept(const NoVMapsKept&) = delete;
  NoVMapsKept& operator=(const NoVMapsKept&) = delete;
};

struct KeptVMap {
  std::optional<VMap> map;
  std::string warning; ///< why a file that is there was not used; empty when there is none
};

/// The V-map of this key, if one is kept. The file names itself (magic, version, sizes, full key, hash of its content);
/// one that is damaged, of another version, machine or scene is not used, nor are links that `tree` cannot have.
KeptVMap load_vmap(const std::string& key, const ClusterTree& tree);

/// Keeps it, whole or not at all; a full disk or a read-only folder only means that nothing is kept.
void store_vmap(const std::string& key, const VMap& map);

/// Kept links, or else made by make_links and kept. Warnings go to the log. `was_kept`, if given, says which.
VMap kept_or_made_links(const ClusterTree& tree, View<Splat> splats, VisibilityOracle& oracle,
                        const LinkOptions& options, const std::string& answered_by, bool* was_kept = nullptr);

} // namespace pointgi
