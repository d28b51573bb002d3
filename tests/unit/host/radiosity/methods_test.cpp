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

TEST_CASE("the loader takes every method and every key that a method reads, and nothing else") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("ball.toml", small_scene());
  for (const std::string& word : radiosity_method_words())
    CHECK(load_scene(scene, {"radiosity.method=" + word}).radiosity.method == word);
  for (const RadiosityWords& row : radiosity_words())
    for (const std::string key : row.keys) {
      CAPTURE(row.method, key);
      // One of these is a value of any key; a word is named where 5 is refused.
      std::vector<std::string> values{"0.125", "true", "64", "9", "5"};
      try {
        load_scene(scene, {"radiosity." + key + "=5"});
      } catch (const Error& error) {
        const std::string text = error.what();
        const std::size_t first = std::min(text.find('"'), text.size());
        values.push_back(text.substr(first, text.find('"', first + 1) + 1 - first));
      }
      CHECK(std::any_of(values.begin(), values.end(), [&](const std::string& value) {
        try {
          load_scene(scene, {"radiosity." + key + "=" + value});
          return true;
        } catch (const Error&) {
          return false;
        }
      }));
      CHECK_THROWS_AS(load_scene(scene, {"radiosity." + key + "=[]"}), Error); // it is read, not passed over
    }
  CHECK_THROWS_AS(load_scene(scene, {"radiosity.qqqq=1"}), Error);
}
