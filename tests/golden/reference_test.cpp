/// docs/reference.md names every key that a scene file may have and every field that --stats writes.
#include "host/error.h"
#include "host/lights/light_kind.h"
#include "host/materials/material_kind.h"
#include "host/scene/load_scene.h"
#include "tests/support/fake_oidn.h"
#include "tests/support/run_program.h"
#include "tests/support/stats_file.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;
using Catch::Contains;

namespace {

std::string reference() {
  std::ifstream file(POINTGI_SOURCE_DIR "/docs/reference.md");
  return std::string(std::istreambuf_iterator<char>(file), {});
}

/// The keys that the loader lists when it is given one that nobody knows in this section.
std::vector<std::string> keys_of(const std::string& scene, const std::string& section) {
  std::string message;
  try {
    load_scene(scene, {section + ".qqqqqqqqqqqqqqqq=1"});
  } catch (const Error& error) {
    message = error.what();
  }
  const std::string before = "known keys: ";
  const std::size_t at = message.find(before);
  std::vector<std::string> keys;
  if (at == std::string::npos) return keys;
  std::istringstream list(message.substr(at + before.size()));
  for (std::string key; std::getline(list >> std::ws, key, ',');)
    keys.push_back(key);
  return keys;
}

} // namespace

TEST_CASE("the reference names every key of a scene file") {
  const TemporaryFolder folder;
  const std::string text = reference();
  folder.write("points.ply", "ply");
  std::string head = "version = 1\n[environment]\nradiance = [1, 1, 1]\n"
                     "[camera]\nposition = [0, 0, 3]\nlook_at = [0, 0, 0]\n"
                     "[[cloud]]\nfile = \"points.ply\"\nmaterial = \"phong\"\n";
  std::vector<std::string> materials;
  for (const MaterialType type : material_types())
    materials.push_back(name_of(type));
  for (const std::string& type : materials)
    head += "[[material]]\nname = \"" + type + "\"\ntype = \"" + type + "\"\n" +
            (type == "conductor" ? "metal = \"gold\"\n" : "");
  for (const char* section : {"render", "camera", "radiosity", "caustics", "octree", "traversal", "environment"}) {
    const std::vector<std::string> keys = keys_of(folder.write("s.toml", head), section);
    CAPTURE(section);
    CHECK(!keys.empty());
    for (const std::string& key : keys)
      CHECK_THAT(text, Contains("`" + std::string(section) + "." + key + "`"));
  }
  struct Repeated {
    std::string section, before;
  };
  // Shapes and lights lack what they must have, but a key that nobody knows is refused first.
  std::vector<Repeated> repeated{{"cloud.0", head}};
  for (const std::string& material : materials)
    repeated.push_back({"material." + material, head});
  for (const char* type : {"quad", "disc", "sphere", "box", "cylinder"})
    repeated.push_back({"shape.0", head + "[[shape]]\ntype = \"" + type + "\"\n"});
  for (const LightType type : light_types())
    repeated.push_back({"light.0", head + "[[light]]\ntype = \"" + std::string(name_of(type)) + "\"\n"});
  for (const Repeated& r : repeated) {
    const std::vector<std::string> keys = keys_of(folder.write("s.toml", r.before), r.section);
    CAPTURE(r.section, r.before);
    CHECK(!keys.empty());
    for (const std::string& key : keys)
      CHECK_THAT(text, Contains("`" + key + "`"));
  }
}

TEST_CASE("the reference names every field of --stats") {
  const TemporaryFolder folder;
  const std::string text = reference(), scene = folder.write("mirror.toml", mirror_scene());
  const FakeOidn fake;
  const Run run = run_program("render " + scene + " --quiet --denoise --set caustics.photons=2000 -o " +
                              folder.file("x.exr") + " --stats " + folder.file("s.json"));
  REQUIRE(run.code == 0);
  const auto stats = json_of(folder.file("s.json"));
  CHECK(stats.count("photons") + stats.count("vmap") + stats.count("radiosity") == 3);
  for (const auto& [name, value] : stats.items()) {
    CHECK_THAT(text, Contains("`" + name + "`"));
    const auto& fields = value.is_array() ? value[0] : value;
    if (!fields.is_object() || name == "kernels" || name == "variant") continue; // by names that are not the program's
    for (const auto& [field, ignored] : fields.items())
      CHECK_THAT(text, Contains("`" + field + "`"));
  }
}
