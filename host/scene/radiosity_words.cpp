#include "host/scene/radiosity_words.h"
#include <algorithm>

namespace pointgi {

const std::vector<RadiosityWords>& radiosity_words() {
  static const std::vector<RadiosityWords> all{
      {"fmm", {"order", "vmap_samples", "point_samples", "vmap_rays", "epsilon", "tolerance", "vmap"}},
      {"directions", {"directions", "direction_set", "share", "tolerance"}},
      {"gather",
       {"sampling", "window", "reciprocity", "visibility_cache", "visibility", "voxels", "passes", "tolerance"}},
      {"cones", {"tolerance", "voxels", "cones", "anisotropic", "at"}},
      {"direct", {"tolerance"}},
  };
  return all;
}

std::vector<std::string> radiosity_method_words() {
  std::vector<std::string> words;
  for (const RadiosityWords& row : radiosity_words())
    words.emplace_back(row.method);
  words.insert(words.begin(), "auto");
  words.insert(words.begin() + 1, "none");
  return words;
}

bool is_of_one_method(const std::string& key) {
  std::size_t methods = 0;
  for (const RadiosityWords& row : radiosity_words())
    methods += static_cast<std::size_t>(std::count(row.keys.begin(), row.keys.end(), key));
  return methods == 1;
}

std::vector<std::string> radiosity_method_keys() {
  std::vector<std::string> keys;
  for (const RadiosityWords& row : radiosity_words())
    for (const char* key : row.keys)
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.emplace_back(key);
  return keys;
}

} // namespace pointgi
