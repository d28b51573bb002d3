#include "host/photon/diffuse_photons.h"
#include "host/scene/shares.h"

namespace pointgi {

std::vector<float> irradiance_by_photons(View<Photon> photons, View<Splat> points) {
  std::vector<double> power(3 * points.size);
  for (const Photon& photon : photons)
    for (std::size_t c = 0; c < 3; ++c)
      power[3 * photon.splat + c] += double{photon.power[c]};
  std::vector<float> irradiance(power.size());
  for (std::size_t i = 0; i < power.size(); ++i)
    if (power[i] > 0.0) irradiance[i] = static_cast<float>(power[i] / double{points[i / 3].area});
  return irradiance;
}

PhotonSources sources_of_radiosity(View<float> radiosity, View<Splat> points) {
  PhotonSources sources;
  const auto luminous_power = [&](std::size_t p) {
    const float* b = &radiosity[3 * p];
    return (0.2126 * b[0] + 0.7152 * b[1] + 0.0722 * b[2]) * points[p].area;
  };
  constexpr float inverse_pi = 0.31830989f;
  for (std::size_t p = 0; p < points.size; ++p) {
    if (!(luminous_power(p) > 0.0)) continue;
    sources.emitters.push_back({static_cast<pg_uint>(p), 0.0f});
    const float* b = &radiosity[3 * p];
    sources.radiance.push_back({inverse_pi * b[0], inverse_pi * b[1], inverse_pi * b[2], 0.0f});
  }
  accumulate_shares(sources.emitters, [&](const Emitter& emitter) { return luminous_power(emitter.point); });
  return sources;
}

} // namespace pointgi
