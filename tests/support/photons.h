#pragma once
/// Photons as a caustic leaves them: thousands of times denser along curves than beside them.
#include "host/photon/photon_map.h"
#include <cmath>
#include <random>
#include <vector>

namespace pointgi::test {

inline Photon make_photon(float x, float y, float z, const float direction[3], float power = 1.0f) {
  Photon p{};
  p.position[0] = x, p.position[1] = y, p.position[2] = z;
  p.inward = packed_direction(direction);
  for (float& c : p.power)
    c = power;
  return p;
}

/// On a floor at z = 0.3, falling: half about a ring, a quarter about its middle, the rest anywhere.
inline std::vector<Photon> caustic_photons(std::size_t count, unsigned seed) {
  std::mt19937 g(seed);
  std::uniform_real_distribution<float> u(0.0f, 1.0f);
  std::normal_distribution<float> gauss;
  const float down[3] = {0.0f, 0.0f, -1.0f};
  std::vector<Photon> photons;
  for (std::size_t i = 0; i < count; ++i) {
    const float angle = 6.2831853f * u(g);
    float r = 0.2f + 0.01f * gauss(g);
    if (i % 4 == 2) r = 0.05f * std::fabs(gauss(g));
    float x = 0.5f + r * std::cos(angle), y = 0.5f + r * std::sin(angle);
    if (i % 4 == 3) x = u(g), y = u(g);
    photons.push_back(make_photon(x, y, 0.3f, down));
  }
  return photons;
}

} // namespace pointgi::test
