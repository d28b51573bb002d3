#pragma once
#include <string>

namespace pointgi {

/// A file of the sources that the build put into the binary (scripts/cmake/embed_files.cmake): its name below the
/// folder that it was taken from ("lib/rng.cl") and its text.
struct EmbeddedFile {
  std::string name;
  std::string text;
};

} // namespace pointgi
