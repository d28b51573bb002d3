#pragma once
/// Gaussians and the bytes of files that hold them, for tests that need files with exact contents.
#include "tests/support/ply_bytes.h"
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>
#include <zlib.h>

namespace pointgi::test {

struct TestGaussian {
  Eigen::Vector3d position;
  Eigen::Vector3d colour; ///< [0,1]
  double opacity = 0.5;
  Eigen::Vector3d log_scale;
  Eigen::Quaterniond rotation;

  Eigen::Vector3d normal() const { ///< the axis of the shortest scale
    int shortest = 0;
    log_scale.minCoeff(&shortest);
    return rotation.toRotationMatrix().col(shortest);
  }
  double radius() const { ///< sqrt(2) times the geometric mean of the two longer scales
    return std::sqrt(2.0) * std::exp(0.5 * (log_scale.sum() - log_scale.minCoeff()));
  }
  std::array<double, 4> wxyz() const { return {rotation.w(), rotation.x(), rotation.y(), rotation.z()}; }
};

/// Flat Gaussians at random places of a cube of 20 units, turned at random. Always the same ones.
inline std::vector<TestGaussian> some_gaussians(std::size_t count) {
  std::mt19937 random(7);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967295.0;
  };
  std::vector<TestGaussian> gaussians(count);
  for (std::size_t i = 0; i < count; ++i) {
    TestGaussian& g = gaussians[i];
    for (int k = 0; k < 3; ++k) {
      g.position[k] = uniform(-10, 10);
      g.colour[k] = uniform(0.05, 0.95);
      g.log_scale[k] = uniform(-3, -2);
    }
    g.log_scale[static_cast<int>(i % 3)] -= 2.0;
    g.opacity = uniform(0.15, 0.95);
    g.rotation = Eigen::Quaterniond(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)).normalized();
  }
  return gaussians;
}

inline std::uint8_t byte_of(double value) {
  return static_cast<std::uint8_t>(std::lround(std::min(255.0, std::max(0.0, value))));
}

inline std::string gzipped(const std::string& bytes) {
  z_stream z{};
  deflateInit2(&z, Z_DEFAULT_COMPRESSION, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
  std::string packed(deflateBound(&z, bytes.size()), '\0');
  z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  z.avail_in = static_cast<uInt>(bytes.size());
  z.next_out = reinterpret_cast<Bytef*>(packed.data());
  z.avail_out = static_cast<uInt>(packed.size());
  deflate(&z, Z_FINISH);
  packed.resize(z.total_out);
  deflateEnd(&z);
  return packed;
}

inline std::string splat_bytes(const std::vector<TestGaussian>& gaussians) {
  std::string bytes;
  for (const TestGaussian& g : gaussians) {
    for (int k = 0; k < 3; ++k)
      bytes += bytes_of(static_cast<float>(g.position[k]));
    for (int k = 0; k < 3; ++k)
      bytes += bytes_of(static_cast<float>(std::exp(g.log_scale[k])));
    for (int k = 0; k < 3; ++k)
      bytes += bytes_of(byte_of(255 * g.colour[k]));
    bytes += bytes_of(byte_of(255 * g.opacity));
    for (const double q : g.wxyz())
      bytes += bytes_of(byte_of(128 * q + 128));
  }
  return bytes;
}

/// A normal number of at most 65504 as a half float, rounded.
inline std::uint16_t half_of(double value) {
  int exponent = 0;
  const double mantissa = std::frexp(std::abs(value), &exponent); // 0.5 ... 1
  if (mantissa == 0.0) return 0;
  const auto bits =
      static_cast<std::uint32_t>(std::lround(mantissa * 2048)) + (static_cast<std::uint32_t>(exponent + 13) << 10);
  return static_cast<std::uint16_t>(bits | (value < 0 ? 0x8000u : 0u));
}

/// Ten bits for each value but the largest, from -sqrt(1/2) to sqrt(1/2), below two bits for the largest's place.
template <class Encode>
std::uint32_t smallest_three(std::array<double, 4> q, Encode encode) {
  std::size_t largest = 0;
  for (std::size_t k = 1; k < 4; ++k)
    if (std::abs(q[k]) > std::abs(q[largest])) largest = k;
  const double sign = q[largest] < 0 ? -1.0 : 1.0;
  auto bits = static_cast<std::uint32_t>(largest);
  for (std::size_t k = 0; k < 4; ++k)
    if (k != largest) bits = bits << 10 | encode(sign * q[k] * std::sqrt(2.0));
  return bits;
}

inline std::string spz_unpacked(const std::vector<TestGaussian>& gaussians, int version, int degree) {
  std::string bytes =
      bytes_of<std::uint32_t>(0x5053474e) + bytes_of<std::uint32_t>(static_cast<std::uint32_t>(version)) +
      bytes_of(static_cast<std::uint32_t>(gaussians.size())) + std::string{static_cast<char>(degree), 12, 0, 0};
  for (const TestGaussian& g : gaussians)
    for (int k = 0; k < 3; ++k)
      bytes += version == 1 ? bytes_of(half_of(g.position[k]))
                            : bytes_of(static_cast<std::int32_t>(std::lround(g.position[k] * 4096))).substr(0, 3);
  for (const TestGaussian& g : gaussians)
    bytes += bytes_of(byte_of(255 * g.opacity));
  for (const TestGaussian& g : gaussians)
    for (int k = 0; k < 3; ++k)
      bytes += bytes_of(byte_of(255 * (0.5 + 0.15 * (g.colour[k] - 0.5) / 0.28209479)));
  for (const TestGaussian& g : gaussians)
    for (int k = 0; k < 3; ++k)
      bytes += bytes_of(byte_of(16 * (g.log_scale[k] + 10)));
  for (const TestGaussian& g : gaussians) {
    const double sign = g.rotation.w() < 0 ? -1.0 : 1.0;
    const std::array<double, 3> xyz{g.rotation.x(), g.rotation.y(), g.rotation.z()};
    if (version < 3) {
      for (const double q : xyz)
        bytes += bytes_of(byte_of(127.5 * sign * q + 127.5));
      continue;
    }
    bytes += bytes_of(smallest_three({xyz[0], xyz[1], xyz[2], g.rotation.w()}, [](double value) {
      return static_cast<std::uint32_t>(std::lround(511 * std::abs(value))) | (value < 0 ? 512u : 0u);
    }));
  }
  constexpr std::array<std::size_t, 5> harmonics{0, 9, 24, 45, 72};
  return bytes + std::string(harmonics[static_cast<std::size_t>(degree)] * gaussians.size(), '\x80');
}

inline std::string spz_bytes(const std::vector<TestGaussian>& gaussians, int version, int degree) {
  return gzipped(spz_unpacked(gaussians, version, degree));
}

/// Bounds of every chunk: positions -10 ... 10, logarithms of axes -5 ... -2, colours 0 ... 1 or none.
inline std::string compressed_ply_bytes(const std::vector<TestGaussian>& gaussians, bool colour_bounds,
                                        bool big_endian) {
  const std::size_t chunks = (gaussians.size() + 255) / 256;
  std::string bytes = std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
                      "_endian 1.0\nelement chunk " + std::to_string(chunks) + "\n";
  for (const char* name : {"min_x", "min_y", "min_z", "max_x", "max_y", "max_z", "min_scale_x", "min_scale_y",
                           "min_scale_z", "max_scale_x", "max_scale_y", "max_scale_z"})
    bytes += std::string("property float ") + name + "\n";
  for (const char* name : {"min_r", "min_g", "min_b", "max_r", "max_g", "max_b"})
    if (colour_bounds) bytes += std::string("property float ") + name + "\n";
  bytes += "element vertex " + std::to_string(gaussians.size()) + "\n";
  for (const char* name : {"position", "rotation", "scale", "color"})
    bytes += std::string("property uint packed_") + name + "\n";
  bytes += "end_header\n";
  for (std::size_t c = 0; c < chunks; ++c)
    for (const float bound : {-10.0f, 10.0f, -5.0f, -2.0f, 0.0f, 1.0f})
      for (int k = 0; k < 3 && (bound < 0.0f || bound > 1.0f || colour_bounds); ++k)
        bytes += bytes_of(bound, big_endian);
  const auto packed = [](const Eigen::Vector3d& value, double low, double high) {
    const auto bits = [&](int k, double most) {
      return static_cast<std::uint32_t>(std::lround((value[k] - low) / (high - low) * most));
    };
    return bits(0, 2047) << 21 | bits(1, 1023) << 11 | bits(2, 2047);
  };
  for (const TestGaussian& g : gaussians) {
    bytes += bytes_of(packed(g.position, -10, 10), big_endian);
    bytes += bytes_of(
        smallest_three(
            g.wxyz(), [](double value) { return static_cast<std::uint32_t>(std::lround((0.5 + 0.5 * value) * 1023)); }),
        big_endian);
    bytes += bytes_of(packed(g.log_scale, -5, -2), big_endian);
    std::uint32_t colour = 0;
    for (const double value : {g.colour[0], g.colour[1], g.colour[2], g.opacity})
      colour = colour << 8 | byte_of(255 * value);
    bytes += bytes_of(colour, big_endian);
  }
  return bytes;
}

} // namespace pointgi::test
