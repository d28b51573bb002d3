#include "host/photon/diffuse_photons.h"
#include <catch2/catch.hpp>

using namespace pointgi;

TEST_CASE("what photons bring to splats is their power over the splat's area") {
  std::vector<Splat> points(3);
  for (std::size_t p = 0; p < points.size(); ++p)
    points[p].area = 0.5f * static_cast<float>(p + 1);
  std::vector<Photon> photons(3);
  photons[0].splat = 2, photons[1].splat = 0, photons[2].splat = 2;
  for (std::size_t k = 0; k < photons.size(); ++k)
    photons[k].power[1] = static_cast<float>(k + 1);
  const std::vector<float> irradiance = irradiance_by_photons(photons, points);
  const std::vector<float> expected{0.0f, 4.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 4.0f / 1.5f, 0.0f};
  CHECK(irradiance == expected); // one division each
}

TEST_CASE("specular splats look for light in proportion to their areas and to what they pass on") {
  std::vector<Splat> points(4);
  const double part[] = {0.0, 1.0, 2.0, 0.25};
  for (std::size_t p = 0; p < points.size(); ++p) {
    points[p].material = static_cast<decltype(points[p].material)>(p);
    points[p].area = p == 3 ? 4.0f : 1.0f;
  }
  const auto passed_on = [&](const Splat& s) { return part[static_cast<std::size_t>(s.material)]; };
  std::vector<float> radiosity(12);
  CHECK(sources_of_radiosity(radiosity, points, passed_on).emitters.empty());
  radiosity[1] = 2.0f;
  const PhotonSources sources = sources_of_radiosity(radiosity, points, passed_on);
  REQUIRE(sources.emitters.size() == 3);
  const float running[] = {0.25f, 0.75f, 1.0f}; // 1, 2 and a quarter of 4; shares are multiples of 2^-24
  for (std::size_t e = 0; e < 3; ++e) {
    CHECK(sources.emitters[e].point == e + 1);
    CHECK(sources.emitters[e].cumulative == Approx(running[e]).margin(1e-7));
  }
  REQUIRE(sources.radiance.size() == 4);
  CHECK(sources.radiance[0][1] == Approx(2.0 / 3.14159265358979).epsilon(1e-6));
  CHECK(sources.radiance[3][1] == 0.0f);
  CHECK(sources.light_sources.empty());
  const auto diffuse = [](const Splat&) { return 0.0; };
  CHECK(sources_of_radiosity(radiosity, points, diffuse).emitters.empty());
}
