#pragma once
/// What a command is about to write, judged before the work and not after it.
#include "host/scene/scene.h"
#include <string>
#include <vector>

namespace pointgi {

struct OutputFile {
  const char* option;      ///< that names it: "--stats"
  std::string file;        ///< empty: it is not asked for
  bool by_default = false; ///< the option was not given
};

/// Throws Error (usage) where a file is an input of `scene`, which is in the file `input`, or named by two options, and
/// Error (output) where one cannot be written.
void require_outputs(const std::string& input, const Scene& scene, const std::vector<OutputFile>& outputs);

} // namespace pointgi
