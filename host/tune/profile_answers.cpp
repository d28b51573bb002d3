#include "host/tune/profile_answers.h"
#include "shared/render_types.h"
#include <algorithm>
#include <cmath>

namespace pointgi {

namespace {

constexpr std::size_t few_pixels = 100;  ///< one in so many may be shaded otherwise; its eye rays may not
constexpr std::size_t few_photons = 100; ///< one in so many may end elsewhere

/// False of NaN.
bool within(float a, float b, float tolerance) {
  return std::fabs(a - b) <= tolerance;
}

bool ends_alike(const PhotonFlight& a, const PhotonFlight& b) {
  if (a.end != b.end) return false;
  const float power = 1e-2f * std::max({b.power[0], b.power[1], b.power[2]}),
              emitted = 1e-2f * std::max({b.emitted[0], b.emitted[1], b.emitted[2]});
  bool alike = true;
  for (int k = 0; k < 3; ++k)
    alike = alike && within(a.position[k], b.position[k], 1e-3f) && within(a.power[k], b.power[k], power) &&
            within(a.emitted[k], b.emitted[k], emitted);
  return alike;
}

} // namespace

Differences compare_answers(View<RayAnswer> found, View<RayAnswer> truth) {
  Differences result;
  for (std::size_t i = 0; i < truth.size; ++i) {
    const RayAnswer &a = found[i], &b = truth[i];
    const bool near = a.t == b.t || std::fabs(a.t - b.t) <= 1e-5f * std::max(1.0f, std::fabs(b.t)); // false of NaN
    if (a.splat == b.splat && near) continue;
    const bool both_hit = a.splat != NO_SPLAT && b.splat != NO_SPLAT;
    if (a.splat != b.splat && both_hit && a.t == b.t)
      ++result.ties;
    else
      ++result.wrong;
  }
  return result;
}

Differences compare_blocked(View<std::uint32_t> found, View<std::uint32_t> truth) {
  Differences result;
  for (std::size_t i = 0; i < truth.size; ++i)
    result.wrong += (found[i] != 0) != (truth[i] != 0);
  return result;
}

Differences compare_flights(View<PhotonFlight> found, View<PhotonFlight> truth) {
  std::size_t elsewhere = 0, lost = 0, gained = 0, set_out = 0;
  for (std::size_t i = 0; i < truth.size; ++i) {
    const bool missed = found[i].end == PHOTON_MISSED, missed_in_truth = truth[i].end == PHOTON_MISSED;
    set_out += !missed_in_truth;
    lost += missed && !missed_in_truth;
    gained += !missed && missed_in_truth;
    elsewhere += !missed && !missed_in_truth && !ends_alike(found[i], truth[i]);
  }
  const std::size_t ties = lost + gained, surplus = std::max(lost, gained) - std::min(lost, gained);
  const double few = static_cast<double>(set_out) / few_photons;
  Differences result{0, ties};
  if (static_cast<double>(elsewhere) > few) result.wrong += elsewhere;
  // Each tie falls to one side or the other: four deviations of their sum.
  if (static_cast<double>(surplus) > few + 4.0 * std::sqrt(static_cast<double>(ties))) result.wrong += surplus;
  return result;
}

Differences compare_films(View<float> found, View<float> truth, bool lit_alike) {
  std::vector<int> channels{FILM_COVERAGE, FILM_DEPTH};
  for (int k = 0; k < 3; ++k) {
    channels.push_back(FILM_ALBEDO + k);
    channels.push_back(FILM_NORMAL + k);
    channels.push_back(FILM_POSITION + k);
    if (lit_alike) channels.push_back(FILM_DIRECT + k);
  }
  std::size_t differing = 0;
  const std::size_t pixels = truth.size / FILM_CHANNELS;
  for (std::size_t p = 0; p < pixels; ++p) {
    const float *a = found.data + p * FILM_CHANNELS, *b = truth.data + p * FILM_CHANNELS;
    // Sums over the samples: a thousandth of one sample's share, or of the value where it is larger.
    differing += std::any_of(channels.begin(), channels.end(), [&](int c) {
      return !(std::fabs(a[c] - b[c]) <= 1e-3f * std::max(1.0f, std::fabs(b[c])));
    });
  }
  // Random numbers of light samples turn on the last bit of a surface in a few pixels.
  return {differing * few_pixels > pixels ? differing : 0, 0};
}

void to_inputs(std::vector<RayAnswer>& answers, const std::vector<std::uint32_t>& source) {
  for (RayAnswer& answer : answers)
    if (answer.splat < source.size()) answer.splat = source[answer.splat];
}

} // namespace pointgi
