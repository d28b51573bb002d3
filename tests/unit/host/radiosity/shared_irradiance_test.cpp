#include "host/radiosity/shared_irradiance.h"
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <random>

using namespace pointgi;

namespace {

constexpr int across = 40;
constexpr float step = 1.0f / across;

/// A square in the plane y = 0.5, and one across it at x = 1 where `corner`.
std::vector<Splat> squares(bool corner) {
  std::vector<Splat> splats;
  for (int i = 0; i < across; ++i)
    for (int j = 0; j < across; ++j) {
      const float u = step * (static_cast<float>(i) + 0.5f), v = step * (static_cast<float>(j) + 0.5f);
      splats.push_back({{u, 0.5f, v}, 0.75f * step, {0, 1, 0}, 0.0f, {1, 1, 1}, step * step});
      if (corner) splats.push_back({{1.0f, 0.5f + u, v}, 0.75f * step, {-1, 0, 0}, 0.0f, {1, 1, 1}, step * step});
    }
  return splats;
}

std::vector<std::uint32_t> all_of(const std::vector<Splat>& splats) {
  std::vector<std::uint32_t> places(splats.size());
  std::iota(places.begin(), places.end(), 0u);
  return places;
}

/// share() of all points of a pool.
std::vector<float> shared_values(const SharedIrradiance& shared, const std::vector<float>& values,
                                 std::size_t channels) {
  std::vector<float> of_pool(values.size());
  shared.share(values, channels, of_pool);
  return of_pool;
}

double spread(const std::vector<float>& values) {
  double sum = 0.0, squares = 0.0;
  for (const float v : values)
    sum += v, squares += double{v} * v;
  const auto n = static_cast<double>(values.size());
  return std::sqrt(squares / n - sum / n * sum / n);
}

} // namespace

TEST_CASE("noise of neighbours averages out where all they see is far, and a constant stays") {
  const std::vector<Splat> plane = squares(false);
  // Found by a search, or, as of more points than are searched, by the order of the pool.
  const std::size_t most_searched = GENERATE(100'000u, 0u);
  const std::vector<std::uint32_t> places = all_of(plane);
  const SharedIrradiance shared(plane, places, std::vector<float>(plane.size(), 2.0f), most_searched);
  std::mt19937 random(1);
  std::normal_distribution<float> noise(0.0f, 0.1f);
  std::vector<float> values(plane.size(), 1.0f), noisy = values;
  for (float& v : noisy)
    v += noise(random);
  const double before = spread(noisy);
  noisy = shared_values(shared, noisy, 1);
  // 24 neighbours within a tenth of the way: weights of 0.5 to 1, a fifth of the noise. In rows, as this pool has them,
  // those along it are farther off.
  CHECK(spread(noisy) < 0.3 * before);
  values = shared_values(shared, values, 1);
  for (const float v : values)
    CHECK(v == Approx(1.0f).epsilon(1e-6));
}

TEST_CASE("what is near keeps its own value: no neighbour is as near as the walls of a corner") {
  const std::vector<Splat> plane = squares(false);
  const std::vector<std::uint32_t> places = all_of(plane);
  const SharedIrradiance shared(plane, places, std::vector<float>(plane.size(), step));
  std::vector<float> values(plane.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = static_cast<float>(i % 7);
  const std::vector<float> before = values;
  values = shared_values(shared, values, 1);
  CHECK(values == before);
}

TEST_CASE("walls across share nothing, channels stay apart, a gradient stays in its middle") {
  const std::vector<Splat> corner = squares(true);
  const std::size_t most_searched = GENERATE(100'000u, 0u);
  const std::vector<std::uint32_t> places = all_of(corner);
  const SharedIrradiance shared(corner, places, std::vector<float>(corner.size(), 2.0f), most_searched);
  std::vector<float> values(3 * corner.size());
  for (std::size_t i = 0; i < corner.size(); ++i) {
    const bool floor = corner[i].normal[1] > 0.5f;
    values[3 * i] = floor ? 1.0f : 5.0f;
    values[3 * i + 1] = 2.0f;
    values[3 * i + 2] = corner[i].position[2];
  }
  values = shared_values(shared, values, 3);
  for (std::size_t i = 0; i < corner.size(); ++i) {
    CHECK(values[3 * i] == Approx(corner[i].normal[1] > 0.5f ? 1.0f : 5.0f).epsilon(1e-6));
    CHECK(values[3 * i + 1] == Approx(2.0f).epsilon(1e-6));
    const float z = corner[i].position[2], x = corner[i].position[0];
    if (corner[i].normal[1] > 0.5f && z > 0.2f && z < 0.8f && x > 0.2f && x < 0.8f)
      CHECK(values[3 * i + 2] == Approx(z).margin(0.2 * step)); // ties among the 24 nearest are cut
  }
}

TEST_CASE("the two sides of a sheet, and points that meet nothing, are no trouble") {
  std::vector<Splat> sheet = squares(false);
  const std::size_t one_side = sheet.size();
  for (std::size_t i = 0; i < one_side; ++i) {
    sheet.push_back(sheet[i]);
    sheet.back().normal[1] = -1.0f;
  }
  const std::vector<std::uint32_t> places = all_of(sheet);
  const SharedIrradiance shared(sheet, places, std::vector<float>(sheet.size(), INFINITY));
  std::vector<float> values(sheet.size());
  for (std::size_t i = 0; i < sheet.size(); ++i)
    values[i] = i < one_side ? 1.0f : 3.0f;
  values = shared_values(shared, values, 1);
  for (std::size_t i = 0; i < sheet.size(); ++i)
    CHECK(values[i] == Approx(i < one_side ? 1.0f : 3.0f).epsilon(1e-6));
  const std::vector<Splat> one(1, sheet[0]);
  std::vector<float> alone{7.0f};
  alone = shared_values(SharedIrradiance(one, View<std::uint32_t>(places.data(), 1), {1.0f}), alone, 1);
  CHECK(alone[0] == 7.0f);
}
