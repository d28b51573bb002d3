#include "host/app/prepare.h"
#include "host/cloud/input_file.h"
#include "host/error.h"
#include "octree/build/cell_key.h"
#include <algorithm>

namespace pointgi {

bool is_scene_file(const std::string& file) {
  return has_extension(file, ".toml");
}

OctreePools build_pools(const std::vector<Splat>& splats, const OctreeSettings& settings,
                        const TraversalVariant& variant) {
  const bool wide = variant.form == TraversalForm::wide;
  TreeOptions options;
  options.axis_bits = variant.axis_bits;
  // Flat around these on the scans; larger leaves keep the pools below 90 bytes a splat.
  options.leaf_capacity = settings.leaf_capacity != 0 ? settings.leaf_capacity : wide ? 64 : 32;
  options.max_depth = std::min(settings.max_depth, key_levels(variant.axis_bits));
  options.listing = wide ? Listing::centres : Listing::overlaps;
  const Tree tree = build_tree(splats, options);
  OctreePools pools = wide ? OctreePools(pack_wide(splats, tree, variant.lanes)) : OctreePools(pack_step(splats, tree));
#ifndef NDEBUG
  std::visit([](const auto& p) { verify(p); }, pools);
#endif
  return pools;
}

void refuse_unsupported(const Scene& scene) {
  for (const MaterialSettings& material : scene.materials)
    if (material.type != MaterialType::diffuse)
      throw Error(ExitCode::input, material.place.text() + ": material \"" + material.name + "\": type \"" +
                                       name_of(material.type) +
                                       "\" cannot be rendered by this version; it renders \"diffuse\"");
}

} // namespace pointgi
