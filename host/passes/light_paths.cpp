#include "host/passes/light_paths.h"
#include "host/error.h"
#include <algorithm>

namespace pointgi {

namespace {

[[noreturn]] void refuse(const std::string& word, const std::string& what) {
  throw Error(ExitCode::usage, "--paths: \"" + word + "\": " + what);
}

/// Bit k where the class holds paths of k surface points.
pg_uint bits_of(const std::string& word) {
  if (word.size() < 2 || word.front() != 'L' || word.back() != 'E')
    refuse(word, "expected a class of light paths from L to E, for example LE, LDE, LDD+E or LD+E");
  unsigned surfaces = 0;
  bool more = false;
  for (std::size_t i = 1; i + 1 < word.size(); ++i) {
    const char letter = word[i];
    if (letter == 'S')
      refuse(word, "no material of this version is specular, so no path has an S; expected D between L and E");
    if (letter == '+' && word[i - 1] == 'D')
      more = true;
    else if (letter == 'D')
      surfaces += 1;
    else
      refuse(word, std::string("expected D or D+ between L and E, found \"") + letter + "\"");
  }
  if (surfaces >= LAST_PATH_CLASS)
    refuse(word, "expected at most " + std::to_string(LAST_PATH_CLASS - 1) + " D, found " + std::to_string(surfaces));
  return more ? ALL_PATH_CLASSES << surfaces : 1u << surfaces;
}

/// Surface points of the longest path among them.
pg_uint longest(pg_uint classes) {
  if ((classes >> LAST_PATH_CLASS) != 0u) return NO_BOUNCE_LIMIT;
  pg_uint most = 0;
  while (most + 1 < LAST_PATH_CLASS && (classes >> (most + 1)) != 0u)
    ++most;
  return most;
}

} // namespace

LightPaths light_paths(const std::string& list, const std::optional<int>& max_depth) {
  LightPaths paths;
  if (!list.empty()) {
    paths.classes = 0;
    for (std::size_t at = 0; at <= list.size();) {
      const std::size_t end = std::min(list.find(',', at), list.size());
      paths.classes |= bits_of(list.substr(at, end - at));
      at = end + 1;
    }
    paths.most_bounces = longest(paths.classes);
  }
  if (max_depth) paths.most_bounces = std::min(paths.most_bounces, static_cast<pg_uint>(*max_depth));
  return paths;
}

} // namespace pointgi
