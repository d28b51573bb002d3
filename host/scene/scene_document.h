#pragma once
/// A scene as TOML on its way to a Scene: read from a file or a text, made around a cloud, or built key by key.
#include "host/cloud/point_cloud.h"
#include "host/scene/scene.h"
#include <map>
#include <memory>
#include <string>
#include <toml++/toml.h>

namespace pointgi {

/// By the name that a [[cloud]] has for its `file`.
using CloudsInMemory = std::map<std::string, std::shared_ptr<const PointCloud>>;

struct SceneDocument {
  toml::table table;
  std::string name;         ///< errors begin with it: the file's name
  std::string scene_file;   ///< clouds are relative to its folder and cannot be it; may not exist
  CloudsInMemory in_memory; ///< clouds that are in no file
  bool bare = false;        ///< made around a cloud, whose file is `name`: whoever prepares it chooses a light
};

/// Reads a scene file (TOML). Throws Error(input).
SceneDocument document_of_file(const std::string& path);

/// The same of a text that is in no file: `name` stands for the file in errors; clouds are relative to `folder`.
SceneDocument document_of_text(const std::string& text, const std::string& name, const std::string& folder);

/// A scene around one cloud or mesh (host/scene/load_scene.h: load_bare_cloud).
SceneDocument document_of_cloud(const std::string& path);

/// Checks all that the document says. Throws Error(input).
Scene scene_of(const SceneDocument& document);

} // namespace pointgi
