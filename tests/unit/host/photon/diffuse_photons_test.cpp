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

TEST_CASE("splats send photons by their share in the luminous power, dark ones none") {
  std::vector<Splat> points(3);
  for (Splat& s : points)
    s.area = 2.0f;
  points[2].area = 6.0f;
  const std::vector<float> radiosity{1.0f, 1.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 1.0f, 1.0f};
  const PhotonSources sources = sources_of_radiosity(radiosity, points);
  REQUIRE(sources.emitters.size() == 2);
  CHECK(sources.emitters[0].point == 0);
  CHECK(sources.emitters[0].cumulative == Approx(0.25));
  CHECK(sources.emitters[1].point == 2);
  CHECK(sources.emitters[1].cumulative == 1.0f);
  CHECK(sources.radiance[1][2] == Approx(1.0 / 3.14159265358979).epsilon(1e-6));
  CHECK(sources.delta.empty());
  CHECK(sources_of_radiosity(std::vector<float>(9), points).emitters.empty());
}
