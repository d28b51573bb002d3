/// Knobs are keys that scenes have, with values that scenes take.
#include "host/measure/finding.h"
#include "host/measure/knobs.h"
#include "host/measure/search.h"
#include "tests/unit/host/scene/scene_files.h"
#include <catch2/catch.hpp>
#include <set>

using namespace pointgi;
using Catch::Contains;

namespace {

/// With a mirror, under a sky: no knob is left out.
const std::string mirror_scene = std::string(test::small_scene) +
                                 "[environment]\nradiance = [1, 1, 1]\n"
                                 "[[material]]\nname = \"mirror\"\ntype = \"mirror\"\n"
                                 "[[shape]]\ntype = \"disc\"\ncentre = [0, 2, 0]\nnormal = [0, -1, 0]\n"
                                 "radius = 1\nspacing = 0.1\nmaterial = \"mirror\"\n";

const Knob& named(const std::vector<Knob>& knobs, const std::string& name) {
  for (const Knob& knob : knobs)
    if (knob.name == name) return knob;
  throw std::runtime_error("no knob " + name);
}

std::string error_of(const std::string& knob) {
  try {
    checked_knob(knob);
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::usage);
    return error.what();
  }
  return "(none)";
}

} // namespace

TEST_CASE("every value of every knob is one that a scene takes") {
  const test::SceneFolder folder;
  const std::string& text = mirror_scene;
  const Scene scene = folder.load(text);
  std::set<std::string> names;
  for (const std::string method : {"fmm", "directions"})
    for (const Knob& knob : knobs_of({scene, method, 1000})) {
      INFO(knob.key);
      names.insert(knob.name);
      CHECK(knob.left_out.empty());
      for (const KnobValue& value : knob.values) {
        INFO(value.text);
        CHECK_NOTHROW(folder.load(text, value.overrides));
        CHECK(folder.load(text, value.overrides).radiosity.notes.empty());
      }
    }
  CHECK(names.size() == knob_names().size());
}

TEST_CASE("the scene's own value is known") {
  const test::SceneFolder folder;
  const Scene scene = folder.load(mirror_scene, {"render.spp=8", "radiosity.method=fmm"});
  const std::vector<Knob> knobs = knobs_of({scene, "fmm", 1000});
  const auto own = [&](const char* name) {
    std::vector<std::string> values;
    for (const KnobValue& value : named(knobs, name).values)
      if (value.own) values.push_back(value.text);
    return values;
  };
  CHECK(own("spp") == std::vector<std::string>{"8"});
  CHECK(own("method") == std::vector<std::string>{"fmm"});
  CHECK(own("epsilon") == std::vector<std::string>{"0.005"});
  CHECK(own("directions").empty()); // another method's
}

TEST_CASE("the scene's own value stands among the others, in its place") {
  const test::SceneFolder folder;
  const auto values = [&](const char* name, const std::vector<std::string>& overrides) {
    const Scene scene = folder.load(mirror_scene, overrides);
    const std::vector<Knob> knobs = knobs_of({scene, "gather", 1000}); // as "auto" might have chosen
    std::string text;
    for (const KnobValue& value : named(knobs, name).values)
      text += value.text + (value.own ? "! " : value.in_scene ? "? " : " ");
    return text;
  };
  CHECK(values("spp", {"render.spp=20"}) == "2 8 20! 32 128 ");
  CHECK(values("spp", {"render.spp=32"}) == "2 8 32! 128 ");
  CHECK(values("photons", {"caustics.photons=5000000"}) == "25000 100000 400000 1600000 5000000! ");
  CHECK(values("tolerance", {"radiosity.tolerance=0.05"}) == "0.1 0.05! 0.01 0.001 0.0001 "); // falls
  CHECK(values("directions", {"radiosity.directions=100"}) == "32 128 512 2048 ");            // is not read
  // "auto" takes time to choose: the same light is another setting.
  const std::vector<std::string> automatic{"radiosity.method=auto", "radiosity.sampling=mipmap",
                                           "radiosity.window=100"};
  CHECK(values("method", automatic) == "none cones fmm directions gather? ");
  CHECK(values("window", automatic) == "1024 256 100? 64 ");
}

TEST_CASE("knobs that a scene does not need are left out with a reason") {
  const test::SceneFolder folder;
  const Scene plain = folder.load(test::small_scene);
  const std::vector<Knob> knobs = knobs_of({plain, "none", 1000});
  CHECK_THAT(named(knobs, "photons").left_out, Contains("specular"));
  CHECK_THAT(named(knobs, "directions").left_out, Contains("no light is exchanged"));
  CHECK_THAT(named(knobs, "light_samples").left_out, Contains("exactly"));
  CHECK(named(knobs, "spp").left_out.empty());
  CHECK_THAT(finding_of({}, named(knobs, "photons"), {}, {}), Contains("specular"));
}

TEST_CASE("all pairs of points are not asked for where they are too many") {
  const test::SceneFolder folder;
  const Scene scene = folder.load(test::small_scene);
  const auto last = [&](std::size_t points) {
    return named(knobs_of({scene, "fmm", points}), "sampling").values.back().text;
  };
  CHECK(last(10'000) == "all");
  CHECK(last(100'000) == "adaptive");
}

TEST_CASE("a knob that is not there is answered with the nearest and with all") {
  CHECK(checked_knob("radiosity.directions") == "directions");
  CHECK(checked_knob("directions") == "directions");
  CHECK_THAT(error_of("direction"), Contains("did you mean \"directions\"") && Contains("spp, method"));
  CHECK_THAT(error_of("zzz"), Contains("the knobs are: quality, spp"));
}
