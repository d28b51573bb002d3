/// The lights that are infinitely far on the device: against their host twins, and their samplers against their
/// densities.
#include "host/lights/environment_map.h"
#include "tests/support/device.h"
#include "tests/support/sky.h"
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>

using namespace pointgi;
using namespace pointgi::test;

namespace {

constexpr double pi = 3.14159265358979323846;

Vector3d vector_of(const cl_float4& v) {
  return {v.s[0], v.s[1], v.s[2]};
}

std::vector<cl_float4> random_numbers(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<cl_float4> numbers(count);
  for (cl_float4& number : numbers) {
    const std::array<double, 4> u = four_numbers(random);
    for (std::size_t k = 0; k < 4; ++k)
      number.s[k] = static_cast<float>(u[k]);
  }
  return numbers;
}

/// A map as kernels take it.
struct OnDevice {
  explicit OnDevice(const EnvironmentMap& map)
      : sky(session().upload(std::vector<SkyMap>{device_sky_map(map)})), rows(session().upload(map.rows)),
        columns(session().upload(map.columns)), texels(session().upload(device_texels(map, 1.0))) {}

  Buffer<SkyMap> sky;
  Buffer<SkyRow> rows;
  Buffer<float> columns;
  Buffer<SkyTexel> texels;
};

struct Drawn {
  Vector3d direction;
  cl_float4 sampled, found; ///< radiance and density where it was drawn, and in that direction
};

std::vector<Drawn> as_drawn(const std::vector<cl_float4>& values) {
  std::vector<Drawn> drawn;
  for (std::size_t i = 0; i < values.size(); i += 3)
    drawn.push_back({vector_of(values[i]), values[i + 1], values[i + 2]});
  return drawn;
}

std::vector<Drawn> draw_from_map(const OnDevice& map, const std::vector<cl_float4>& numbers) {
  Session& device = session();
  const auto u = device.upload(numbers);
  const auto out = device.allocate<cl_float4>(3 * numbers.size());
  cl::Kernel kernel = device.kernel("test/sky_probe.cl", "", "probe_sky_map");
  device.launch(kernel, LaunchShape::line(numbers.size()), map.sky, map.rows, map.columns, map.texels, u, out,
                static_cast<cl_uint>(numbers.size()));
  return as_drawn(device.download(out, 3 * numbers.size()));
}

std::vector<Drawn> draw_from_sun(const LightSource& sun, const std::vector<cl_float4>& numbers) {
  Session& device = session();
  const auto disc = device.upload(std::vector<LightSource>{sun});
  const auto u = device.upload(numbers);
  const auto out = device.allocate<cl_float4>(3 * numbers.size());
  cl::Kernel kernel = device.kernel("test/sky_probe.cl", "", "probe_sun");
  device.launch(kernel, LaunchShape::line(numbers.size()), disc, u, out, static_cast<cl_uint>(numbers.size()));
  return as_drawn(device.download(out, 3 * numbers.size()));
}

bool same(const cl_float4& a, const cl_float4& b) {
  return a.s[0] == b.s[0] && a.s[1] == b.s[1] && a.s[2] == b.s[2] && a.s[3] == b.s[3];
}

bool same(const cl_float4& a, const SkyTexel& b) {
  return a.s[0] == b.radiance[0] && a.s[1] == b.radiance[1] && a.s[2] == b.radiance[2] && a.s[3] == b.density;
}

LightSource sun_of(const Vector3d& towards, double radius_deg) {
  LightSource sun{};
  for (int k = 0; k < 3; ++k)
    sun.vector[k] = static_cast<float>(towards[k]);
  const double radius = radius_deg * pi / 180.0;
  sun.sine2 = static_cast<float>(std::pow(std::sin(radius), 2));
  return sun;
}

} // namespace

TEST_CASE("device and host lay the structs of the sky out alike") {
  const std::vector<std::size_t> host = {sizeof(SkyMap), offsetof(SkyMap, forward), offsetof(SkyMap, up),
                                         sizeof(SkyRow), sizeof(SkyTexel)};
  Session& device = session();
  const auto sizes = device.allocate<cl_uint>(host.size());
  cl::Kernel kernel = device.kernel("test/sky_probe.cl", "", "probe_sky_layout");
  device.launch(kernel, LaunchShape{{1, 1}, {1, 1}}, sizes);
  const auto found = device.download(sizes, host.size());
  for (std::size_t i = 0; i < host.size(); ++i) {
    CAPTURE(i);
    CHECK(found[i] == host[i]);
  }
}

TEST_CASE("the device draws from a map as its host twin does") {
  const auto [width, height] = GENERATE(std::pair(48, 24), std::pair(5, 7), std::pair(1, 1), std::pair(64, 2048));
  const UpAxis up = GENERATE(UpAxis::y, UpAxis::z);
  const EnvironmentMap map = make_environment_map(spotted_image(width, height), sky_frame(up, 33.0), 1.0, "map");
  if (map.is_black) return; // nothing to draw: the spotted map of one pixel
  std::vector<cl_float4> numbers = random_numbers(20'000, 9);
  numbers[0] = {{0.0f, 0.0f, 0.0f, 0.0f}};
  numbers[1] = {{0.99999994f, 0.99999994f, 0.99999994f, 0.99999994f}};
  const std::vector<Drawn> drawn = draw_from_map(OnDevice(map), numbers);
  std::size_t other_texel = 0, not_found = 0;
  double farthest = 0.0;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    const SkySample twin = sample_map(map, {numbers[i].s[0], numbers[i].s[1], numbers[i].s[2], numbers[i].s[3]});
    other_texel += !same(drawn[i].sampled, map.texels[twin.texel]);
    not_found += !same(drawn[i].found, drawn[i].sampled);
    farthest = std::fmax(farthest, (drawn[i].direction - twin.direction).norm());
  }
  CHECK(other_texel == 0);
  // The azimuth is a float of up to pi: 2e-7, and as much again from sines and cosines.
  CHECK(farthest < 1e-6);
  // On a border between texels the two may be neighbours: as many as rounding reaches, 1e-6 of a texel of 1/2048 of pi.
  CHECK(not_found <= (height > 1000 ? 60 : 4));
}

TEST_CASE("the device finds the texel that its host twin finds") {
  const EnvironmentMap map = make_environment_map(spotted_image(128, 64), sky_frame(UpAxis::y, -75.0), 1.0, "map");
  std::mt19937 random(21);
  std::vector<cl_float4> directions;
  for (int i = 0; i < 50'000; ++i) {
    Vector3d d = Vector3d::Zero();
    while (!(d.norm() > 0.1 && d.norm() < 1.0))
      d = Vector3d(four_numbers(random)[0] - 0.5, four_numbers(random)[0] - 0.5, four_numbers(random)[0] - 0.5) * 2.0;
    d.normalize();
    directions.push_back({{static_cast<float>(d.x()), static_cast<float>(d.y()), static_cast<float>(d.z()), 0.0f}});
  }
  // Poles and axes, where azimuths are none or jump.
  for (int axis = 0; axis < 3; ++axis)
    for (const float sign : {-1.0f, 1.0f}) {
      cl_float4 d = {{0.0f, 0.0f, 0.0f, 0.0f}};
      d.s[axis] = sign;
      directions.push_back(d);
    }
  Session& device = session();
  const OnDevice on_device(map);
  const auto in = device.upload(directions);
  const auto out = device.allocate<cl_float4>(directions.size());
  cl::Kernel kernel = device.kernel("test/sky_probe.cl", "", "probe_sky_towards");
  device.launch(kernel, LaunchShape::line(directions.size()), on_device.sky, on_device.rows, on_device.columns,
                on_device.texels, in, out, static_cast<cl_uint>(directions.size()));
  const auto found = device.download(out, directions.size());
  std::size_t different = 0, of_none = 0;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    different += !same(found[i], map.texels[texel_towards(map, vector_of(directions[i]))]);
    of_none += !std::isfinite(found[i].s[3]);
  }
  CHECK(of_none == 0);
  CHECK(different <=
        10); // on borders, to rounding: 1e-6 of a texel of 0.05, of which there are two borders a direction
}

TEST_CASE("directions that the device draws from a map are distributed as their density says") {
  const EnvironmentMap map = make_environment_map(spotted_image(24, 12), sky_frame(UpAxis::z, 10.0), 1.0, "map");
  Histogram histogram(map);
  double estimate = 0.0;
  const Vector3d normal = Vector3d(0.3, -0.4, 0.866).normalized();
  const std::vector<Drawn> drawn = draw_from_map(OnDevice(map), random_numbers(400'000, 2));
  for (const Drawn& d : drawn) {
    REQUIRE(d.direction.norm() == Approx(1.0).epsilon(1e-6));
    REQUIRE(d.sampled.s[3] > 0.0f);
    histogram.count(d.direction);
    estimate += static_cast<double>(d.sampled.s[1]) * std::fmax(0.0, d.direction.dot(normal)) /
                static_cast<double>(d.sampled.s[3]);
  }
  // A chi-square beyond this has a probability of 1e-6 (normal approximation).
  CHECK(histogram.deviation() < 4.8);
  // The same numbers in another guise: irradiance, of which one sample has a deviation of the size of the mean.
  CHECK(estimate / static_cast<double>(drawn.size()) == Approx(irradiance(map, normal).y()).epsilon(0.01));
}

TEST_CASE("directions drawn from the sun's disc fill it evenly") {
  const double radius_deg = GENERATE(0.265, 0.01, 10.0);
  const Vector3d towards = GENERATE(Vector3d(0.0, 0.0, 1.0), Vector3d(0.0, 0.0, -1.0), Vector3d(0.36, -0.48, 0.8));
  const LightSource sun = sun_of(towards, radius_deg);
  const std::vector<Drawn> drawn = draw_from_sun(sun, random_numbers(100'000, 4));
  constexpr int rings = 10, sectors = 12;
  std::vector<double> counts(rings * sectors);
  const Vector3d a = towards.unitOrthogonal(), b = towards.cross(a);
  const double height = 2.0 * std::pow(std::sin(0.5 * radius_deg * pi / 180.0), 2);
  std::size_t outside = 0;
  for (const Drawn& d : drawn) {
    // By the chord, whose square is twice 1 - cosine.
    const double ring = 0.5 * (d.direction - towards).squaredNorm() / height * rings;
    outside += d.found.s[3] == 0.0f;
    // Radiance over density, the radiance being 1 over the disc's integral of the cosine.
    REQUIRE(static_cast<double>(d.sampled.s[0]) ==
            Approx(2.0 * height / std::pow(std::sin(radius_deg * pi / 180.0), 2)).epsilon(1e-5));
    if (d.found.s[3] > 0.0f)
      REQUIRE(static_cast<double>(d.found.s[0]) ==
              Approx(static_cast<double>(d.sampled.s[0]) * static_cast<double>(d.sampled.s[3])).epsilon(1e-5));
    REQUIRE(static_cast<double>(d.sampled.s[3]) == Approx(1.0 / (2.0 * pi * height)).epsilon(1e-5));
    const double sector = (std::atan2(d.direction.dot(b), d.direction.dot(a)) / (2.0 * pi) + 0.5) * sectors;
    counts[static_cast<std::size_t>(std::min(static_cast<int>(ring), rings - 1) * sectors +
                                    std::min(static_cast<int>(sector), sectors - 1))] += 1.0;
  }
  double chi = 0.0;
  const double expected = static_cast<double>(drawn.size()) / (rings * sectors);
  for (const double count : counts)
    chi += (count - expected) * (count - expected) / expected;
  const double freedom = rings * sectors - 1.0;
  // The smallest disc is 3000 float steps wide: of its rings a step or so is rounded, which is the tenth of a percent
  // that a count of 833 could not show.
  CHECK((chi - freedom) / std::sqrt(2.0 * freedom) < 4.8);
  // Rounding of a direction, 6e-8, puts as much of the rim outside.
  CHECK(static_cast<double>(outside) / static_cast<double>(drawn.size()) <=
        4.0 * 6e-8 / (radius_deg * pi / 180.0) + 1e-4);
}
