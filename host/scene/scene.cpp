#include "host/scene/scene.h"

namespace pointgi {

std::string SourcePlace::text() const {
  if (line == 0) return file.empty() ? "(default)" : file;
  return file + ":" + std::to_string(line) + ":" + std::to_string(column);
}

const char* name_of(MaterialType type) {
  switch (type) {
  case MaterialType::diffuse:
    return "diffuse";
  case MaterialType::mirror:
    return "mirror";
  case MaterialType::glass:
    return "glass";
  case MaterialType::phong:
    return "phong";
  }
  return "unknown";
}

} // namespace pointgi
