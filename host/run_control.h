#pragma once
/// What a caller has to do with work that takes long: end it, watch it, read what it says.
#include <functional>
#include <optional>
#include <string>

namespace pointgi {

enum class LogLevel { debug, info, warning };

/// How far a stage is. The first of a stage has neither `share` nor `done`: the stage begins.
struct StageProgress {
  std::string stage;           ///< "cloud", "octree", "vmap", "fmm", "photon", "render", ...
  std::optional<double> share; ///< of the stage, [0, 1]; absent where nobody knows how much there will be
  std::string done;            ///< what is done so far, "12 applies"; empty where `share` tells
};

/// Each may be empty. All are called on the thread that called the library, and often: they should return soon.
struct RunControl {
  /// Whether to end the work; asked between the stages, before every launch of the device and within the host's long
  /// loops. Work that is ended throws Error(interrupted), "interrupted in the stage ...".
  std::function<bool()> stop = {};
  std::function<void(const StageProgress&)> progress = {};
  std::function<void(LogLevel, const std::string& text)> log = {}; ///< a line without its line end
};

} // namespace pointgi
