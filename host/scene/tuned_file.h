#pragma once
/// Settings of octree and traversal that were measured, in a file with the sections of a scene: kernels/tuned and what
/// `pointgi profile` stores.
#include "host/scene/scene.h"

namespace pointgi {

struct TunedFile {
  OctreeSettings octree; ///< max_depth and stepping are not tuned
  TraversalSettings traversal;
  // [profile]: whose they are; empty in kernels/tuned.
  std::string device, driver, version, date, scene;
  double rays_per_second = 0.0;
};

/// Throws Error(input), naming `file`, when the text is no such file or leaves a setting open. `file` outlives the
/// call.
TunedFile parse_tuned(const std::string& text, const std::string& file);

/// A text that parse_tuned reads; its [octree] and [traversal] can be pasted into a scene.
std::string tuned_text(const TunedFile& tuned);

} // namespace pointgi
