/// The registry of radiosity methods against the words of the scene file and the folders of kernels.
#include "host/error.h"
#include "host/radiosity/method.h"
#include "host/scene/load_scene.h"
#include "tests/support/run_program.h"
#include <catch2/catch.hpp>
#include <filesystem>
#include <map>

using namespace pointgi;
using namespace pointgi::test;

TEST_CASE("every radiosity method is a word of the scene file, a folder of kernels, and can be found by its name") {
  std::vector<std::string> methods, words;
  for (const RadiosityMethod* method : radiosity_methods()) {
    methods.emplace_back(method->name);
    CAPTURE(methods.back());
    CHECK(radiosity_method(method->name) == method);
    CHECK(std::filesystem::is_directory(std::string(POINTGI_SOURCE_DIR "/kernels/radiosity/") + method->name));
    CHECK(method->prepare != nullptr);
  }
  for (const RadiosityWords& row : radiosity_words())
    words.emplace_back(row.method);
  CHECK(words == methods);
  CHECK(RadiositySettings().method == radiosity_method_words().front());
  for (const char* none : {"auto", "none", "", "progressive"})
    CHECK(radiosity_method(none) == nullptr);
}

namespace {

/// A value of a key that is not the default, as a scene file has it, and whether the settings hold it.
struct KeyValue {
  const char* text;
  bool (*is_set)(const RadiositySettings&);
};

const std::map<std::string, KeyValue>& key_values() {
  using S = const RadiositySettings&;
  static const std::map<std::string, KeyValue> all{
      {"order", {"4", [](S s) { return s.order == 4; }}},
      {"vmap_samples", {"5", [](S s) { return s.vmap_samples == 5; }}},
      {"point_samples", {"64", [](S s) { return s.point_samples == 64; }}},
      {"vmap_rays", {"123456789012", [](S s) { return s.vmap_rays == 123456789012; }}},
      {"epsilon", {"0.125", [](S s) { return s.epsilon == 0.125; }}},
      {"tolerance", {"0.0625", [](S s) { return s.tolerance == 0.0625; }}},
      {"vmap", {"\"thesis\"", [](S s) { return s.vmap == "thesis"; }}},
      {"directions", {"96", [](S s) { return s.directions == 96; }}},
      {"share", {"false", [](S s) { return !s.share; }}},
      {"direction_set", {"\"hemicube\"", [](S s) { return s.direction_set == "hemicube"; }}},
      {"sampling", {"\"mipmap\"", [](S s) { return s.sampling == "mipmap"; }}},
      {"window", {"9", [](S s) { return s.window == 9; }}},
      {"reciprocity", {"false", [](S s) { return s.reciprocity == false; }}},
      {"visibility_cache", {"false", [](S s) { return s.visibility_cache == false; }}},
      {"visibility", {"\"voxels\"", [](S s) { return s.visibility == "voxels"; }}},
      {"voxels", {"128", [](S s) { return s.voxels == 128; }}},
      {"passes", {"7", [](S s) { return s.passes == 7; }}},
      {"cones", {"16", [](S s) { return s.cones == 16; }}},
      {"anisotropic", {"false", [](S s) { return !s.anisotropic; }}},
      {"at", {"\"pixels\"", [](S s) { return s.at == "pixels"; }}},
  };
  return all;
}

} // namespace

TEST_CASE("the loader takes every method and every key that a method reads, and nothing else") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("ball.toml", small_scene());
  for (const std::string& word : radiosity_method_words())
    CHECK(load_scene(scene, {"radiosity.method=" + word}).radiosity.method == word);
  for (const std::string& key : radiosity_method_keys()) {
    CAPTURE(key);
    REQUIRE(key_values().count(key) == 1);
    const KeyValue& value = key_values().at(key);
    CHECK_FALSE(value.is_set(load_scene(scene, {}).radiosity));
    CHECK(value.is_set(load_scene(scene, {"radiosity." + key + "=" + value.text}).radiosity));
    CHECK_THROWS_AS(load_scene(scene, {"radiosity." + key + "=[]"}), Error);
  }
  CHECK(key_values().size() == radiosity_method_keys().size());
  CHECK_THROWS_AS(load_scene(scene, {"radiosity.qqqq=1"}), Error);
}

TEST_CASE("the loader notes keys that the method does not read, and which method a key has chosen") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("ball.toml", small_scene());
  const auto loaded = [&](std::vector<std::string> overrides) { return load_scene(scene, overrides).radiosity; };
  CHECK(loaded({"radiosity.method=fmm", "radiosity.epsilon=0.01", "radiosity.tolerance=0.01"}).notes.empty());
  CHECK(loaded({"radiosity.method=auto", "radiosity.epsilon=0.01", "radiosity.directions=64"}).notes.empty());
  CHECK(loaded({"radiosity.method=cones", "radiosity.epsilon=0.01"}).notes ==
        std::vector<std::string>{"radiosity.epsilon is not read by method \"cones\"; it is of \"fmm\""});
  CHECK(loaded({"radiosity.method=none", "radiosity.voxels=32"}).notes ==
        std::vector<std::string>{"radiosity.voxels is not read by method \"none\"; it is of \"gather\", \"cones\""});
  CHECK(loaded({"radiosity.directions=64"}).notes ==
        std::vector<std::string>{"radiosity.method is \"directions\", which alone reads some of the given keys"});
  // Windows: "all", the default, has none.
  CHECK(loaded({"radiosity.method=gather"}).sampling == "all");
  const RadiositySettings windows = loaded({"radiosity.method=gather", "radiosity.window=64"});
  CHECK(windows.sampling == "mipmap");
  CHECK(windows.notes.empty());
  const RadiositySettings all =
      loaded({"radiosity.method=gather", "radiosity.window=64", "radiosity.sampling=\"all\""});
  CHECK(all.sampling == "all");
  CHECK(all.notes == std::vector<std::string>{"radiosity.window is not read with radiosity.sampling = \"all\""});
}
