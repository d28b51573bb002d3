#include "host/radiosity/shared_irradiance.h"
#include "octree/parallel.h"
#include <algorithm>
#include <array>
#include <cmath>

namespace pointgi {

namespace {

constexpr std::size_t points_a_range = 2048;

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

SharedIrradiance::SharedIrradiance(View<Splat> pool, View<std::uint32_t> places, std::vector<float> ways,
                                   std::size_t most_searched)
    : pool_(pool), places_(places), ways_(std::move(ways)) {
  if (places_.size < 2 || places_.size > most_searched) return;
  std::vector<Eigen::Vector3d> positions;
  positions.reserve(places_.size);
  for (std::size_t i = 0; i < places_.size; ++i)
    positions.emplace_back(point(i).position[0], point(i).position[1], point(i).position[2]);
  sites_ = std::make_unique<Sites>(positions);
}

double SharedIrradiance::weight(std::size_t i, std::size_t j) const {
  const double way = std::min(ways_[i], ways_[j]);
  const double turn = std::sqrt(std::max(0.0, 1.0 - cosine_of(point(i), point(j))));
  return 1.0 - (std::sqrt(distance2(point(i), point(j))) / way + turn) / least_error;
}

/// A point's own value, and those of others as they are added.
class SharedIrradiance::Mean {
public:
  Mean(View<float> own, std::size_t channels) : own_(own), sum_(channels) {}

  void begin(std::size_t i) {
    weight_ = 0.0;
    std::fill(sum_.begin(), sum_.end(), 0.0);
    add(i, 1.0);
  }
  void add(std::size_t j, double weight) {
    if (!(weight > 0.0)) return;
    weight_ += weight;
    for (std::size_t c = 0; c < sum_.size(); ++c)
      sum_[c] += weight * static_cast<double>(own_[sum_.size() * j + c]);
  }
  void end(float* value) const {
    for (std::size_t c = 0; c < sum_.size(); ++c)
      value[c] = static_cast<float>(sum_[c] / weight_);
  }

private:
  View<float> own_;
  std::vector<double> sum_;
  double weight_ = 0.0;
};

void SharedIrradiance::share_with_searched(View<float> values, std::size_t channels,
                                           std::vector<float>& of_pool) const {
  parallel_ranges(sites_->size(), points_a_range, [&](std::size_t begin, std::size_t end) {
    std::array<Neighbour, most_neighbours> near;
    Mean mean(values, channels);
    for (auto site = static_cast<std::uint32_t>(begin); site < end; ++site) {
      const unsigned found = sites_->nearest(site, most_neighbours, near.data());
      for (const std::uint32_t i : sites_->points(site)) {
        mean.begin(i);
        for (unsigned n = 0; n < found; ++n)
          for (const std::uint32_t j : sites_->points(near[n].site))
            mean.add(j, weight(i, j));
        mean.end(&of_pool[channels * places_[i]]);
      }
    }
  });
}

void SharedIrradiance::share_along_pool(View<float> values, std::size_t channels, std::vector<float>& of_pool) const {
  constexpr std::size_t on_a_side = most_neighbours / 2;
  parallel_ranges(places_.size, points_a_range, [&](std::size_t begin, std::size_t end) {
    Mean mean(values, channels);
    for (std::size_t i = begin; i < end; ++i) {
      mean.begin(i);
      for (std::size_t j = i - std::min(i, on_a_side); j < std::min(places_.size, i + on_a_side + 1); ++j)
        if (j != i) mean.add(j, weight(i, j));
      mean.end(&of_pool[channels * places_[i]]);
    }
  });
}

void SharedIrradiance::share(View<float> values, std::size_t channels, std::vector<float>& of_pool) const {
  if (sites_)
    share_with_searched(values, channels, of_pool);
  else
    share_along_pool(values, channels, of_pool);
}

} // namespace pointgi
