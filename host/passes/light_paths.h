#pragma once
/// Which light paths the path tracer counts, in Heckbert's notation (method.md §1).
#include "shared/render_types.h"
#include <optional>
#include <string>

namespace pointgi {

/// As RenderParams takes them.
struct LightPaths {
  pg_uint classes = ALL_PATH_CLASSES;     ///< bit k: paths of k surface points; the last bit: as many or more
  pg_uint most_bounces = NO_BOUNCE_LIMIT; ///< surface points of a path at most
};

/// `list` is one class or several with commas between them: L, then letters each with or without "+" (one or more of
/// it), then E. "LE" is light seen directly, "LDE" direct light, "LDD+E" all light between surfaces, "LD+E" both.
/// An empty list means all paths. `max_depth`: of the scene, surface points of a path at most.
/// Throws Error(usage) for what is no class, for one with S (no specular material can be rendered yet) and for more
/// than 30 D in a class.
LightPaths light_paths(const std::string& list, const std::optional<int>& max_depth);

} // namespace pointgi
