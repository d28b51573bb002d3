#include "host/measure/reference.h"
#include "host/measure/intervals.h"
#include <algorithm>
#include <cmath>
#include <limits>

namespace pointgi {

namespace {

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values)
    sum += value;
  return sum / static_cast<double>(values.size());
}

/// Of the pixels around `at`, up to eight; 0 of none.
double mean_of_neighbours(const std::vector<double>& values, int width, std::size_t at) {
  const auto columns = static_cast<std::size_t>(width), rows = values.size() / columns;
  const std::size_t x = at % columns, y = at / columns;
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t j = y > 0 ? y - 1 : 0; j <= std::min(y + 1, rows - 1); ++j)
    for (std::size_t i = x > 0 ? x - 1 : 0; i <= std::min(x + 1, columns - 1); ++i)
      if (i != x || j != y) sum += values[j * columns + i], ++count;
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

constexpr std::size_t tile_side = 8, group_side = 2;

std::size_t tiles_along(int pixels) {
  return (static_cast<std::size_t>(pixels) + tile_side - 1) / tile_side;
}

/// A sum of independent variances, and the degrees of freedom that it was found with.
struct Spread {
  double variance = 0.0, squares = 0.0;
  void add(double one, double freedom) {
    variance += one;
    squares += one * one / freedom;
  }
  double freedom() const { return squares > 0.0 ? variance * variance / squares : 1.0; }
};

} // namespace

Reference::Reference(Picture first, Picture second) : mean_(first) {
  for (const char* colour : colours) {
    const std::vector<float>&x = first.channels.at(colour), &y = second.channels.at(colour);
    std::vector<float>& mean = mean_.channels.at(colour);
    std::vector<double>& noise = noise_.emplace_back(mean.size());
    for (std::size_t i = 0; i < mean.size(); ++i) {
      // (a - x) (a - y) = (a - (x + y) / 2)² - ((x - y) / 2)²
      mean[i] = 0.5f * (x[i] + y[i]);
      noise[i] = 0.25 * (double{x[i]} - y[i]) * (double{x[i]} - y[i]);
    }
  }
  eps_ = difference(mean_, "reference", mean_, "reference").eps;
}

Reference::Reference(Picture alone) : mean_(std::move(alone)), fourth_(1.0) {
  eps_ = difference(mean_, "reference", mean_, "reference").eps;
  for (const char* colour : colours) {
    const auto variance = mean_.channels.find(std::string("Variance.") + colour);
    if (variance == mean_.channels.end())
      noise_.emplace_back(mean_.channels.at(colour).size(), 0.0);
    else
      noise_.emplace_back(variance->second.begin(), variance->second.end());
  }
}

/// What the noise m of mean() adds on average to a pixel's (d - m)² - s² over its square, which m is in, too. With
/// f(m) = 1 / ((b + m)² + eps) it is s² (d² f'' / 2 - 2 d f') + s⁴ f'', and higher orders. d by itself holds m, and
/// s² may: where noise is skewed, d s² would be off by as much as is to be taken off, so in d f' stands the mean of
/// the neighbours' differences. Higher orders count where m is not small against b; what is taken off stays below s² f
/// for their sake.
double Reference::by_denominator(double product, double around, double b, double noise) const {
  const double f = 1.0 / (b * b + eps_), f1 = -2.0 * b * f * f, f2 = (8.0 * b * b * f - 2.0) * f * f;
  const double added = noise * (f2 * (0.5 * product + fourth_ * noise) - 2.0 * around * f1);
  return std::clamp(added, -noise * f, noise * f);
}

double Reference::own_noise() const {
  double sum = 0.0;
  for (std::size_t k = 0; k < noise_.size(); ++k) {
    const std::vector<float>& b = mean_.channels.at(colours[k]);
    for (std::size_t i = 0; i < b.size(); ++i)
      sum += noise_[k][i] / (double{b[i]} * b[i] + eps_);
  }
  return sum / (3.0 * static_cast<double>(noise_.front().size()));
}

std::vector<double> Reference::errors(const Picture& picture) const {
  std::vector<double> errors(noise_.front().size(), 0.0), off(errors.size());
  for (std::size_t k = 0; k < noise_.size(); ++k) {
    const std::vector<float>&a = picture.channels.at(colours[k]), &b = mean_.channels.at(colours[k]);
    for (std::size_t i = 0; i < errors.size(); ++i)
      off[i] = double{a[i]} - b[i];
    for (std::size_t i = 0; i < errors.size(); ++i) {
      const double noise = noise_[k][i], product = off[i] * off[i] - noise, y = double{b[i]};
      const double added =
          noise > 0.0 ? by_denominator(product, mean_of_neighbours(off, mean_.width, i), y, noise) : 0.0;
      errors[i] += (product / (y * y + eps_) - added) / 3.0;
    }
  }
  return errors;
}

double Reference::error(const Picture& picture) const {
  return mean_of(errors(picture));
}

double Reference::noise(const Picture& picture) const {
  double sum = 0.0;
  for (const char* colour : colours) {
    const auto variance = picture.channels.find(std::string("Variance.") + colour);
    if (variance == picture.channels.end()) return std::numeric_limits<double>::infinity();
    const std::vector<float>& b = mean_.channels.at(colour);
    for (std::size_t i = 0; i < b.size(); ++i)
      sum += variance->second[i] / (double{b[i]} * b[i] + eps_);
  }
  return sum / (3.0 * static_cast<double>(noise_.front().size()));
}

double Reference::deviation(const Picture& picture) const {
  // Of (d - nx) (d - ny) with noise of variance v each: 2 d² v + v². noise_ is v / 2 on average, its square 3/4 v².
  double variance = 0.0;
  for (std::size_t k = 0; k < noise_.size(); ++k) {
    const std::vector<float>&a = picture.channels.at(colours[k]), &b = mean_.channels.at(colours[k]);
    for (std::size_t i = 0; i < a.size(); ++i) {
      const double off = double{a[i]} - b[i], n = noise_[k][i], scale = 1.0 / (double{b[i]} * b[i] + eps_) / 3.0;
      variance += (4.0 * off * off * n + n * n / 0.75) * scale * scale;
    }
  }
  return std::sqrt(variance) / static_cast<double>(noise_.front().size());
}

ErrorOfRepeats::ErrorOfRepeats(int width, int height, std::vector<std::vector<double>> sums, double deviation)
    : deviation_(deviation), repeats_(std::move(sums)) {
  set_size(width, height);
}

std::size_t ErrorOfRepeats::tiles(int width, int height) {
  return tiles_along(width) * tiles_along(height);
}

void ErrorOfRepeats::set_size(int width, int height) {
  const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
  columns_ = tiles_along(width);
  rows_ = tiles_along(height);
  pixels_ = static_cast<double>(w * h);
  pixels_of_tile_.clear();
  for (std::size_t y = 0; y < h; y += tile_side)
    for (std::size_t x = 0; x < w; x += tile_side)
      pixels_of_tile_.push_back(static_cast<double>(std::min(tile_side, w - x) * std::min(tile_side, h - y)));
}

void ErrorOfRepeats::add(const std::vector<double>& errors, int width, int height, double reference_deviation) {
  set_size(width, height);
  deviation_ = std::max(deviation_, reference_deviation);
  std::vector<double>& sums = repeats_.emplace_back(columns_ * rows_, 0.0);
  const auto w = static_cast<std::size_t>(width);
  for (std::size_t i = 0; i < errors.size(); ++i)
    sums[i / w / tile_side * columns_ + i % w / tile_side] += errors[i];
}

namespace {

/// Of the mean of two or more repeats' sums, by what each tile's vary.
Spread spread_of_repeats(const std::vector<std::vector<double>>& repeats) {
  const auto count = static_cast<double>(repeats.size());
  Spread spread;
  for (std::size_t tile = 0; tile < repeats.front().size(); ++tile) {
    double mean = 0.0, squares = 0.0;
    for (const std::vector<double>& sums : repeats)
      mean += sums[tile] / count;
    for (const std::vector<double>& sums : repeats)
      squares += (sums[tile] - mean) * (sums[tile] - mean);
    spread.add(squares / (count - 1.0) / count, count - 1.0);
  }
  return spread;
}

/// Of one picture's sum, by how the tiles of a group differ from the group's mean a pixel.
Spread spread_of_groups(const std::vector<double>& sums, const std::vector<double>& pixels, std::size_t columns,
                        std::size_t rows) {
  Spread spread;
  for (std::size_t y = 0; y < rows; y += group_side)
    for (std::size_t x = 0; x < columns; x += group_side) {
      std::vector<std::size_t> group;
      for (std::size_t j = y; j < std::min(y + group_side, rows); ++j)
        for (std::size_t i = x; i < std::min(x + group_side, columns); ++i)
          group.push_back(j * columns + i);
      // Where none is beside a tile, all others are.
      std::vector<std::size_t> about = group;
      if (group.size() == 1)
        for (about.clear(); about.size() < sums.size();)
          about.push_back(about.size());
      double sum = 0.0, area = 0.0, squares = 0.0;
      for (const std::size_t tile : about)
        sum += sums[tile], area += pixels[tile];
      for (const std::size_t tile : group)
        squares += std::pow(sums[tile] - sum / area * pixels[tile], 2.0);
      const auto size = static_cast<double>(group.size());
      const double freedom = std::max(1.0, size - 1.0);
      spread.add(squares * size / freedom, freedom);
    }
  return spread;
}

} // namespace

Estimate ErrorOfRepeats::change_from(const ErrorOfRepeats& before) const {
  ErrorOfRepeats change = *this;
  const std::size_t common = std::min(count(), before.count());
  std::vector<double> sums(repeats_.front().size(), 0.0);
  for (std::size_t i = 0; i < common; ++i)
    for (std::size_t tile = 0; tile < sums.size(); ++tile)
      sums[tile] += (repeats_[i][tile] - before.repeats_[i][tile]) / static_cast<double>(common);
  change.repeats_ = {std::move(sums)};
  return change.estimate();
}

Estimate ErrorOfRepeats::estimate() const {
  double mean = 0.0;
  for (const std::vector<double>& sums : repeats_)
    mean += mean_of(sums) * static_cast<double>(sums.size()) / pixels_ / static_cast<double>(count());
  const Spread spread =
      count() > 1 ? spread_of_repeats(repeats_) : spread_of_groups(repeats_.front(), pixels_of_tile_, columns_, rows_);
  double half = student_quantile(spread.freedom()) * std::sqrt(spread.variance) / pixels_;
  if (count() > 1) half = std::hypot(half, student_quantile(1e6) * deviation_); // groups have it in them
  return {mean, mean - half, mean + half};
}

} // namespace pointgi
