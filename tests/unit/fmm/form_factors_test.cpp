/// Exchange of points against form factors of their surfaces (truths.md section 1), at three spacings.
#include "fmm/ref/direct_sum.h"
#include "tests/support/exchange.h"
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;

namespace {

constexpr double pi = 3.14159265358979;

/// Form factor from the points [to_begin, to_end) to [from_begin, from_end): area-weighted mean of H for B = 1 there.
double form_factor(const std::vector<Splat>& s, std::size_t receivers_begin, std::size_t receivers_end,
                   std::size_t sources_begin, std::size_t sources_end) {
  std::vector<double> b(3 * s.size(), 0.0);
  std::fill(b.begin() + 3 * sources_begin, b.begin() + 3 * sources_end, 1.0);
  std::vector<std::uint32_t> receivers;
  for (std::size_t i = receivers_begin; i < receivers_end; ++i)
    receivers.push_back(static_cast<std::uint32_t>(i));
  const auto h = direct_sum(s, b, receivers);
  double sum = 0.0, area = 0.0;
  for (std::size_t k = 0; k < receivers.size(); ++k) {
    sum += h[3 * k] * s[receivers[k]].area;
    area += s[receivers[k]].area;
  }
  return sum / area;
}

void add_disc(std::vector<Splat>& splats, int count, double radius, double height, double normal) {
  const double golden = pi * (3.0 - std::sqrt(5.0));
  for (int i = 0; i < count; ++i) {
    const double r = radius * std::sqrt((i + 0.5) / count), a = golden * i;
    splats.push_back(
        area_splat(0.5 + r * std::cos(a), 0.5 + r * std::sin(a), height, 0, 0, normal, pi * radius * radius / count));
  }
}

/// Each at most 0.7 of the one before, or too small to matter: positions are floats, so 1e-6 is noise.
void check_falls(const std::vector<double>& errors, double last) {
  for (std::size_t k = 1; k < errors.size(); ++k)
    CHECK((errors[k] <= 0.7 * errors[k - 1] || errors[k] < 2e-6));
  CHECK(errors.back() <= last);
}

} // namespace

TEST_CASE("form factors: unit cube") {
  std::vector<double> parallel, perpendicular, row_sum;
  for (const int m : {8, 16, 32}) {
    const auto s = inside_cube(m);
    const std::size_t face = static_cast<std::size_t>(m) * m;
    parallel.push_back(std::abs(form_factor(s, 0, face, face, 2 * face) - 0.199825));
    perpendicular.push_back(std::abs(form_factor(s, 0, face, 2 * face, 3 * face) - 0.200044));
    row_sum.push_back(std::abs(form_factor(s, 0, face, 0, 6 * face) - 1.0));
  }
  check_falls(parallel, 1e-4); // as the square of the spacing: measured 5.9e-5
  check_falls(row_sum, 6e-4);  // as the spacing, the rows at the edges: measured 4.2e-4
  // Edges shared: the errors of first and later rows differ in sign, so what falls evenly is a bound on them.
  for (int k = 0; k < 3; ++k)
    CHECK(perpendicular[k] <= 3e-3 / (8 << k));
}

TEST_CASE("form factors: coaxial discs") {
  std::vector<double> errors;
  for (const int count : {250, 1000, 4000}) {
    std::vector<Splat> s;
    add_disc(s, count, 0.3, 0.3, 1.0);
    add_disc(s, count, 0.3, 0.6, -1.0);
    const double f = form_factor(s, 0, count, count, 2 * static_cast<std::size_t>(count));
    errors.push_back(std::abs(f - 0.381966));
  }
  check_falls(errors, 1e-6);
}

TEST_CASE("form factors: sphere") {
  std::vector<double> worst;
  for (const int count : {1000, 4000, 16000}) {
    const auto s = inside_sphere(count);
    std::vector<double> sums;
    for (const int i : {0, 7, count / 2, count - 1})
      sums.push_back(std::abs(form_factor(s, i, i + 1, 0, count) - 1.0));
    worst.push_back(*std::max_element(sums.begin(), sums.end()));
    const ExchangePoint a(s[0]), b(s[count / 2]);
    // F_ij = A_j / (4 pi R^2) = 1 / n, at any distance. Float positions and normals: 1e-5.
    CHECK(point_exchange(a, b) * count == Approx(1.0).epsilon(1e-5));
  }
  check_falls(worst, 3e-4); // the point itself, and neighbours that are taken for nearer than they are: 2 / n
}

namespace {

/// Point-to-polygon: H at the origin, normal n, from unit radiosity of the square of side 1 (Lambert 1760), unclamped.
double lambert(const std::array<Eigen::Vector3d, 4>& corners, const Eigen::Vector3d& n) {
  double sum = 0.0;
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector3d &a = corners[k], &b = corners[(k + 1) % 4];
    const Eigen::Vector3d cross = a.cross(b);
    sum += std::atan2(cross.norm(), a.dot(b)) * n.dot(cross.normalized());
  }
  return std::abs(sum) / (2.0 * pi);
}

} // namespace

TEST_CASE("form factors: one square splat close by") {
  ExchangePoint here;
  here.x = {0, 0, 0};
  here.n = {0, 0, 1};
  // As a single point A / (pi h^2) would be 130 %, 67 % and 33 % too much at h = 0.5, 0.7 and 1, and the upright one at
  // 0.5 67 %. What is left: the square's four quarters taken as discs, and below its diameter their softening.
  const double distances[] = {0.5, 0.7, 1.0, 2.0, 3.5}, allowed[] = {0.16, 0.06, 0.02, 0.003, 0.003};
  for (int k = 0; k < 5; ++k) {
    const double h = distances[k]; // in sides of the square
    CAPTURE(h);
    ExchangePoint there;
    there.area = 1.0;
    there.x = {0, 0, h};
    there.n = {0, 0, -1};
    CHECK(point_exchange(here, there) ==
          Approx(lambert({Eigen::Vector3d(-.5, -.5, h), {.5, -.5, h}, {.5, .5, h}, {-.5, .5, h}}, here.n))
              .epsilon(allowed[k]));
    // A wall that begins in the receiver's plane: the neighbour across an edge at h = 1/2.
    there.x = {h, 0, 0.5};
    there.n = {-1, 0, 0};
    CHECK(point_exchange(here, there) ==
          Approx(lambert({Eigen::Vector3d(h, -.5, 0), {h, .5, 0}, {h, .5, 1}, {h, -.5, 1}}, here.n)).epsilon(0.05));
  }
}

TEST_CASE("exchange stays finite and below 1 where splats touch, and is 0 with itself") {
  std::mt19937 random(3);
  std::normal_distribution<double> direction;
  std::uniform_real_distribution<double> exponent(-9.0, 0.0);
  ExchangePoint a, b;
  a.x = {0.5, 0.5, 0.5};
  for (int k = 0; k < 100000; ++k) {
    a.n = Eigen::Vector3d(direction(random), direction(random), direction(random)).normalized();
    b.n = Eigen::Vector3d(direction(random), direction(random), direction(random)).normalized();
    b.x = a.x + std::pow(10.0, exponent(random)) *
                    Eigen::Vector3d(direction(random), direction(random), direction(random)).normalized();
    b.area = std::pow(10.0, 2.0 * exponent(random));
    const double f = point_exchange(a, b);
    REQUIRE(f >= 0.0);
    REQUIRE(f <= 1.0);
  }
  CHECK(point_exchange(a, a) == 0.0);
  b.x = a.x;
  CHECK(point_exchange(a, b) == 0.0);
}
