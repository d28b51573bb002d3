#include "host/image/exposure.h"
#include "host/image/srgb.h"
#include <algorithm>
#include <cmath>

namespace pointgi {

namespace {

// Twenty bins a stop, over all that a float holds.
constexpr double bins_a_stop = 20.0, lowest = -149.0, highest = 128.0;
constexpr auto bin_count = static_cast<std::size_t>((highest - lowest) * bins_a_stop);

constexpr double grey_of_black = 0.1, grey_of_white = 0.5;
constexpr double unburnt_share = 0.98; // of the surfaces: specks of light may be white
constexpr double least_mean = 0.3, largest_mean = 0.65;

double middle_of(std::size_t bin) {
  return lowest + (static_cast<double>(bin) + 0.5) / bins_a_stop;
}

double luminance(const std::array<float, 3>& rgb) {
  return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

} // namespace

void ExposureMeter::Histogram::add(double value) {
  ++all;
  if (!(value > 0.0)) {
    ++black;
    return;
  }
  const double place = (std::log2(value) - lowest) * bins_a_stop;
  ++bins[static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(bin_count - 1)))];
}

double ExposureMeter::Histogram::quantile(double share) const {
  const auto wanted = static_cast<std::uint64_t>(share * static_cast<double>(all - black));
  std::uint64_t below = 0;
  for (std::size_t bin = 0; bin < bin_count; ++bin)
    if ((below += bins[bin]) > wanted) return middle_of(bin);
  return middle_of(bin_count - 1);
}

ExposureMeter::ExposureMeter() {
  for (Histogram* histogram : {&surfaces_, &values_, &brightest_})
    histogram->bins.resize(bin_count);
}

void ExposureMeter::add(const std::array<float, 3>& radiance, float coverage, const std::array<float, 3>& albedo) {
  for (const float value : radiance)
    if (!std::isfinite(value)) return;
  for (const float value : radiance)
    values_.add(value);
  brightest_.add(*std::max_element(radiance.begin(), radiance.end()));
  if (coverage < 0.5f) return;
  surfaces_.add(luminance(radiance));
  if (luminance(radiance) > 0.0) albedo_sum_ += std::clamp(luminance(albedo), 0.0, 1.0);
}

double ExposureMeter::mean_at(double stops) const {
  double sum = 0.0;
  for (std::size_t bin = 0; bin < bin_count; ++bin)
    if (values_.bins[bin] > 0)
      sum += static_cast<double>(values_.bins[bin]) *
             linear_to_srgb(static_cast<float>(std::min(1.0, std::exp2(middle_of(bin) + stops))));
  return values_.all > 0 ? sum / static_cast<double>(values_.all) : 0.0;
}

double ExposureMeter::clipped_at(double stops) const {
  std::uint64_t count = 0;
  for (std::size_t bin = 0; bin < bin_count; ++bin)
    if (middle_of(bin) + stops >= 0.0) count += brightest_.bins[bin];
  return brightest_.all > 0 ? static_cast<double>(count) / static_cast<double>(brightest_.all) : 0.0;
}

double ExposureMeter::lit_share() const {
  return brightest_.all > 0
             ? static_cast<double>(brightest_.all - brightest_.black) / static_cast<double>(brightest_.all)
             : 0.0;
}

double ExposureMeter::stops() const {
  const bool covered = surfaces_.all > surfaces_.black;
  const Histogram& metered = covered ? surfaces_ : brightest_;
  if (metered.all == metered.black) return 0.0;
  const double albedo = covered ? albedo_sum_ / static_cast<double>(surfaces_.all - surfaces_.black) : 0.5;
  const double grey = grey_of_black + (grey_of_white - grey_of_black) * albedo;
  const double unburnt = -metered.quantile(unburnt_share) - 1.0 / bins_a_stop;
  double stops = std::min(std::log2(grey) - metered.quantile(0.5), unburnt);
  // The mean rises with the exposure: two bisections, each towards its bound.
  const auto at_mean = [&](double mean, double from, double to) {
    for (int step = 0; step < 20; ++step) {
      const double half = 0.5 * (from + to);
      (mean_at(half) < mean ? from : to) = half;
    }
    return 0.5 * (from + to);
  };
  if (mean_at(stops) > largest_mean) return at_mean(largest_mean, stops - 20.0, stops);
  if (mean_at(stops) < least_mean) stops = at_mean(least_mean, stops, std::max(stops, unburnt));
  return stops;
}

} // namespace pointgi
