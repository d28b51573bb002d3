/// What glass, the Phong lobe and the memory of media are on the device, against formulas in double (truths.md §1).
#include "host/tune/variant_list.h"
#include "tests/support/device.h"
#include "tests/support/fresnel.h"
#include <catch2/catch.hpp>
#include <cmath>

using namespace pointgi;
using namespace pointgi::test;

namespace {

constexpr double pi = 3.14159265358979323846;

template <typename Out, typename In>
std::vector<Out> probe(const char* kernel_name, const std::vector<In>& in, std::size_t out_each = 1) {
  Session& device = session();
  const auto input = device.upload(in);
  const auto output = device.allocate<Out>(in.size() * out_each);
  cl::Kernel kernel = device.kernel("test/probe.cl", build_options(reference_variant()), kernel_name);
  device.launch(kernel, LaunchShape::line(in.size()), input, output, static_cast<cl_uint>(in.size()));
  return device.download(output, in.size() * out_each);
}

struct Bent {
  double reflectance, cosine_t, refracted_z, reflected_z, left;
};

/// By the angle of incidence in degrees.
Bent glass(double degrees, double eta, double length = 0.0, double absorption = 0.0) {
  const cl_float4 in = {{static_cast<float>(std::cos(degrees * pi / 180.0)), static_cast<float>(eta),
                         static_cast<float>(length), static_cast<float>(absorption)}};
  const auto out = probe<cl_float4>("probe_glass", std::vector<cl_float4>{in}, 2);
  return {out[0].s[0], out[0].s[1], out[0].s[2], out[0].s[3], out[1].s[0]};
}

} // namespace

TEST_CASE("glass reflects what Fresnel says") {
  // 1e-4: the truths are printed with four digits.
  CHECK(glass(0.0, 1.5).reflectance == Approx(0.04).margin(1e-4));
  CHECK(glass(60.0, 1.5).reflectance == Approx(0.08919).margin(1e-4));
  CHECK(glass(85.0, 1.5).reflectance == Approx(0.6128).margin(1e-4));
  CHECK(glass(0.0, 1000.0).reflectance == Approx(0.99601).margin(1e-4));
  const double f = glass(0.0, 1.5).reflectance;
  CHECK(2.0 * f / (1.0 + f) == Approx(0.0769).margin(1e-4));
  // Brewster: of light that swings along the plane of incidence nothing, so half of the other kind; a minimum of that
  // half.
  const double brewster = std::atan(1.5) * 180.0 / pi;
  CHECK(brewster == Approx(56.310).margin(1e-3));
  const double across = std::pow((1.0 - 1.5 * 1.5) / (1.0 + 1.5 * 1.5), 2);
  CHECK(glass(brewster, 1.5).reflectance == Approx(0.5 * across).margin(1e-4));
  for (const double eta : {1.0 / 1.5, 1.2, 1.5, 2.4})
    for (double degrees = 0.0; degrees < 89.5; degrees += 1.0) {
      CAPTURE(eta, degrees);
      if (std::fabs(eta * 1.5 - 1.0) < 1e-9 && std::fabs(degrees - 42.0) < 1.0)
        continue; // steep next to the critical angle
      CHECK(glass(degrees, eta).reflectance == Approx(fresnel(degrees, eta)).margin(1e-4));
    }
}

TEST_CASE("glass reflects all light beyond the critical angle, and none where nothing changes") {
  CHECK(glass(41.80, 1.0 / 1.5).reflectance < 1.0);
  CHECK(glass(41.82, 1.0 / 1.5).reflectance == 1.0);
  CHECK(glass(41.82, 1.0 / 1.5).cosine_t == 0.0);
  for (const double degrees : {0.0, 30.0, 60.0, 85.0}) {
    const Bent same = glass(degrees, 1.0);
    CHECK(same.reflectance == Approx(0.0).margin(1e-6));
    CHECK(same.refracted_z == Approx(-std::cos(degrees * pi / 180.0)).margin(1e-6));
  }
}

TEST_CASE("refracted rays keep Snell's law, reflected ones their angle, absorbed ones Beer's law") {
  for (const double eta : {1.0 / 1.5, 1.33, 1.5})
    for (const double degrees : {0.0, 20.0, 41.0, 60.0, 85.0}) {
      const double sine = std::sin(degrees * pi / 180.0) / eta;
      const Bent bent = glass(degrees, eta);
      CHECK(bent.reflected_z == Approx(std::cos(degrees * pi / 180.0)).margin(1e-6));
      if (sine < 1.0) CHECK(bent.refracted_z == Approx(-std::sqrt(1.0 - sine * sine)).margin(1e-5));
    }
  CHECK(glass(0.0, 1.5, 0.25, 3.0).left == Approx(std::exp(-0.75)).margin(1e-6));
}

TEST_CASE("the Phong lobe is drawn by its own density, and reflects no more than it gets") {
  std::vector<cl_float4> in;
  for (const float exponent : {1.0f, 20.0f, 1000.0f})
    for (int i = 0; i < 64; ++i)
      for (int j = 0; j < 64; ++j)
        in.push_back(
            {{(static_cast<float>(i) + 0.5f) / 64.0f, (static_cast<float>(j) + 0.5f) / 64.0f, exponent, 0.3f}});
  const auto out = probe<cl_float4>("probe_phong", in);
  for (std::size_t k = 0; k < 3; ++k) {
    const double exponent = in[4096 * k].s[2];
    double sum = 0.0;
    for (std::size_t i = 4096 * k; i < 4096 * (k + 1); ++i) {
      REQUIRE(out[i].s[3] == Approx(1.0).margin(1e-5));
      REQUIRE(out[i].s[1] == Approx(out[i].s[2]).epsilon(1e-3)); // weight x density = lobe x cosine
      sum += out[i].s[0];
    }
    // Mean cosine under (n + 1) / (2 pi) cos^n: (n + 1) / (n + 2); 1e-3: that of the midpoint rule over 64 strata.
    CHECK(sum / 4096.0 == Approx((exponent + 1.0) / (exponent + 2.0)).margin(1e-3));
  }
}

TEST_CASE("a ray remembers the glass around it, innermost first") {
  const cl_uint none = 0xffffffffu;
  const auto media = [](std::initializer_list<unsigned> steps) {
    cl_ulong packed = 0;
    unsigned k = 0;
    for (const unsigned step : steps)
      packed |= static_cast<cl_ulong>(step) << (8 * k++);
    const auto out = probe<cl_uint4>("probe_media", std::vector<cl_ulong>{packed});
    return std::vector<cl_uint>(out[0].s, out[0].s + 4);
  };
  const auto leave = [](unsigned m) { return 128 + m; };
  using List = std::vector<cl_uint>;
  CHECK(media({}) == List{none, none, none, none});
  CHECK(media({7, 3}) == List{3, 7, none, none});
  CHECK(media({7, 3, leave(3)}) == List{7, none, none, none});
  CHECK(media({7, 3, leave(7)}) == List{3, none, none, none});
  CHECK(media({7, 3, 7}) == List{7, 3, none, none});
  CHECK(media({leave(9), 1, 2, 3, 4, 5}) == List{5, 4, 3, 2});
  CHECK(media({1, 2, 3, 4, leave(2), leave(4)}) == List{3, 1, none, none});
}
