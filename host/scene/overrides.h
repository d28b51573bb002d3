#pragma once
#include <string>
#include <toml++/toml.h>
#include <vector>

namespace pointgi {

/// Puts "key.path=value" strings (--set) into a parsed scene, in order, later ones winning. Nothing is checked against
/// the schema here: the loader does that, and a wrong value is reported with the text of its --set as its place.
///
/// The path's parts are joined by dots; a part with a dot in it is quoted ("material.\"old.glass\".ior"). Tables that
/// are missing are made. An element of an array is named by its `name` key or its index from 0 ("material.glass.ior",
/// "light.0.power_w", "camera.position.1"). The value is TOML; what is no TOML value is taken as a text, so that
/// radiosity.method=direct needs no quotes.
/// Throws Error(usage) when there is no "=" or no path, when a value that opens a bracket or quote is broken, when an
/// element does not exist, or when the path leads into a value that holds no keys.
void apply_overrides(toml::table& scene, const std::vector<std::string>& overrides);

} // namespace pointgi
