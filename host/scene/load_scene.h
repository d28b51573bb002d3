#pragma once
#include "host/scene/scene.h"
#include <string>
#include <vector>

namespace pointgi {

/// Reads a scene file (TOML, version = 1). `overrides` are "key.path=value" strings ("render.spp=64",
/// "material.glass.ior=1.3": tables of an array are found by their name or index) applied before checking.
/// Throws Error(input): "file:line:column: key: expected ..., found ...; did you mean ...?".
/// Everything that can be checked without opening another file but the clouds' existence is checked here.
Scene load_scene(const std::string& path, const std::vector<std::string>& overrides = {});

/// A scene around one cloud or mesh, so that a first picture needs no scene file: one diffuse material, "points", that
/// takes the points' colours, and the schema's defaults. Overrides work as in a scene file ("cloud.0.normals=flip").
/// Camera and light are still to be chosen where the overrides give none. Throws Error(input).
Scene load_bare_cloud(const std::string& path, const std::vector<std::string>& overrides = {});

} // namespace pointgi
