#pragma once
/// Scene files for tests, in a folder of their own that goes with them.
#include "host/error.h"
#include "host/scene/load_scene.h"
#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>
#include <vector>

namespace pointgi::test {

class SceneFolder {
public:
  SceneFolder() {
    static int count = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("pointgi_scene_" + std::to_string(::getpid()) + "_" + std::to_string(count++));
    std::filesystem::create_directories(path_);
  }
  ~SceneFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  SceneFolder(const SceneFolder&) = delete;
  SceneFolder& operator=(const SceneFolder&) = delete;

  std::string file(const std::string& name) const { return (path_ / name).string(); }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(file(name), std::ios::binary) << text;
    return file(name);
  }

  /// Loads `text` as scene.toml of this folder.
  Scene load(const std::string& text, const std::vector<std::string>& overrides = {}) const {
    return load_scene(write("scene.toml", text), overrides);
  }

  /// The text of the Error that loading `text` ends with, without this folder's name; empty when it loads.
  std::string error(const std::string& text, const std::vector<std::string>& overrides = {}) const {
    try {
      load(text, overrides);
    } catch (const Error& failure) {
      return without_folder(failure.what());
    }
    return {};
  }

  std::string without_folder(std::string text) const {
    const std::string prefix = path_.string() + "/";
    for (auto at = text.find(prefix); at != std::string::npos; at = text.find(prefix))
      text.erase(at, prefix.size());
    return text;
  }

private:
  std::filesystem::path path_;
};

/// The least that loads: one quad under one light.
inline const char* const small_scene = R"(version = 1
[[material]]
name = "white"
type = "diffuse"
albedo = [0.73, 0.73, 0.73]
[[shape]]
type = "quad"
corner = [0, 0, 0]
edge_u = [0, 0, 1]
edge_v = [1, 0, 0]
spacing = 0.1
material = "white"
[[light]]
type = "point"
position = [0, 1, 0]
power_w = [1, 2, 3]
)";

} // namespace pointgi::test
