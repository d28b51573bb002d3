#include "host/app/prepare.h"
#include "host/error.h"
#include "octree/build/cell_key.h"
#include <algorithm>

namespace pointgi {

bool is_scene_file(const std::string& file) {
  const std::string end = ".toml";
  return file.size() >= end.size() && file.compare(file.size() - end.size(), end.size(), end) == 0;
}

unsigned axis_bits_of(const OctreeSettings& settings) {
  return settings.branching == 4 ? 2 : 1;
}

StepPools build_pools(const std::vector<Splat>& splats, const OctreeSettings& settings) {
  const unsigned axis_bits = axis_bits_of(settings);
  const TreeOptions options{axis_bits, settings.leaf_capacity, std::min(settings.max_depth, key_levels(axis_bits))};
  StepPools pools = pack_step(splats, build_tree(splats, options));
#ifndef NDEBUG
  verify(pools);
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
