#include "host/passes/variant.h"
#include "host/error.h"

namespace pointgi {

TraversalVariant choose_variant(const TraversalSettings& settings, const OctreeSettings& octree, bool device_is_cpu) {
  TraversalVariant variant{settings, octree.branching == 4 ? 2u : 1u};
  const bool step_settings =
      octree.branching != 2 || settings.storage != PoolStorage::buffer || settings.stepping != Stepping::exact;
  if (settings.form == TraversalForm::automatic)
    variant.form = device_is_cpu && !step_settings ? TraversalForm::wide : TraversalForm::step;
  else if (settings.form == TraversalForm::wide && step_settings)
    throw Error(ExitCode::usage, "traversal.form = \"wide\" goes with octree.branching = 2, storage = \"buffer\" and "
                                 "stepping = \"exact\"; set these, or form = \"step\"");
  return variant;
}

std::string build_options(const TraversalVariant& variant) {
  if (variant.form == TraversalForm::wide)
    return "-D TRAVERSAL_FORM=FORM_WIDE -D WIDE_LANES=" + std::to_string(variant.lanes);
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
