/// Settings where one knob changes.
#include "host/measure/moves.h"
#include <catch2/catch.hpp>

using namespace pointgi;

namespace {

/// As host/measure/knobs.cpp makes them of a scene with 512 directions whose method is "auto".
std::vector<Knob> knobs() {
  Knob spp{"spp", "render.spp", true, "", {{"2", {"render.spp=2"}}, {"32", {"render.spp=32"}, true, true}}};
  Knob method{"method", "radiosity.method", false, "", {}};
  for (const char* text : {"none", "fmm", "directions"})
    method.values.push_back({text, {std::string("radiosity.method=") + text}});
  Knob directions{"directions", "radiosity.directions", true, "", {}, "", "directions"};
  for (const char* text : {"32", "512"})
    directions.values.push_back({text, {"radiosity.method=directions", std::string("radiosity.directions=") + text}});
  Knob epsilon{"epsilon", "radiosity.epsilon", true, "", {}, "", "fmm"};
  epsilon.values.push_back({"0.08", {"radiosity.method=fmm", "radiosity.epsilon=0.08"}});
  Knob photons{"photons",
               "caustics.photons",
               true,
               "",
               {{"1000", {"caustics.photons=1000"}}, {"9000", {"caustics.photons=9000"}, true, true}}};
  return {spp, method, directions, epsilon, photons};
}

} // namespace

TEST_CASE("a value takes the place of the knob's other values, and of nothing else") {
  const std::vector<Knob> all = knobs();
  const Overrides few = with_value({}, all[2], all[2].values[0], all, "fmm");
  CHECK(few == Overrides{"radiosity.directions=32", "radiosity.method=directions"});
  CHECK(with_value(few, all[2], all[2].values[1], all, "fmm") ==
        Overrides{"radiosity.directions=512", "radiosity.method=directions"});
  CHECK(with_value(few, all[4], all[4].values[0], all, "fmm") ==
        Overrides{"caustics.photons=1000", "radiosity.directions=32", "radiosity.method=directions"});
  SECTION("the scene's own value needs no words") {
    const Overrides photons = with_value(few, all[4], all[4].values[0], all, "fmm");
    CHECK(with_value(photons, all[4], all[4].values[1], all, "fmm") == few);
  }
  SECTION("what another method alone reads goes with it") {
    CHECK(with_value(few, all[1], all[1].values[0], all, "fmm") == Overrides{"radiosity.method=none"});
    CHECK(with_value(few, all[3], all[3].values[0], all, "fmm") ==
          Overrides{"radiosity.epsilon=0.08", "radiosity.method=fmm"});
  }
}

TEST_CASE("a value goes with settings of its own method, and a method with all") {
  const std::vector<Knob> all = knobs();
  const Overrides few{"radiosity.directions=32", "radiosity.method=directions"};
  CHECK(goes_with(few, all[4], all[4].values[0], "fmm"));
  CHECK(goes_with(few, all[2], all[2].values[1], "fmm"));
  CHECK_FALSE(goes_with(few, all[3], all[3].values[0], "fmm"));
  CHECK(goes_with({}, all[3], all[3].values[0], "fmm"));
  CHECK(goes_with(few, all[1], all[1].values[0], "fmm"));
}

TEST_CASE("the value that a setting has") {
  const std::vector<Knob> all = knobs();
  const Overrides few{"radiosity.directions=32", "radiosity.method=directions"};
  CHECK(value_in(few, all[2]) == 0u);
  CHECK(value_in({"radiosity.directions=512", "radiosity.method=directions"}, all[2]) == 1u);
  CHECK(value_in(few, all[1]) == 2u);
  CHECK(value_in(few, all[4]) == 1u); // the scene's own
  CHECK_FALSE(value_in(few, all[3]));
  CHECK_FALSE(value_in({"caustics.photons=7"}, all[4]));
}

TEST_CASE("the cheapest setting of a method, which a run is named by") {
  const std::vector<Knob> all = knobs();
  const Overrides cheap = cheapest(all, "directions");
  CHECK(cheap == Overrides{"caustics.photons=1000", "radiosity.directions=32", "radiosity.method=directions"});
  CHECK(cheapest(all, "none") == Overrides{"caustics.photons=1000"});
  CHECK(name_of_overrides(cheap) == "photons-1000_directions-32_method-directions");
  const auto name = [&](const Overrides& overrides) {
    return name_about(overrides, cheap, "cheap", all, "directions");
  };
  CHECK(name({"caustics.photons=1000", "radiosity.directions=512", "radiosity.method=directions", "render.spp=2"}) ==
        "cheap_directions-512_spp-2");
  CHECK(name({"caustics.photons=1000", "radiosity.method=none"}) == "cheap_method-none");
  // Photons are the scene's own.
  CHECK(name({"radiosity.directions=32", "radiosity.method=directions"}) == "cheap_photons-9000");
  CHECK(name({"radiosity.method=none"}) == "method-none"); // which is shorter
  // The scene's directions are none of the knob's.
  CHECK(name({"caustics.photons=1000", "radiosity.method=directions"}) == "photons-1000_method-directions");
  CHECK(name_about({"render.spp=2"}, {}, "own", all, "directions") == "spp-2");
}

TEST_CASE("what light between surfaces reads goes where none is exchanged") {
  std::vector<Knob> all = knobs();
  Knob tolerance{"tolerance", "radiosity.tolerance", true, "", {{"0.1", {"radiosity.tolerance=0.1"}}}};
  tolerance.of_exchange = true;
  all.push_back(tolerance);
  const Knob& method = all[1];
  const Overrides loose = with_value({"render.spp=2"}, tolerance, tolerance.values[0], all, "fmm");
  CHECK(loose == Overrides{"radiosity.tolerance=0.1", "render.spp=2"});
  const Overrides none = with_value(loose, method, method.values[0], all, "fmm");
  CHECK(none == Overrides{"radiosity.method=none", "render.spp=2"});
  CHECK_FALSE(goes_with(none, tolerance, tolerance.values[0], "fmm"));
  CHECK(goes_with(loose, tolerance, tolerance.values[0], "fmm"));
  CHECK_FALSE(goes_with({}, tolerance, tolerance.values[0], "none")); // the scene's own
  CHECK(cheapest(all, "none") == Overrides{"caustics.photons=1000"});
  CHECK(cheapest(all, "fmm").size() == 4);
  CHECK(name_about(none, {"radiosity.tolerance=0.1"}, "cheap", all, "fmm") == "method-none_spp-2");
}
