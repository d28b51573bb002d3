#pragma once
/// Radiance pictures written by hand, in each of the three codes of their rows.
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace pointgi::test {

using Rgbe = std::array<std::uint8_t, 4>;

enum class HdrCode { flat, old_runs, new_runs };

inline std::string hdr_header(int width, int height, const std::string& variables = "FORMAT=32-bit_rle_rgbe\n",
                              const std::string& signs = "-+") {
  return "#?RADIANCE\n" + variables + "\n" + signs[0] + "Y " + std::to_string(height) + " " + signs[1] + "X " +
         std::to_string(width) + "\n";
}

/// Mantissas rounded, so that values of 8 bits under one exponent come back exactly.
inline Rgbe rgbe(float r, float g, float b) {
  const float most = std::fmax(r, std::fmax(g, b));
  if (!(most > 1e-32f)) return {0, 0, 0, 0};
  int exponent = 0;
  std::frexp(most, &exponent);
  const auto mantissa = [&](float c) {
    return static_cast<std::uint8_t>(std::fmin(255.0f, std::round(std::ldexp(c, 8 - exponent))));
  };
  return {mantissa(r), mantissa(g), mantissa(b), static_cast<std::uint8_t>(exponent + 128)};
}

inline void append_bytes(std::string& out, const Rgbe& pixel) {
  for (const std::uint8_t byte : pixel)
    out += static_cast<char>(byte);
}

inline std::string hdr_row(const std::vector<Rgbe>& row, HdrCode code) {
  std::string out;
  if (code == HdrCode::flat) {
    for (const Rgbe& pixel : row)
      append_bytes(out, pixel);
  } else if (code == HdrCode::old_runs) {
    for (std::size_t x = 0; x < row.size();) {
      std::size_t end = x + 1;
      while (end < row.size() && row[end] == row[x])
        ++end;
      append_bytes(out, row[x]);
      for (std::size_t rest = end - x - 1; rest > 0; rest >>= 8)
        append_bytes(out, {1, 1, 1, static_cast<std::uint8_t>(rest & 255)});
      x = end;
    }
  } else {
    out += std::string("\2\2", 2) + static_cast<char>(row.size() >> 8) + static_cast<char>(row.size() & 255);
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t x = 0; x < row.size();) {
        std::size_t end = x + 1;
        while (end < row.size() && end - x < 127 && row[end][k] == row[x][k])
          ++end;
        if (end - x > 2) {
          out += static_cast<char>(128 + (end - x));
          out += static_cast<char>(row[x][k]);
        } else { // one value as it is
          end = x + 1;
          out += static_cast<char>(1);
          out += static_cast<char>(row[x][k]);
        }
        x = end;
      }
  }
  return out;
}

/// A whole file of width x height pixels.
inline std::string hdr_file(int width, int height, const std::vector<Rgbe>& pixels, HdrCode code) {
  std::string out = hdr_header(width, height);
  for (int y = 0; y < height; ++y)
    out += hdr_row({pixels.begin() + y * width, pixels.begin() + (y + 1) * width}, code);
  return out;
}

} // namespace pointgi::test
