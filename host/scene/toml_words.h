#pragma once
/// TOML as error texts show it.
#include "host/scene/scene.h"
#include <string>
#include <toml++/toml.h>
#include <vector>

namespace pointgi {

/// Where a key or value stands. What came from the command line carries its own text as the path of its source
/// (overrides.cpp); what came from the file carries none and lies in `file`.
SourcePlace place_of(const toml::source_region& source, const std::string& file);

/// A value as a user would write it, shortened: `"many"`, `12`, `[0.5, 1.2, 0.5]`, `a table`.
std::string found_text(const toml::node& node);

/// The text with control characters as \xNN: it has words from a file, and terminals obey them.
std::string harmless(const std::string& text);

/// `"text"`, with control characters escaped and no more than 60 bytes of it.
std::string quoted(const std::string& text);

/// `"a", "b" or "c"`.
std::string any_of(const std::vector<std::string>& words);

/// `; did you mean "spp"?` where one of `known` is near `word`, else `; known <what>: a, b, c` (at most 20 of them).
std::string hint(const std::string& word, const std::vector<std::string>& known, const std::string& what);

} // namespace pointgi
