#pragma once
/// What trades speed for accuracy: keys of a scene file, each with values from cheap to dear.
#include "host/scene/scene.h"
#include <string>
#include <vector>

namespace pointgi {

inline constexpr char method_key[] = "radiosity.method", samples_key[] = "render.spp";

struct KnobValue {
  std::string text;                   ///< "64"
  std::vector<std::string> overrides; ///< {"radiosity.method=directions", "radiosity.directions=64"}
  bool own = false;                   ///< the scene has this value already, and all that goes with it
  bool in_scene = false;              ///< as `own`, but for a radiosity.method that "auto" has chosen
};

struct Knob {
  std::string name;   ///< the last part of its key, "directions": begins the names of its runs
  std::string key;    ///< "radiosity.directions"
  bool falls;         ///< theory says that the error falls from value to value, down to what other errors leave
  std::string theory; ///< why it does, or why it need not, in a sentence
  std::vector<KnobValue> values; ///< from cheap to dear
  std::string left_out = {};     ///< why the scene does not need it; empty: it does
  std::string method = {};       ///< radiosity.method that alone reads it; empty: any
  bool is_of_several_keys = false;
  bool of_exchange = false; ///< read only where light is exchanged between surfaces: not by radiosity.method "none"

  /// Whether other kernels have to be built for its values.
  bool is_of_program() const { return key.rfind("traversal.", 0) == 0 || key.rfind("octree.", 0) == 0; }
};

/// A scene as far as the choice of knobs depends on it.
struct KnobScene {
  const Scene& scene;     ///< as the overrides of all runs leave it
  std::string method;     ///< that solved its light after "auto" has chosen; "none": there was nothing to solve
  std::size_t points = 0; ///< of the octree
};

/// All knobs, in the order in which they are asked, each with its reason where the scene does not need it.
std::vector<Knob> knobs_of(const KnobScene& scene);

/// Whether a value is a number of 0 or more, as "0.001" or "1e+06".
bool is_number(const std::string& value);

/// Names and keys of all knobs, for errors and for help.
std::vector<std::string> knob_names();

/// "directions" for itself and for "radiosity.directions". Throws Error(usage) that names the nearest knob or all of
/// them.
std::string checked_knob(const std::string& name_or_key);

} // namespace pointgi
