#pragma once
/// The choices that make a kernel variant, and the one place where -D options are composed.
#include <string>

namespace pointgi {

enum class PoolStorage { buffer, image1d_buffer, image2d };
enum class Stepping {
  exact,         ///< integer cells; the default
  absolute_delta ///< the thesis' absolute delta, for trade measurements (method.md §6)
};

struct TraversalVariant {
  PoolStorage storage = PoolStorage::buffer;
  Stepping stepping = Stepping::exact;
  unsigned axis_bits = 1;    ///< log2 N of the tree
  double step_delta = 0.05;  ///< world units; absolute_delta only
};

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
