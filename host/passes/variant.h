#pragma once
/// The choices that make a kernel variant, and the one place where -D options are composed.
#include "host/scene/scene.h"
#include <string>

namespace pointgi {

/// The user's settings and what the kernels must know of the tree. `form` is no longer automatic.
struct TraversalVariant : TraversalSettings {
  unsigned axis_bits = 1; ///< log2 N of the tree
};

/// The variant for a device: `automatic` becomes wide on CPU devices when the settings allow it (N = 2, no setting of
/// the step form chosen), else step. Throws Error(usage) when the wide form is asked for with N = 4.
TraversalVariant choose_variant(const TraversalSettings& settings, const OctreeSettings& octree, bool device_is_cpu);

/// What the scene has, so that kernels are built without what it has not (method.md §7).
struct SceneFeatures {
  bool delta_lights = false;
  bool emitters = false;
  bool environment = false;
};

/// Rows of the image2d form hold 2^image_width_log2 texels: 4096, which every OpenCL 1.2 device with images allows.
constexpr unsigned image_width_log2 = 12;

std::string build_options(const TraversalVariant& variant);
std::string build_options(const TraversalVariant& variant, const SceneFeatures& features);

} // namespace pointgi
