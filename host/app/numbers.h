#pragma once
/// Numbers that options hold several of.
#include <string>
#include <utility>
#include <vector>

namespace pointgi {

/// Exactly `count` whole numbers of at most nine digits, separated by `separator`. Throws Error(usage): `form`, which
/// shows how it is written, and what was found.
std::vector<int> whole_numbers(const std::string& text, char separator, std::size_t count, const std::string& form);

/// --size: WIDTHxHEIGHT of at least `least` pixels each, and at most limits::image_side. Throws Error(usage).
std::pair<int, int> size_of(const std::string& text, int least);

} // namespace pointgi
