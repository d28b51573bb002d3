#pragma once
#include <string>
#include <vector>

namespace pointgi {

/// The entry of `known` that `word` was probably meant to be: by edit distance (insertions, deletions, substitutions
/// and swaps of neighbours cost 1, upper and lower case are the same), at most a third of the longer word; or the
/// entry that continues `word` or is continued by it ("fov" -> "fov_deg"). Of equals the first. Empty if nothing is
/// near.
std::string nearest(const std::string& word, const std::vector<std::string>& known);

} // namespace pointgi
