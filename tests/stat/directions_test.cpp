/// Directions, places and chances that the kernels draw, against densities written here.
#include "tests/stat/samplers.h"

using namespace pointgi;
using namespace pointgi::test;

namespace {

constexpr std::size_t samples = 100'000;

Vector3d some_axis() {
  return GENERATE(Vector3d(0.0, 0.0, 1.0), Vector3d(0.0, 0.0, -1.0), Vector3d(0.36, -0.48, 0.8));
}

std::vector<double> counted(const PolarBins& bins, const std::vector<cl_float4>& drawn) {
  std::vector<double> counts(bins.size());
  for (const cl_float4& d : drawn) {
    if (!(std::fabs(vector_of(d).norm() - 1.0) < 1e-6)) FAIL("a direction is as long as " << vector_of(d).norm());
    counts[bins.of(vector_of(d))] += 1.0;
  }
  return counts;
}

} // namespace

TEST_CASE("directions by the cosine have the density cos / pi") {
  const Vector3d axis = some_axis();
  const PolarBins bins(axis, even_edges(1.0, 16), 12);
  const auto drawn = draw("probe_cosine", samples, 1, 1, float4_of(axis));
  check_fit(counted(bins, drawn), bins.masses([](double height) { return (1.0 - height) / pi; }));
}

TEST_CASE("directions of a cone are even over its solid angle") {
  const Vector3d axis = some_axis();
  // Half angles: 0.53 / 2 degrees as of the sun, half a sphere at most by sine^2 < 1, or all of it.
  const double half_deg = GENERATE(0.265, 0.53, 10.0, 60.0, 89.0, 180.0);
  CAPTURE(half_deg);
  const double sine = half_deg < 90.0 ? std::sin(half_deg * pi / 180.0) : 1.0;
  const double last = half_deg < 90.0 ? 2.0 * std::pow(std::sin(half_deg * pi / 360.0), 2) : 2.0;
  const PolarBins bins(axis, even_edges(last, 12), 12);
  EvenSquares squares({1.0}, 12);
  double off = 0.0;
  for (const cl_float4& d : draw("probe_cone", samples, 1, 2, float4_of(axis, sine * sine))) {
    count_in_cone(squares, 0, axis, last, vector_of(d));
    off = std::fmax(off, std::fabs(static_cast<double>(d.s[3]) / (2.0 * pi * last) - 1.0));
  }
  squares.check();
  // A float of sine^2 near 1 has the cosine, sqrt(1 - sine^2), to 6e-8 / cosine^2.
  CHECK(off < (half_deg == 89.0 ? 2e-4 : 1e-5));
}

TEST_CASE("points of a disc are even over its area") {
  const Vector3d axis = some_axis();
  const double radius = 0.03;
  EvenSquares squares({1.0}, 12);
  for (const cl_float4& p : draw("probe_disc", samples, 1, 3, float4_of(axis, radius)))
    count_in_disc(squares, 0, axis, radius, vector_of(p));
  squares.check();
}

TEST_CASE("directions of a Phong lobe have its density, however narrow the lobe") {
  const Vector3d axis = some_axis();
  const double exponent = GENERATE(0.0, 1.0, 50.0, 2000.0, 1e5, 1e6);
  CAPTURE(exponent);
  // From a hundredth of the lobe's height on: heights are 1e-6 and less at the largest exponents, of which a cosine in
  // float could tell apart some 16 values in all.
  const PolarBins bins(axis, log_edges(0.01 / (exponent + 1.0), 1.0, 28), 8);
  const auto drawn = draw("probe_phong_direction", samples, 1, 4, float4_of(axis, exponent));
  const auto density = [&](double height) {
    return (exponent + 1.0) / (2.0 * pi) * std::exp(exponent * std::log1p(-height));
  };
  check_fit(counted(bins, drawn), bins.masses(density));
  double off = 0.0;
  for (const cl_float4& d : drawn) {
    const double truth = density(bins.height_of(vector_of(d)));
    if (truth > 1e-6 * exponent) off = std::fmax(off, std::fabs(static_cast<double>(d.s[3]) / truth - 1.0));
  }
  // The kernel takes the density from a cosine: rounded to 6e-8, twice with the direction, and raised to the exponent.
  CHECK(off < 1e-4 + 2.0 * 1.2e-7 * exponent);
}

namespace {

constexpr cl_uint pixels = 8192, of_pixel = 64;

/// Numbers of all samples of pixels: [of_pixel * pixel + sample].
std::vector<cl_float4> stratified(cl_uint dimension, cl_uint vertex) {
  const auto drawn = session().allocate<cl_float4>(std::size_t{pixels} * of_pixel);
  cl::Kernel kernel = sampler("probe_stratified");
  session().launch(kernel, LaunchShape::line(pixels), dimension, vertex, of_pixel, 11u, drawn, pixels);
  return session().download(drawn, std::size_t{pixels} * of_pixel);
}

/// Whether u and v, of every pixel's sample `s`, are even together.
template <typename First, typename Second>
void check_even(cl_uint s, const First& u, const Second& v) {
  EvenSquares squares({1.0}, 12);
  for (std::size_t pixel = 0; pixel < pixels; ++pixel)
    squares.count(0, static_cast<double>(u(of_pixel * pixel + s)), static_cast<double>(v(of_pixel * pixel + s)));
  squares.check();
}

} // namespace

TEST_CASE("stratified numbers are even over pixels, at every sample and for every two uses") {
  const auto first = stratified(1, 0), second = stratified(2, 0), later = stratified(1, 1);
  const auto of = [](const std::vector<cl_float4>& numbers, int component) {
    return [&numbers, component](std::size_t i) { return numbers[i].s[component]; };
  };
  for (const cl_uint s : {0u, 1u, 5u, 31u, 32u, 45u}) {
    CAPTURE(s);
    check_even(s, of(first, 0), of(first, 1));
    check_even(s, of(first, 2), of(first, 3));
    check_even(s, of(first, 0), of(second, 0)); // two uses of one sample
    check_even(s, of(first, 1), of(second, 1));
    check_even(s, of(first, 0), of(first, 2));
    check_even(s, of(later, 0), of(later, 1));
    check_even(s, of(first, 0), of(later, 0));
  }
  // The cells of one pass and those of the next.
  check_even(3, of(first, 0), [&](std::size_t i) { return first[i + 32].s[0]; });
}

TEST_CASE("stratified numbers of a pass have one sample in every elementary interval of every prefix of 2^k") {
  const auto numbers = stratified(2, 0);
  for (std::size_t pixel = 0; pixel < 256; ++pixel)
    for (const std::size_t pass : {0u, 1u})
      for (unsigned k = 0; k <= 5; ++k)
        for (unsigned a = 0; a <= k; ++a) { // intervals of 2^-a by 2^-(k-a)
          const std::size_t count = std::size_t{1} << k, columns = std::size_t{1} << a, rows = count / columns;
          std::vector<int> hits(count);
          for (std::size_t s = 0; s < count; ++s) {
            const cl_float4& u = numbers[of_pixel * pixel + 32 * pass + s];
            const auto column = static_cast<std::size_t>(static_cast<double>(u.s[0]) * static_cast<double>(columns));
            const auto row = static_cast<std::size_t>(static_cast<double>(u.s[1]) * static_cast<double>(rows));
            hits[row * columns + column] += 1;
          }
          REQUIRE(hits == std::vector<int>(count, 1));
        }
}

TEST_CASE("Russian roulette lets rays live as often as it says") {
  struct Case {
    Vector3d factor;
    double longest, survival;
  };
  const auto [factor, longest, survival] =
      GENERATE(Case{{0.1, 0.3, 0.2}, 0.995, 0.3}, Case{{0.9, 0.3, 0.2}, 1.0, 0.9}, Case{{0.99, 2.0, 0.0}, 0.995, 0.995},
               Case{{0.02, 0.0, 0.0}, 1.0, 0.02});
  const cl_uint bounces = GENERATE(4u, 9u);
  CAPTURE(survival, bounces);
  const auto survivals = [&, f = float4_of(factor), l = static_cast<float>(longest)](cl_uint after) {
    const auto drawn = session().allocate<float>(samples);
    cl::Kernel kernel = sampler("probe_roulette");
    session().launch(kernel, LaunchShape::line(samples), f, l, after, 5u, drawn, static_cast<cl_uint>(samples));
    return session().download(drawn, samples);
  };
  std::vector<double> counts(2);
  for (const float stated : survivals(bounces)) {
    counts[stated > 0.0f ? 1 : 0] += 1.0;
    if (stated > 0.0f) REQUIRE(static_cast<double>(stated) == Approx(survival));
  }
  check_fit(counts, {1.0 - survival, survival});
  for (const float stated : survivals(3))
    REQUIRE(stated == 1.0f); // as yet no ray is asked
}
