#pragma once
/// Draws of the device's samplers, and bins to count them in.
#include "host/tune/variant_list.h"
#include "tests/support/chi_square.h"
#include "tests/support/device.h"
#include "tests/support/sky.h"
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

namespace pointgi::test {

constexpr double pi = 3.14159265358979323846;

/// There are some 150 chi-square tests in tests/stat: right samplers would fail one of them for 1.5 % of all seeds
/// (Sidak), and the seeds are fixed. A sampler that is wrong by what a picture shows has a p of 1e-10 and less.
constexpr double least_p = 1e-4;

inline void check_fit(const std::vector<double>& counts, const std::vector<double>& masses) {
  const ChiSquare fit = chi_square(counts, masses);
  CAPTURE(fit.statistic, fit.freedom);
  CHECK(fit.freedom >= 1.0);
  CHECK(fit.p > least_p);
}

inline Vector3d vector_of(const cl_float4& v) {
  return {v.s[0], v.s[1], v.s[2]};
}

inline cl_float4 float4_of(const Vector3d& v, double w = 0.0) {
  return {{static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()), static_cast<float>(w)}};
}

inline cl::Kernel sampler(const char* name) {
  const Program program = samplers_program(plain_variant(TraversalForm::wide));
  return session().kernel(program.file, program.options, name);
}

/// What the kernel draws by `samples` fours of random numbers, `each` vectors a sample.
template <typename... Args>
std::vector<cl_float4> draw(const char* name, std::size_t samples, std::size_t each, unsigned seed,
                            const Args&... args) {
  std::mt19937 random(seed);
  std::vector<cl_float4> numbers(samples);
  for (cl_float4& number : numbers) {
    const std::array<double, 4> u = four_numbers(random);
    for (std::size_t k = 0; k < 4; ++k)
      number.s[k] = static_cast<float>(u[k]);
  }
  const auto u = session().upload(numbers);
  const auto drawn = session().allocate<cl_float4>(each * samples);
  cl::Kernel kernel = sampler(name);
  session().launch(kernel, LaunchShape::line(samples), args..., u, drawn, static_cast<cl_uint>(samples));
  return session().download(drawn, each * samples);
}

/// Directions by their height 1 - cosine and azimuth about an axis; one more bin for all beyond the last edge.
class PolarBins {
public:
  PolarBins(const Vector3d& axis, std::vector<double> edges, int sectors)
      : axis_(axis.normalized()), a_(axis_.unitOrthogonal()), b_(axis_.cross(a_)), edges_(std::move(edges)),
        sectors_(sectors) {}

  std::size_t size() const { return (edges_.size() - 1) * static_cast<std::size_t>(sectors_) + 1; }

  std::size_t of(const Vector3d& direction) const {
    const double height = height_of(direction);
    if (height >= edges_.back()) return size() - 1;
    const auto ring = std::upper_bound(edges_.begin(), edges_.end(), height) - edges_.begin() - 1;
    return static_cast<std::size_t>(std::max<std::ptrdiff_t>(ring, 0)) * static_cast<std::size_t>(sectors_) +
           sector_of(direction);
  }

  /// 1 - cosine, by the chord: a cosine near 1 would have lost its digits.
  double height_of(const Vector3d& d) const {
    return d.dot(axis_) > 0.0 ? 0.5 * (d - axis_).squaredNorm() : 2.0 - 0.5 * (d + axis_).squaredNorm();
  }

  /// Of a density by its height alone, by the midpoint rule: 64 steps a ring, which may be twice as wide as high: 1e-4.
  template <typename Density>
  std::vector<double> masses(const Density& density) const {
    constexpr int steps = 64;
    std::vector<double> result;
    double rest = 1.0;
    for (std::size_t ring = 0; ring + 1 < edges_.size(); ++ring) {
      const double step = (edges_[ring + 1] - edges_[ring]) / steps;
      double mass = 0.0;
      for (int k = 0; k < steps; ++k)
        mass += density(edges_[ring] + (k + 0.5) * step) * step * 2.0 * pi;
      result.insert(result.end(), static_cast<std::size_t>(sectors_), mass / sectors_);
      rest -= mass;
    }
    result.push_back(std::fmax(rest, 0.0));
    return result;
  }

private:
  std::size_t sector_of(const Vector3d& d) const {
    const double turn = std::atan2(d.dot(b_), d.dot(a_)) / (2.0 * pi) + 0.5;
    return static_cast<std::size_t>(std::min(static_cast<int>(turn * sectors_), sectors_ - 1));
  }

  Vector3d axis_, a_, b_;
  std::vector<double> edges_;
  int sectors_;
};

inline std::vector<double> even_edges(double last, int rings) {
  std::vector<double> edges;
  for (int k = 0; k <= rings; ++k)
    edges.push_back(last * k / rings);
  return edges;
}

/// 0, `first`, and so on in proportion to `last`.
inline std::vector<double> log_edges(double first, double last, int rings) {
  std::vector<double> edges{0.0};
  for (int k = 0; k < rings; ++k)
    edges.push_back(first * std::pow(last / first, static_cast<double>(k) / (rings - 1)));
  return edges;
}

/// Pairs of numbers that should be even over [0, 1)^2, of several kinds that should come as often as their shares say.
class EvenSquares {
public:
  explicit EvenSquares(std::vector<double> shares, int side = 6)
      : shares_(std::move(shares)), side_(side),
        counts_(shares_.size() * static_cast<std::size_t>(side) * static_cast<std::size_t>(side)) {}

  void count(std::size_t kind, double u, double v) {
    const auto cell = [&](double x) { return std::clamp(static_cast<int>(x * side_), 0, side_ - 1); };
    counts_.at((kind * static_cast<std::size_t>(side_) + static_cast<std::size_t>(cell(u))) *
                   static_cast<std::size_t>(side_) +
               static_cast<std::size_t>(cell(v))) += 1.0;
  }

  void check() const {
    std::vector<double> masses;
    for (const double share : shares_)
      masses.insert(masses.end(), static_cast<std::size_t>(side_ * side_), share / (side_ * side_));
    check_fit(counts_, masses);
  }

private:
  std::vector<double> shares_;
  int side_;
  std::vector<double> counts_;
};

/// Turn about the axis, in [0, 1).
inline double turn_about(const Vector3d& axis, const Vector3d& v) {
  const Vector3d a = axis.unitOrthogonal(), b = axis.cross(a);
  return std::atan2(v.dot(b), v.dot(a)) / (2.0 * pi) + 0.5;
}

/// Places of a unit sphere of directions that is cut to heights below `last`: height over `last`, and turn.
inline void count_in_cone(EvenSquares& squares, std::size_t kind, const Vector3d& axis, double last,
                          const Vector3d& d) {
  const double height = PolarBins(axis, {0.0, 2.0}, 1).height_of(d);
  // Rounding of a direction, 1e-7, beyond the rim of a cone that is sqrt(2 last) wide.
  if (!(height < last + 3e-7 * std::sqrt(2.0 * last))) FAIL("outside the cone by " << height / last);
  squares.count(kind, height / last, turn_about(axis, d));
}

/// Places of a disc across `normal`, from its middle.
inline void count_in_disc(EvenSquares& squares, std::size_t kind, const Vector3d& normal, double radius,
                          const Vector3d& from_middle) {
  if (!(std::fabs(from_middle.dot(normal)) < 1e-6)) FAIL("beside the disc by " << from_middle.dot(normal));
  if (!(from_middle.norm() < radius + 1e-6)) FAIL("outside the disc by " << from_middle.norm() - radius);
  squares.count(kind, from_middle.squaredNorm() / (radius * radius), turn_about(normal, from_middle));
}

} // namespace pointgi::test
