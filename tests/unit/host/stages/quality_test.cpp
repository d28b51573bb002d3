#include "host/scene/limits.h"
#include "host/stages/prepared_scene.h"
#include <catch2/catch.hpp>

using namespace pointgi;

TEST_CASE("quality changes noise and error together, but no number of samples that the command gave") {
  const auto with = [](const std::string& quality, int spp, double epsilon, bool samples_given = false) {
    Scene scene;
    scene.render.spp = spp;
    scene.radiosity.epsilon = epsilon;
    apply_quality(quality, scene, samples_given);
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
}

TEST_CASE("a draft's epsilon stays one that a scene may have, and is never finer than the scene's own") {
  const auto drafted = [](double epsilon) {
    Scene scene;
    scene.radiosity.epsilon = epsilon;
    apply_quality("draft", scene);
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
    apply_bake_quality(quality, scene);
    CHECK(scene.radiosity.light_samples == samples);
    Scene given;
    given.radiosity.light_samples = 7;
    apply_bake_quality(quality, given);
    CHECK(given.radiosity.light_samples == 7);
    CHECK(given.radiosity.epsilon == scene.radiosity.epsilon);
    Scene picture;
    apply_quality(quality, picture);
    CHECK_FALSE(picture.radiosity.light_samples);
  }
}
