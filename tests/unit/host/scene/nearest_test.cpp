#include "host/scene/nearest.h"
#include <catch2/catch.hpp>

using pointgi::nearest;

TEST_CASE("nearest finds the word that was meant", "[scene]") {
  const std::vector<std::string> keys = {"size", "spp", "seed", "exposure", "max_depth", "jitter"};
  CHECK(nearest("sp", keys) == "spp");
  CHECK(nearest("ssp", keys) == "spp");
  CHECK(nearest("psp", keys) == "spp"); // a swap of neighbours is one edit
  CHECK(nearest("exposre", keys) == "exposure");
  CHECK(nearest("EXPOSURE", keys) == "exposure");
  CHECK(nearest("maxdepth", keys) == "max_depth");
  CHECK(nearest("spp", keys) == "spp");
}

TEST_CASE("nearest accepts the beginning of a word and its continuation", "[scene]") {
  CHECK(nearest("fov", {"position", "look_at", "fov_deg"}) == "fov_deg");
  CHECK(nearest("spacing_world_units", {"corner", "spacing"}) == "spacing");
  CHECK(nearest("center", {"normal", "centre", "radius"}) == "centre");
  // An edit distance within bounds goes before a continuation.
  CHECK(nearest("radiu", {"radiu_file_of_the_other", "radius"}) == "radius");
}

TEST_CASE("nearest says nothing where nothing is near", "[scene]") {
  CHECK(nearest("spp", {}).empty());
  CHECK(nearest("", {"spp", "seed"}).empty());
  CHECK(nearest("wavelength", {"spp", "seed"}).empty());
  CHECK(nearest("u", {"v", "w"}).empty()); // a single letter is one edit from every other
  CHECK(nearest("U", {"v", "u"}) == "u");
  CHECK(nearest(std::string(100000, 'a'), {std::string(100000, 'a')}).empty()); // bounded time
}

TEST_CASE("nearest takes the first of equals", "[scene]") {
  CHECK(nearest("cat", {"bat", "hat"}) == "bat");
  CHECK(nearest("cat", {"hat", "bat"}) == "hat");
}
