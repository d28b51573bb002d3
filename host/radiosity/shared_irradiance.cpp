#include "host/radiosity/shared_irradiance.h"
#include "octree/parallel.h"
#include <algorithm>
#include <array>
#include <cmath>

namespace pointgi {

namespace {

constexpr std::size_t sites_a_range = 2048;

double distance2(const Splat& a, const Splat& b) {
  double sum = 0.0;
  for (int k = 0; k < 3; ++k)
    sum += (double{a.position[k]} - b.position[k]) * (double{a.position[k]} - b.position[k]);
  return sum;
}

double cosine_of(const Splat& a, const Splat& b) {
  return double{a.normal[0]} * b.normal[0] + double{a.normal[1]} * b.normal[1] + double{a.normal[2]} * b.normal[2];
}

} // namespace

SharedIrradiance::SharedIrradiance(View<Splat> pool, const std::vector<std::uint32_t>& places, std::vector<float> ways)
    : pool_(pool), places_(places), ways_(std::move(ways)) {
  std::vector<Eigen::Vector3d> positions;
  positions.reserve(places_.size());
  for (std::size_t i = 0; i < places_.size(); ++i)
    positions.emplace_back(point(i).position[0], point(i).position[1], point(i).position[2]);
  if (positions.size() > 1) sites_ = std::make_unique<Sites>(positions);
}

void SharedIrradiance::share(std::vector<float>& values, std::size_t channels) const {
  if (!sites_) return;
  const std::vector<float> own = values;
  parallel_ranges(sites_->size(), sites_a_range, [&](std::size_t begin, std::size_t end) {
    std::array<Neighbour, most_neighbours> near;
    std::vector<double> sum(channels);
    for (auto site = static_cast<std::uint32_t>(begin); site < end; ++site) {
      const unsigned found = sites_->nearest(site, most_neighbours, near.data());
      for (const std::uint32_t i : sites_->points(site)) {
        double weight = 1.0;
        for (std::size_t c = 0; c < channels; ++c)
          sum[c] = static_cast<double>(own[channels * i + c]);
        for (unsigned n = 0; n < found; ++n)
          for (const std::uint32_t j : sites_->points(near[n].site)) {
            const double way = std::min(ways_[i], ways_[j]);
            const double turn = std::sqrt(std::max(0.0, 1.0 - cosine_of(point(i), point(j))));
            const double w = 1.0 - (std::sqrt(distance2(point(i), point(j))) / way + turn) / least_error;
            if (!(w > 0.0)) continue;
            weight += w;
            for (std::size_t c = 0; c < channels; ++c)
              sum[c] += w * static_cast<double>(own[channels * j + c]);
          }
        for (std::size_t c = 0; c < channels; ++c)
          values[channels * i + c] = static_cast<float>(sum[c] / weight);
      }
    }
  });
}

} // namespace pointgi
