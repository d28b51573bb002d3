#include "host/passes/variant.h"

namespace pointgi {

std::string build_options(const TraversalVariant& variant) {
  const char* storage = variant.storage == PoolStorage::buffer           ? "POOL_BUFFER"
                        : variant.storage == PoolStorage::image1d_buffer ? "POOL_IMAGE1D"
                                                                         : "POOL_IMAGE2D";
  std::string options = std::string("-D POOL_STORAGE=") + storage +
                        " -D OCTREE_AXIS_BITS=" + std::to_string(variant.axis_bits) +
                        " -D POOL_WIDTH_LOG2=" + std::to_string(image_width_log2);
  if (variant.stepping == Stepping::absolute_delta) options += " -D STEP_ABSOLUTE";
  return options;
}

std::string build_options(const TraversalVariant& variant, const SceneFeatures& features) {
  std::string options = build_options(variant);
  if (features.delta_lights) options += " -D HAS_DELTA_LIGHTS";
  if (features.emitters) options += " -D HAS_EMITTERS";
  if (features.environment) options += " -D HAS_ENVIRONMENT";
  return options;
}

} // namespace pointgi
