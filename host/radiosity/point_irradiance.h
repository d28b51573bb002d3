#pragma once
/// Direct irradiance of the points, by shadow rays: what enters the exchange of diffuse light.
#include "host/passes/device_pools.h"
#include "host/scene/lighting.h"
#include <functional>
#include <optional>

namespace pointgi {

/// H [n x 3, W/m² divided by lighting.radiance.scale] of all n points of the pool, from every light of `lighting`, and,
/// where `with_emitters`, from the emitting splats; the mean of `samples` estimates a point. Launches are short;
/// between them `stop` is asked, and what was not reached stays 0, as do points that are not among `places`, where it
/// is given.
Buffer<float> direct_irradiance_of_points(Session& session, const DevicePools& pools, const TraversalVariant& variant,
                                          const DeviceLighting& lighting, double side, std::size_t points,
                                          unsigned samples, bool with_emitters, const std::function<bool()>& stop,
                                          std::optional<View<std::uint32_t>> places = {});

} // namespace pointgi
