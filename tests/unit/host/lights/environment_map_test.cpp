/// Environment maps: where their pixels lie in the scene, what they send, how they are drawn from, and files that are
/// none.
#include "host/error.h"
#include "host/image/picture_writer.h"
#include "host/lights/environment_map.h"
#include "host/scene/shares.h"
#include "tests/support/hdr_bytes.h"
#include "tests/support/sky.h"
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

using namespace pointgi;
using namespace pointgi::test;

namespace {

constexpr double pi = 3.14159265358979323846;

double luminance(const Vector3d& c) {
  return c.dot(Vector3d(0.2126, 0.7152, 0.0722));
}

/// Irradiance by drawing from the map: the mean of L cos / density over `samples` directions.
double sampled_irradiance(const EnvironmentMap& map, const Vector3d& normal, int samples) {
  std::mt19937 random(5);
  double sum = 0.0;
  for (int i = 0; i < samples; ++i) {
    const SkySample sample = sample_map(map, four_numbers(random));
    const SkyTexel& texel = map.texels[sample.texel];
    sum += std::fmax(0.0, sample.direction.dot(normal)) * static_cast<double>(texel.radiance[0]) /
           static_cast<double>(texel.density);
  }
  return sum / samples;
}

} // namespace

TEST_CASE("a map's middle is forward, its right side right, its top up") {
  // 4 x 2 texels of radiance 1 to 8.
  const RgbImage image = grey_image(4, 2, [](int x, int y) { return static_cast<float>(1 + 4 * y + x); });
  const auto seen = [&](const SkyFrame& frame, const Vector3d& direction) {
    const EnvironmentMap map = make_environment_map(image, frame, 1.0, "map");
    return map.texels[texel_towards(map, direction.normalized())].radiance[0];
  };
  const SkyFrame z_up = sky_frame(UpAxis::z, 0.0), y_up = sky_frame(UpAxis::y, 0.0);
  // Columns from the left: behind to left, left to forward, forward to right, right to behind.
  CHECK(seen(z_up, {0.1, 1, 0.1}) == 3.0f);
  CHECK(seen(z_up, {-0.1, 1, 0.1}) == 2.0f);
  CHECK(seen(z_up, {1, -0.1, 0.1}) == 4.0f);
  CHECK(seen(z_up, {-1, -0.1, 0.1}) == 1.0f);
  CHECK(seen(z_up, {0.1, 1, -0.1}) == 7.0f);
  CHECK(seen(y_up, {0.1, 0.1, -1}) == 3.0f);
  CHECK(seen(y_up, {1, -0.1, 0.1}) == 8.0f);
  // Turned by 90 degrees clockwise its middle is on the right.
  CHECK(seen(sky_frame(UpAxis::z, 90.0), {1, -0.1, 0.1}) == 3.0f);
  CHECK(seen(sky_frame(UpAxis::y, 90.0), {1, 0.1, 0.1}) == 3.0f);
  // North, east and the zenith.
  CHECK((sky_direction(z_up, 90.0, 0.0) - Vector3d(1, 0, 0)).norm() < 1e-12);
  CHECK((sky_direction(y_up, 0.0, 0.0) - Vector3d(0, 0, -1)).norm() < 1e-12);
  CHECK((sky_direction(y_up, 123.0, 90.0) - Vector3d(0, 1, 0)).norm() < 1e-12);
  CHECK((sky_direction(sky_frame(UpAxis::z, 30.0), 0.0, 0.0) - Vector3d(0.5, std::sqrt(0.75), 0)).norm() < 1e-12);
}

TEST_CASE("a constant map is told as one and sends pi times its radiance to every surface") {
  const auto [width, height] = GENERATE(std::pair(64, 32), std::pair(7, 5), std::pair(2, 1), std::pair(1, 1));
  RgbImage image = grey_image(width, height, [](int, int) { return 1.5f; });
  const EnvironmentMap map = make_environment_map(image, sky_frame(UpAxis::z, 17.0), 2.0, "map");
  REQUIRE(map.constant);
  CHECK(*map.constant == Vector3d(3.0, 3.0, 3.0));
  CHECK_FALSE(map.is_black);
  CHECK(map.warnings.empty());
  CHECK(mean_radiance(map).isApprox(Vector3d(3.0, 3.0, 3.0), 1e-12));
  // The horizon crosses texels, each divided into 16 x 16: of one texel, one part in a hundred.
  for (const Vector3d& normal : {Vector3d(0, 0, 1), Vector3d(0, 0, -1), Vector3d(0.6, 0, 0.8), Vector3d(1, 0, 0)})
    CHECK(irradiance(map, normal).x() == Approx(3.0 * pi).epsilon(height > 4 ? 1e-3 : 1e-2));
  for (const SkyTexel& texel : map.texels) // shares of rows and columns are rounded to 2^-24
    CHECK(texel.density == Approx(1.0 / (4.0 * pi)).epsilon(1e-4));
  image.rgb[4] = 1.25f;
  CHECK(make_environment_map(image, sky_frame(UpAxis::z, 17.0), 2.0, "map").constant.has_value() ==
        (width * height == 1));
}

TEST_CASE("tables of a map are shares that kernels can search, and densities are what they say") {
  const EnvironmentMap map = make_environment_map(spotted_image(48, 24), sky_frame(UpAxis::y, 0.0), 1.0, "map");
  double total = 0.0, integral = 0.0;
  std::size_t uneven = 0, idle = 0;
  for (std::size_t i = 0; i < map.texels.size(); ++i)
    total += luminance(Vector3d(map.texels[i].radiance[0], map.texels[i].radiance[1], map.texels[i].radiance[2])) *
             static_cast<double>(map.rows[i / 48].solid_angle);
  for (std::size_t i = 0; i < map.texels.size(); ++i) {
    const double cumulative = static_cast<double>(map.columns[i]);
    uneven += cumulative / smallest_share != std::round(cumulative / smallest_share);
    uneven += i % 48 != 0 && map.columns[i] < map.columns[i - 1];
    const SkyTexel& texel = map.texels[i];
    const double light = luminance(Vector3d(texel.radiance[0], texel.radiance[1], texel.radiance[2]));
    idle += (light > 0.0) != (texel.density > 0.0f);
    const double solid_angle = static_cast<double>(map.rows[i / 48].solid_angle);
    integral += static_cast<double>(texel.density) * solid_angle;
    // Shares of a row and in it are rounded by up to 2^-24 each.
    if (light > 0.0)
      CHECK(static_cast<double>(texel.density) * solid_angle == Approx(light * solid_angle / total).margin(2e-7));
  }
  CHECK(uneven == 0);
  CHECK(idle == 0);
  CHECK(integral == Approx(1.0).epsilon(1e-6));
  for (std::size_t y = 0; y < 24; ++y)
    CHECK(map.columns[48 * y + 47] == 1.0f);
  CHECK(map.rows.back().cumulative == 1.0f);
  // Solid angles of the texels make a sphere.
  double sphere = 0.0;
  for (const SkyRow& row : map.rows)
    sphere += 48.0 * static_cast<double>(row.solid_angle);
  CHECK(sphere == Approx(4.0 * pi).epsilon(1e-6));
}

TEST_CASE("directions drawn from a map are distributed as their density says") {
  const auto [width, height] = GENERATE(std::pair(24, 12), std::pair(5, 7));
  const EnvironmentMap map = make_environment_map(spotted_image(width, height), sky_frame(UpAxis::y, 40.0), 1.0, "map");
  std::mt19937 random(3);
  Histogram histogram(map);
  for (int i = 0; i < 400'000; ++i) {
    const SkySample sample = sample_map(map, four_numbers(random));
    REQUIRE(sample.direction.norm() == Approx(1.0).epsilon(1e-6)); // from_pole and span are floats
    histogram.count(sample.direction);
    // In doubles only the borders of texels could be taken for the neighbour's.
    REQUIRE(map.texels[sample.texel].density > 0.0f);
  }
  // A chi-square beyond this has a probability of 1e-6 (normal approximation).
  CHECK(histogram.deviation() < 4.8);
}

TEST_CASE("one bright pixel, anywhere, gives the irradiance of its solid angle") {
  const int width = 512, height = 256;
  for (const auto& [x, y] : {std::pair(100, 60), std::pair(0, 0), std::pair(511, 255), std::pair(300, 127)}) {
    INFO("pixel " << x << ", " << y);
    const RgbImage image =
        grey_image(width, height, [x = x, y = y](int i, int j) { return i == x && j == y ? 1000.0f : 0.0f; });
    const EnvironmentMap map = make_environment_map(image, sky_frame(UpAxis::z, 0.0), 1.0, "map");
    const double t0 = pi * y / height, t1 = pi * (y + 1) / height;
    const double solid_angle = 2.0 * pi / width * (std::cos(t0) - std::cos(t1));
    const double azimuth = 360.0 * ((x + 0.5) / width - 0.5), elevation = 90.0 - 180.0 * (y + 0.5) / height;
    const Vector3d towards = sky_direction(map.frame, azimuth, elevation);
    // Cosines across a texel of 0.7 degrees: within 1e-4.
    CHECK(irradiance(map, towards).x() == Approx(1000.0 * solid_angle).epsilon(1e-4));
    CHECK(sampled_irradiance(map, towards, 64) == Approx(1000.0 * solid_angle).epsilon(1e-4));
    CHECK(irradiance(map, -towards).norm() == 0.0);
    CHECK(mean_radiance(map).x() == Approx(1000.0 * solid_angle / (4.0 * pi)).epsilon(1e-9));
    // All of it is drawn, and drawn from nowhere else.
    CHECK(map.texels[static_cast<std::size_t>(y * width + x)].density == Approx(1.0 / solid_angle).epsilon(1e-6));
    CHECK(texel_towards(map, towards) == static_cast<std::size_t>(y * width + x));
  }
}

TEST_CASE("rows at the poles of a fine map keep their digits") {
  // 1 - cos of the first row's edge is 3e-7: five steps of a float below 1.
  const int width = 64, height = 4096;
  const EnvironmentMap map =
      make_environment_map(grey_image(width, height, [](int x, int) { return 1.0f + static_cast<float>(x % 2); }),
                           sky_frame(UpAxis::z, 0.0), 1.0, "map");
  for (const int row : {0, 1, height - 1}) {
    const double exact = 2.0 * pi / width * 2.0 * std::sin(pi * (row + 0.5) / height) * std::sin(0.5 * pi / height);
    CHECK(static_cast<double>(map.rows[static_cast<std::size_t>(row)].solid_angle) == Approx(exact).epsilon(1e-6));
  }
  const double first = static_cast<double>(map.rows[0].cumulative);
  for (const double place : {0.0, 0.3, 0.9}) {
    const SkySample top = sample_map(map, {0.5 * first, 0.5, 0.5, place});
    const double angle = std::atan2(std::hypot(top.direction.x(), top.direction.y()), top.direction.z());
    CHECK(angle == Approx(std::sqrt(place) * pi / height).epsilon(1e-5));
  }
}

TEST_CASE("values that are no radiance are taken as 0 and counted") {
  RgbImage image = grey_image(4, 2, [](int, int) { return 1.0f; });
  image.rgb[0] = -1.0f;
  image.rgb[1] = std::numeric_limits<float>::quiet_NaN();
  image.rgb[3] = std::numeric_limits<float>::infinity();
  image.rgb[9] = 1e38f;
  const EnvironmentMap map = make_environment_map(image, sky_frame(UpAxis::z, 0.0), 10.0, "sky.exr");
  REQUIRE(map.warnings.size() == 1);
  CHECK_THAT(map.warnings[0], Catch::Contains("sky.exr") && Catch::Contains("3 of 8 pixels"));
  CHECK(map.texels[0].radiance[0] == 0.0f);
  CHECK(map.texels[0].radiance[1] == 0.0f);
  CHECK(map.texels[0].radiance[2] == 10.0f);
  CHECK(map.texels[1].radiance[0] == 0.0f);
  CHECK(map.texels[3].radiance[0] == 0.0f);
  const EnvironmentMap black =
      make_environment_map(grey_image(4, 2, [](int, int) { return 0.0f; }), sky_frame(UpAxis::z, 0.0), 1.0, "map");
  CHECK(black.is_black);
  for (const SkyTexel& texel : black.texels)
    CHECK(std::isfinite(texel.density));
  CHECK(make_environment_map(grey_image(5, 2, [](int x, int) { return static_cast<float>(x); }),
                             sky_frame(UpAxis::z, 0.0), 1.0, "map")
            .warnings.size() == 1); // stretched
}

TEST_CASE("maps are read from hdr and exr files alike") {
  const TemporaryFolder folder;
  std::vector<Rgbe> pixels;
  for (int i = 0; i < 16 * 8; ++i)
    pixels.push_back(rgbe(static_cast<float>(i), 64.0f, 0.5f * static_cast<float>(i)));
  const std::string hdr = folder.write("sky.hdr", hdr_file(16, 8, pixels, HdrCode::new_runs));
  const SkyFrame frame = sky_frame(UpAxis::z, 0.0);
  const EnvironmentMap from_hdr = load_environment_map(hdr, frame, 2.0);
  const std::string exr = folder.file("sky.exr");
  write_exr(exr, 16, 8, 16, from_hdr.texels);
  const EnvironmentMap from_exr = load_environment_map(exr, frame, 1.0);
  CHECK(from_hdr.warnings.empty());
  CHECK(from_exr.width == 16);
  CHECK(from_exr.height == 8);
  CHECK(from_hdr.texels[5].radiance[0] == 10.0f);
  std::size_t different = 0;
  for (std::size_t i = 0; i < 16 * 8; ++i)
    for (int k = 0; k < 3; ++k)
      different += from_hdr.texels[i].radiance[k] != from_exr.texels[i].radiance[k];
  CHECK(different == 0);
  CHECK(device_texels(from_hdr, 4.0)[5].radiance[0] == 2.5f);
  CHECK(device_texels(from_hdr, 4.0)[5].density == from_hdr.texels[5].density);
}

TEST_CASE("files that are no environment map are refused by name") {
  const TemporaryFolder folder;
  const auto message = [](const std::string& path) {
    try {
      load_environment_map(path, sky_frame(UpAxis::z, 0.0), 1.0);
    } catch (const Error& error) {
      CHECK(error.kind() == ErrorKind::input);
      CHECK_FALSE(error.remedy().empty());
      return std::string(error.what());
    }
    return std::string();
  };
  using Catch::Contains;
  CHECK_THAT(message(folder.write("sky.png", "x")), Contains("sky.png") && Contains(".hdr or .exr"));
  CHECK_THAT(message(folder.file("none.hdr")), Contains("none.hdr"));
  CHECK_THAT(message(folder.file("none.exr")), Contains("none.exr"));
  CHECK_THAT(message(folder.write("bad.hdr", "x")), Contains("bad.hdr: byte 0"));
  const std::string crop = folder.file("crop.exr");
  write_exr(crop, 16, 8, 20, std::vector<SkyTexel>(16 * 8));
  CHECK_THAT(message(crop), Contains("crop.exr") && Contains("data window"));
  // An exr file that is cut off anywhere.
  const std::string whole = folder.file("whole.exr");
  write_exr(whole, 16, 8, 16, std::vector<SkyTexel>(16 * 8, SkyTexel{{1.0f, 2.0f, 3.0f}, 0.0f}));
  CHECK(message(whole).empty());
  const std::string bytes = contents(whole);
  std::size_t refused = 0, cuts = 0;
  for (std::size_t length = 0; length < bytes.size(); length += 50, ++cuts)
    refused += message(folder.write("cut.exr", bytes.substr(0, length))).find("cut.exr") != std::string::npos;
  CHECK(refused == cuts);
}
