#include "host/photon/diffuse_photons.h"

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
  double total = 0.0, sum = 0.0;
  for (std::size_t p = 0; p < points.size; ++p)
    total += luminous_power(p);
  constexpr float inverse_pi = 0.31830989f;
  for (std::size_t p = 0; p < points.size; ++p) {
    const double share = luminous_power(p);
    if (!(share > 0.0)) continue;
    sum += share;
    sources.emitters.push_back({static_cast<pg_uint>(p), static_cast<float>(sum / total)});
    const float* b = &radiosity[3 * p];
    sources.radiance.push_back({inverse_pi * b[0], inverse_pi * b[1], inverse_pi * b[2], 0.0f});
  }
  if (!sources.emitters.empty()) sources.emitters.back().cumulative = 1.0f;
  return sources;
}

} // namespace pointgi
