#include "host/app/prepare.h"
#include "host/error.h"

namespace pointgi {

bool is_scene_file(const std::string& file) {
  const std::string end = ".toml";
  return file.size() >= end.size() && file.compare(file.size() - end.size(), end.size(), end) == 0;
}

StepPools build_pools(const std::vector<Splat>& splats, const TreeOptions& options) {
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
