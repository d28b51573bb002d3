#pragma once
/// Which light paths the path tracer counts, in Heckbert's notation (method.md §1).
#include "shared/render_types.h"
#include <array>
#include <optional>
#include <string>

namespace pointgi {

/// As RenderParams takes them.
struct LightPaths {
  bool all = true;                         ///< every path counts; the states need not be asked
  std::array<pg_uint, PATH_STATES> states; ///< the automaton (shared/render_types.h); reads from the eye on
  pg_uint most_bounces = NO_BOUNCE_LIMIT;  ///< surface points of a path at most

  /// Whether paths of these surfaces count: D and S, from the light to the eye.
  bool counts(const std::string& surfaces) const;
};

/// `list` is one class or several with commas between them: L, then the letters D (diffuse surface) and S (specular:
/// mirror, glass, or by the lobe of a Phong surface), each with or without "+" (one or more of it) or "*" (any number,
/// none too), then E. "LE" is light seen directly, "LDE" direct light, "LDD+E" all light between diffuse surfaces,
/// "LD+S*E" all that the eye sees of these, directly or by way of specular surfaces, "LS+DE" caustics. An empty list
/// means all paths. `max_depth`: of the scene, surface points of a path at most. Throws Error(usage) for what is no
/// class, for more than 30 letters in one, and for classes that together are more than the automaton can hold.
LightPaths light_paths(const std::string& list, const std::optional<int>& max_depth);

/// What a scene can make light paths of. One of the two kinds of light is there.
struct PathSupply {
  bool diffuse = false;       ///< some surface reflects light diffusely
  bool specular = false;      ///< a mirror, glass or a Phong lobe is there
  bool lobes = false;         ///< a Phong lobe is: it shows point and directional lights, too
  bool area_lights = false;   ///< surfaces shine, or the environment does: the eye sees them, also in mirrors
  bool light_sources = false; ///< point and directional lights: only D and lobes show them
};

/// Why no path of `list` with at most `max_depth` surface points, as light_paths() takes them, can be in such a scene,
/// and what to change; empty where some can.
std::string why_no_path(const std::string& list, const std::optional<int>& max_depth, const PathSupply& scene);

} // namespace pointgi
