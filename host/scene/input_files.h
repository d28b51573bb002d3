#pragma once
#include "host/scene/scene.h"
#include <string>
#include <vector>

namespace pointgi {

/// The files that the scene names: of its clouds that are not in memory, with what lies beside a mesh and may belong to
/// it, and of its environment. The scene file itself is not among them.
std::vector<std::string> input_files(const Scene& scene);

} // namespace pointgi
