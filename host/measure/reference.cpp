#include "host/measure/reference.h"
#include <algorithm>
#include <cmath>

namespace pointgi {

namespace {

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values)
    sum += value;
  return sum / static_cast<double>(values.size());
}

/// 97.5 % quantile of Student's distribution, by Fisher's expansion (Abramowitz and Stegun 26.7.5): within 2 % from
/// three degrees of freedom on.
double student_quantile(double freedom) {
  constexpr double z = 1.959964, z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z;
  const double n = std::max(freedom, 2.0);
  return z + (z3 + z) / (4.0 * n) + (5.0 * z5 + 16.0 * z3 + 3.0 * z) / (96.0 * n * n) +
         (3.0 * z7 + 19.0 * z5 + 17.0 * z3 - 15.0 * z) / (384.0 * n * n * n);
}

struct Tile {
  double sum = 0.0;
  double pixels = 0.0;
};

/// Tiles of a picture, row after row.
struct Tiles {
  std::size_t columns = 0, rows = 0;
  std::vector<Tile> all;
};

constexpr std::size_t tile_side = 8, group_side = 2;

Tiles tiles_of(const std::vector<double>& values, std::size_t width, std::size_t height) {
  Tiles tiles{(width + tile_side - 1) / tile_side, (height + tile_side - 1) / tile_side, {}};
  tiles.all.resize(tiles.columns * tiles.rows);
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x) {
      Tile& tile = tiles.all[y / tile_side * tiles.columns + x / tile_side];
      tile.sum += values[y * width + x];
      tile.pixels += 1.0;
    }
  return tiles;
}

/// Variance of a sum over tiles, and the degrees of freedom that it was found with.
struct Spread {
  double variance = 0.0, squares = 0.0;
  void add(const std::vector<Tile>& group, double about, double freedom) {
    if (group.empty() || freedom <= 0.0) return;
    double sum = 0.0;
    for (const Tile& tile : group) {
      const double off = tile.sum - about * tile.pixels;
      sum += off * off;
    }
    const double v = sum * static_cast<double>(group.size()) / freedom;
    variance += v;
    squares += v * v / freedom;
  }
  double freedom() const { return squares > 0.0 ? variance * variance / squares : 1.0; }
};

double mean_of(const std::vector<Tile>& group) {
  Tile all;
  for (const Tile& tile : group)
    all.sum += tile.sum, all.pixels += tile.pixels;
  return all.sum / all.pixels;
}

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

Reference::Reference(Picture alone) : mean_(std::move(alone)) {
  eps_ = difference(mean_, "reference", mean_, "reference").eps;
  for (const char* colour : colours) {
    const auto variance = mean_.channels.find(std::string("Variance.") + colour);
    if (variance == mean_.channels.end())
      noise_.emplace_back(mean_.channels.at(colour).size(), 0.0);
    else
      noise_.emplace_back(variance->second.begin(), variance->second.end());
  }
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
  std::vector<double> errors(noise_.front().size(), 0.0);
  for (std::size_t k = 0; k < noise_.size(); ++k) {
    const std::vector<float>&a = picture.channels.at(colours[k]), &b = mean_.channels.at(colours[k]);
    for (std::size_t i = 0; i < errors.size(); ++i) {
      const double off = double{a[i]} - b[i];
      errors[i] += (off * off - noise_[k][i]) / (double{b[i]} * b[i] + eps_) / 3.0;
    }
  }
  return errors;
}

double Reference::error(const Picture& picture) const {
  return mean_of(errors(picture));
}

Estimate mean_of_pixels(const std::vector<double>& values, int width, int height) {
  const Tiles tiles = tiles_of(values, static_cast<std::size_t>(width), static_cast<std::size_t>(height));
  const double mean = mean_of(values);
  Spread spread;
  for (std::size_t y = 0; y < tiles.rows; y += group_side)
    for (std::size_t x = 0; x < tiles.columns; x += group_side) {
      std::vector<Tile> group;
      for (std::size_t j = y; j < std::min(y + group_side, tiles.rows); ++j)
        for (std::size_t i = x; i < std::min(x + group_side, tiles.columns); ++i)
          group.push_back(tiles.all[j * tiles.columns + i]);
      if (group.size() > 1)
        spread.add(group, mean_of(group), static_cast<double>(group.size()) - 1.0);
      else // none beside it to tell it from
        spread.add(group, mean, 1.0);
    }
  const double half =
      student_quantile(spread.freedom()) * std::sqrt(spread.variance) / static_cast<double>(values.size());
  return {mean, mean - half, mean + half};
}

} // namespace pointgi
