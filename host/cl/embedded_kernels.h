#pragma once
#include <string>
#include <vector>

namespace pointgi {

/// A file of kernels/ as the build found it: name below kernels/ ("lib/rng.cl") and text.
struct EmbeddedFile {
  std::string name;
  std::string text;
};

/// Written at build time by scripts/cmake/embed_kernels.cmake.
const std::vector<EmbeddedFile>& embedded_kernels();

} // namespace pointgi
