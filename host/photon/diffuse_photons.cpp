#include "host/photon/diffuse_photons.h"
#include "host/scene/shares.h"
#include <algorithm>

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

PhotonSources sources_of_radiosity(View<float> radiosity, View<Splat> points,
                                   const std::function<double(const Splat&)>& passed_on) {
  PhotonSources sources;
  if (std::none_of(radiosity.begin(), radiosity.end(), [](float b) { return b > 0.0f; })) return sources;
  constexpr float inverse_pi = 0.31830989f;
  for (std::size_t p = 0; p < points.size; ++p) {
    const float* b = &radiosity[3 * p];
    sources.radiance.push_back({inverse_pi * b[0], inverse_pi * b[1], inverse_pi * b[2], 0.0f});
    if (passed_on(points[p]) > 0.0 && points[p].area > 0.0f)
      sources.emitters.push_back({static_cast<pg_uint>(p), 0.0f, {}});
  }
  accumulate_shares(sources.emitters, [&](const Emitter& emitter) {
    const Splat& splat = points[emitter.point];
    return passed_on(splat) * splat.area;
  });
  return sources;
}

} // namespace pointgi
