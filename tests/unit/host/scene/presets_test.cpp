#include "host/scene/limits.h"
#include "host/scene/presets.h"
#include <catch2/catch.hpp>
#include <set>

using namespace pointgi;

TEST_CASE("quality changes noise and error together, but no number of samples that the command gave") {
  const auto with = [](const std::string& quality, int spp, double epsilon, bool samples_given = false) {
    Scene scene;
    scene.render.spp = spp;
    scene.radiosity.epsilon = epsilon;
    apply_preset(preset_named(quality, "quality"), scene, samples_given);
    return scene;
  };
  CHECK(with("normal", 32, 4e-3).render.spp == 32);
  CHECK(with("normal", 32, 4e-3).radiosity.epsilon == 4e-3);
  CHECK(with("draft", 32, 4e-3).render.spp == 8);
  CHECK(with("draft", 32, 4e-3).radiosity.epsilon == 16e-3);
  CHECK(with("high", 32, 4e-3).render.spp == 128);
  CHECK(with("high", 32, 4e-3).radiosity.epsilon == 2e-3);
  CHECK(with("high", 32, 4e-3, true).render.spp == 32);
  CHECK(with("high", 32, 4e-3, true).radiosity.epsilon == 2e-3);
  CHECK(with("draft", 1, 0.5).render.spp == 1);
  CHECK(with("final", 32, 4e-3).render.spp == 512);
  CHECK(with("final", 32, 4e-3).radiosity.epsilon == 1e-3);
  CHECK(with("final", 65536, 4e-3).render.spp == 65536);
}

TEST_CASE("a draft's epsilon stays one that a scene may have, and is never finer than the scene's own") {
  const auto drafted = [](double epsilon) {
    Scene scene;
    scene.radiosity.epsilon = epsilon;
    apply_preset(preset_named("draft", "quality"), scene);
    return scene.radiosity.epsilon;
  };
  CHECK(drafted(0.02) == 0.08);
  CHECK(drafted(0.03) == limits::coarsest_draft_epsilon);
  for (const double own : {0.1, 0.5, 0.999})
    CHECK(drafted(own) == own);
}

TEST_CASE("a lit cloud has as many light samples as its quality, unless the scene says how many") {
  for (const auto& [quality, samples] :
       {std::make_pair("draft", 16), std::make_pair("normal", 64), std::make_pair("high", 256)}) {
    Scene scene;
    apply_bake_preset(preset_named(quality, "quality"), scene);
    CHECK(scene.radiosity.light_samples == samples);
    Scene given;
    given.radiosity.light_samples = 7;
    apply_bake_preset(preset_named(quality, "quality"), given);
    CHECK(given.radiosity.light_samples == 7);
    CHECK(given.radiosity.epsilon == scene.radiosity.epsilon);
    Scene picture;
    apply_preset(preset_named(quality, "quality"), picture);
    CHECK_FALSE(picture.radiosity.light_samples);
  }
}

TEST_CASE("presets go from the least accurate to the most, and promise so") {
  REQUIRE(preset_names() == std::vector<std::string>{"draft", "normal", "high", "final"});
  for (std::size_t i = 1; i < presets().size(); ++i) {
    CHECK(presets()[i].error < presets()[i - 1].error);
    CHECK(presets()[i].samples > presets()[i - 1].samples);
    CHECK(presets()[i].epsilon < presets()[i - 1].epsilon);
    CHECK(presets()[i].directions > presets()[i - 1].directions);
  }
  CHECK(promised_error(presets()[3], "room") == presets()[3].error);
  CHECK(promised_error(presets()[3], "foliage") > presets()[3].error);
  CHECK(promised_error(presets()[0], "foliage") == presets()[0].error);
  CHECK_THROWS_WITH(preset_named("best", "--quality"),
                    "--quality: expected \"draft\", \"normal\", \"high\" or \"final\", found \"best\"");
}

TEST_CASE("what a preset changes can be given by --set") {
  Scene scene;
  scene.render.spp = 32;
  scene.radiosity.epsilon = 4e-3;
  scene.radiosity.directions = 512;
  CHECK(preset_overrides(preset_named("normal", ""), scene).empty());
  CHECK(preset_overrides(preset_named("high", ""), scene) ==
        std::vector<std::string>{"radiosity.method=auto", "render.spp=128", "radiosity.directions=1024",
                                 "radiosity.epsilon=0.002"});
  scene.radiosity.method = "fmm";
  CHECK(preset_overrides(preset_named("high", ""), scene) ==
        std::vector<std::string>{"render.spp=128", "radiosity.epsilon=0.002"});
}

TEST_CASE("measured presets keep what they promise, each more accurate than the cheaper one") {
  std::set<std::string> chosen_by, kinds, tested_by;
  std::map<std::string, double> error_before;
  for (const Preset& preset : presets())
    for (const PresetMeasurement& m : preset_measurements()) {
      if (m.preset != preset.name) continue;
      INFO(m.preset << " " << m.scene);
      (m.chosen_by ? chosen_by : tested_by).insert(m.scene);
      if (m.chosen_by) kinds.insert(m.kind);
      CHECK(m.error <= promised_error(preset, m.kind));
      if (error_before.count(m.scene) == 1) CHECK(m.error < error_before[m.scene]);
      error_before[m.scene] = m.error;
    }
  CHECK(chosen_by.size() >= 6);
  CHECK(kinds == std::set<std::string>{"foliage", "glass and mirror", "interior", "room", "statue", "terrain"});
  CHECK(tested_by.size() >= 8);
}
