#include "host/render/light_paths.h"
#include "host/error.h"
#include <algorithm>
#include <map>
#include <set>
#include <vector>

namespace pointgi {

namespace {

constexpr std::size_t most_letters = 30;

[[noreturn]] void refuse(const std::string& word, const std::string& what) {
  throw Error(ErrorKind::usage, "--paths: \"" + word + "\": " + what);
}

/// A surface of a class: one, or any number.
struct Item {
  char letter; ///< 'D', 'S'
  bool any;    ///< any number of it, none too
};

/// The surfaces of one class, from the eye to the light; "D+" is D and D*.
std::vector<Item> items_of(const std::string& word) {
  if (word.size() < 2 || word.front() != 'L' || word.back() != 'E')
    refuse(word, "expected a class of light paths from L to E, for example LE, LDE, LDD+E, LD+S*E or LS+DE");
  std::vector<Item> items;
  std::size_t letters = 0;
  for (std::size_t i = 1; i + 1 < word.size(); ++i) {
    const char letter = word[i];
    const bool repeats = letter == '+' || letter == '*';
    if (letter == 'D' || letter == 'S') {
      items.push_back({letter, false});
      letters += 1;
    } else if (repeats && (word[i - 1] == 'D' || word[i - 1] == 'S')) {
      if (letter == '*') items.pop_back();
      items.push_back({word[i - 1], true});
    } else {
      refuse(word, std::string("expected D or S, each with + or * behind it or without, between L and E, found \"") +
                       letter + "\"");
    }
  }
  if (letters > most_letters)
    refuse(word, "expected at most " + std::to_string(most_letters) + " D and S, found " + std::to_string(letters));
  std::reverse(items.begin(), items.end());
  return items;
}

using Classes = std::vector<std::vector<Item>>;
/// (class, number of its items that are behind): where a path may stand.
using Places = std::set<std::pair<std::size_t, std::size_t>>;

/// Adds the places that are reached by taking none of what may be left out.
Places closed(const Classes& classes, Places places) {
  std::vector<std::pair<std::size_t, std::size_t>> waiting(places.begin(), places.end());
  while (!waiting.empty()) {
    auto [of, at] = waiting.back();
    waiting.pop_back();
    if (at < classes[of].size() && classes[of][at].any && places.insert({of, at + 1}).second)
      waiting.push_back({of, at + 1});
  }
  return places;
}

Places after(const Classes& classes, const Places& places, char letter) {
  Places next;
  for (const auto& [of, at] : places)
    if (at < classes[of].size() && classes[of][at].letter == letter)
      next.insert({of, classes[of][at].any ? at : at + 1});
  return closed(classes, next);
}

/// The automaton of sets of places (the subset construction). Throws Error(usage) when it is too large.
std::vector<pg_uint> automaton(const Classes& classes, const std::string& list) {
  Places start;
  for (std::size_t i = 0; i < classes.size(); ++i)
    start.insert({i, 0});
  std::map<Places, pg_uint> numbers;
  std::vector<Places> found;
  const auto number_of = [&](const Places& places) {
    const auto [at, is_new] = numbers.emplace(places, static_cast<pg_uint>(found.size()));
    if (is_new) found.push_back(places);
    return at->second;
  };
  number_of(closed(classes, start));
  std::vector<pg_uint> states;
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (found.size() > PATH_STATES) refuse(list, "too many classes at once; name fewer or simpler ones");
    const Places places = found[k];
    pg_uint state = number_of(after(classes, places, 'D'));
    state |= number_of(after(classes, places, 'S')) << 8;
    for (const auto& [of, at] : places)
      if (at == classes[of].size()) state |= PATH_COUNTS;
    states.push_back(state);
  }
  return states;
}

/// Marks the states from which a longer path counts.
void mark_goes_on(std::vector<pg_uint>& states) {
  const auto leads_on = [&](pg_uint next) { return (states[next] & (PATH_COUNTS | PATH_GOES_ON)) != 0; };
  for (bool changed = true; changed;) {
    changed = false;
    for (pg_uint& state : states)
      if ((state & PATH_GOES_ON) == 0 && (leads_on(PATH_AFTER_D(state)) || leads_on(PATH_AFTER_S(state)))) {
        state |= PATH_GOES_ON;
        changed = true;
      }
  }
}

/// Surface points of the longest path that counts: no path without a loop visits more states than there are.
pg_uint longest(const std::vector<pg_uint>& states) {
  std::set<pg_uint> reached{0};
  for (pg_uint surfaces = 0; surfaces <= states.size(); ++surfaces) {
    std::set<pg_uint> next;
    for (const pg_uint state : reached)
      if ((states[state] & PATH_GOES_ON) != 0) {
        next.insert(PATH_AFTER_D(states[state]));
        next.insert(PATH_AFTER_S(states[state]));
      }
    if (next.empty()) return surfaces;
    reached = next;
  }
  return NO_BOUNCE_LIMIT;
}

} // namespace

bool LightPaths::counts(const std::string& surfaces) const {
  pg_uint state = 0;
  for (std::size_t i = surfaces.size(); i-- > 0;)
    state = surfaces[i] == 'D' ? PATH_AFTER_D(states[state]) : PATH_AFTER_S(states[state]);
  return all || (states[state] & PATH_COUNTS) != 0;
}

LightPaths light_paths(const std::string& list, const std::optional<int>& max_depth) {
  LightPaths paths;
  paths.states.fill(PATH_COUNTS | PATH_GOES_ON); // state 0 for ever
  if (!list.empty()) {
    Classes classes;
    for (std::size_t at = 0; at <= list.size();) {
      const std::size_t end = std::min(list.find(',', at), list.size());
      classes.push_back(items_of(list.substr(at, end - at)));
      at = end + 1;
    }
    std::vector<pg_uint> states = automaton(classes, list);
    mark_goes_on(states);
    paths.most_bounces = longest(states);
    paths.all = std::all_of(states.begin(), states.end(), [](pg_uint s) { return (s & PATH_COUNTS) != 0; });
    std::copy(states.begin(), states.end(), paths.states.begin());
  }
  if (max_depth) paths.most_bounces = std::min(paths.most_bounces, static_cast<pg_uint>(*max_depth));
  return paths;
}

namespace {

/// Whether some path that counts goes over surfaces of the scene to a light that its last surface, or the eye, meets.
bool some_path(const LightPaths& paths, const PathSupply& scene) {
  const auto counts = [&](pg_uint state) { return (paths.states[state] & PATH_COUNTS) != 0; };
  if (scene.area_lights && counts(0)) return true;
  std::set<pg_uint> reached{0};
  // After as many surfaces as there are states, all that can be reached have been.
  for (pg_uint surfaces = 1; surfaces <= std::min(paths.most_bounces, pg_uint{PATH_STATES}); ++surfaces) {
    std::set<pg_uint> next;
    for (const pg_uint state : reached) {
      if (scene.diffuse) next.insert(PATH_AFTER_D(paths.states[state]));
      if (scene.specular) next.insert(PATH_AFTER_S(paths.states[state]));
      if (scene.diffuse && counts(PATH_AFTER_D(paths.states[state]))) return true;
      if (scene.specular && (scene.area_lights || scene.lobes) && counts(PATH_AFTER_S(paths.states[state])))
        return true;
    }
    reached = next;
  }
  return false;
}

} // namespace

std::string why_no_path(const std::string& list, const std::optional<int>& max_depth, const PathSupply& scene) {
  const LightPaths all = light_paths(list, {}), paths = light_paths(list, max_depth);
  if (some_path(paths, scene) || !(scene.area_lights || scene.light_sources)) return {};
  if (some_path(all, scene))
    return "render.max_depth = " + std::to_string(*max_depth) +
           " leaves out paths of more surface points; make it larger, or leave it out";
  PathSupply more = scene;
  more.specular = more.lobes = true;
  if (!scene.specular && some_path(all, more))
    return "no surface of it is specular (S); give one a material of type mirror, conductor, glass or phong, or "
           "name other classes";
  more = scene;
  more.area_lights = true;
  if (some_path(all, more))
    return "its [[light]]s are not seen, neither by the eye nor by way of mirrors and glass; use an "
           "emitting surface or an environment";
  more = scene;
  more.diffuse = true;
  if (some_path(all, more))
    return "no surface of it is diffuse (D) with an albedo above 0; give one such a material, or name other classes";
  return "it lacks surfaces or lights for them; name other classes";
}

} // namespace pointgi
