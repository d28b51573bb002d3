#include "host/image/ssim.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace pointgi {

namespace {

constexpr int reach = 5;
constexpr double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;

std::array<double, 2 * reach + 1> gaussian() {
  std::array<double, 2 * reach + 1> weights{};
  for (int i = -reach; i <= reach; ++i)
    weights[static_cast<std::size_t>(i + reach)] = std::exp(-0.5 * i * i / (1.5 * 1.5));
  return weights;
}

/// Weighted sums of a window: of 1, a, b, a², b², ab.
using Moments = std::array<double, 6>;

void add(Moments& sums, double weight, const Moments& more) {
  for (std::size_t k = 0; k < sums.size(); ++k)
    sums[k] += weight * more[k];
}

struct Places {
  int first, end;
};

/// Pixels along a side whose windows lie inside; where the side is too short for a whole window, all.
Places window_places(int size) {
  return size > 2 * reach ? Places{reach, size - reach} : Places{0, size};
}

double similarity(const Moments& m) {
  const double a = m[1] / m[0], b = m[2] / m[0];
  const double variance = (m[3] + m[4]) / m[0] - a * a - b * b, covariance = m[5] / m[0] - a * b;
  return (2.0 * a * b + c1) * (2.0 * covariance + c2) / ((a * a + b * b + c1) * (variance + c2));
}

} // namespace

double ssim(const std::vector<float>& a, const std::vector<float>& b, int width, int height) {
  const auto weights = gaussian();
  const auto weight = [&](int off) { return weights[static_cast<std::size_t>(off + reach)]; };
  const auto columns = static_cast<std::size_t>(width);
  const Places across = window_places(width), down = window_places(height);
  // The window is a product: along the rows first, for the eleven rows that are needed at a time.
  std::vector<std::vector<Moments>> rows(2 * reach + 1, std::vector<Moments>(columns));
  const auto blur_row = [&](int y) {
    std::vector<Moments>& row = rows[static_cast<std::size_t>(y) % rows.size()];
    for (int x = across.first; x < across.end; ++x) {
      Moments sums{};
      for (int i = std::max(0, x - reach); i <= std::min(width - 1, x + reach); ++i) {
        const std::size_t at = static_cast<std::size_t>(y) * columns + static_cast<std::size_t>(i);
        const double p = static_cast<double>(a[at]), q = static_cast<double>(b[at]);
        add(sums, weight(i - x), {1.0, p, q, p * p, q * q, p * q});
      }
      row[static_cast<std::size_t>(x)] = sums;
    }
  };
  double total = 0.0;
  for (int y = down.first, ready = 0; y < down.end; ++y) {
    for (; ready <= std::min(height - 1, y + reach); ++ready)
      blur_row(ready);
    for (int x = across.first; x < across.end; ++x) {
      Moments sums{};
      for (int j = std::max(0, y - reach); j <= std::min(height - 1, y + reach); ++j)
        add(sums, weight(j - y), rows[static_cast<std::size_t>(j) % rows.size()][static_cast<std::size_t>(x)]);
      total += similarity(sums);
    }
  }
  return total / (static_cast<double>(across.end - across.first) * (down.end - down.first));
}

} // namespace pointgi
