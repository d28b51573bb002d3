#pragma once
/// An exposure chosen from a finished picture, and what a picture shows at one.
#include <array>
#include <cstdint>
#include <vector>

namespace pointgi {

/// Counts the pixels of a picture by their brightness, in memory that does not grow with it.
class ExposureMeter {
public:
  ExposureMeter();

  /// A pixel: radiance; `coverage`: share of its samples that met a surface; `albedo`: mean reflectance of these. What
  /// is not finite does not count.
  void add(const std::array<float, 3>& radiance, float coverage, const std::array<float, 3>& albedo);

  /// Stops at which the middle of what is lit and covered by surfaces lands at a grey: between 0.1 where these are
  /// black and 0.5 where they are white, as people expect snow to look bright and coal to look dark. Nearly all of it
  /// stays below white, and the mean of the whole picture, background included, lies between 0.3 and 0.65, in values of
  /// sRGB from 0 to 1, as far as that leaves surfaces unburnt. Of a picture without surfaces all that shines counts; 0
  /// where nothing does.
  double stops() const;

  /// Mean of the picture's sRGB values [0, 1] at that exposure; 0 of none. To a hundredth.
  double mean_at(double stops) const;
  /// Share of the pixels at which some colour is 1 or more at that exposure. To a twentieth of a stop.
  double clipped_at(double stops) const;
  /// Share of the pixels that are not black.
  double lit_share() const;

private:
  /// Bins of equal steps of log2, and a count of what is 0.
  struct Histogram {
    std::vector<std::uint64_t> bins;
    std::uint64_t black = 0, all = 0;
    void add(double value);
    /// log2 of the value below which `share` of those that are not black lie.
    double quantile(double share) const;
  };

  Histogram surfaces_, values_, brightest_; ///< luminance of covered pixels; every colour; the largest of a pixel
  double albedo_sum_ = 0.0;
};

} // namespace pointgi
