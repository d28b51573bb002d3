#include "fmm/ref/direct_sum.h"
#include "octree/parallel.h"

namespace pointgi {

std::vector<double> direct_sum(View<Splat> points, View<double> radiosity, View<std::uint32_t> receivers,
                               const Visibility& visible) {
  const std::vector<ExchangePoint> all(points.begin(), points.end());
  std::vector<double> irradiance(3 * receivers.size, 0.0);
  parallel_ranges(receivers.size, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::uint32_t i = receivers[k];
      for (std::uint32_t j = 0; j < all.size(); ++j) {
        double factor = point_exchange(all[i], all[j]);
        if (factor > 0.0 && visible) factor *= visible(i, j);
        for (int c = 0; c < 3; ++c)
          irradiance[3 * k + c] += factor * radiosity[3 * j + c];
      }
    }
  });
  return irradiance;
}

} // namespace pointgi
