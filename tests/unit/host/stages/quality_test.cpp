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
  CHECK(with("draft", 1, 0.5).radiosity.epsilon == 1.0);
}
