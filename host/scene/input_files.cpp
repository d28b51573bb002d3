#include "host/scene/input_files.h"
#include "host/cloud/readers/mesh.h"

namespace pointgi {

std::vector<std::string> input_files(const Scene& scene) {
  std::vector<std::string> files;
  for (const CloudSettings& cloud : scene.clouds) {
    if (cloud.points) continue;
    files.push_back(cloud.file);
    const std::vector<std::string> parts = files_beside_mesh(cloud.file);
    files.insert(files.end(), parts.begin(), parts.end());
  }
  if (!scene.environment_file.empty()) files.push_back(scene.environment_file);
  return files;
}

} // namespace pointgi
