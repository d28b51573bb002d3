#pragma once
/// A noisy reference that leaves no noise of its own in the errors measured against it.
#include "host/image/difference.h"
#include "host/measure/trade.h"
#include <vector>

namespace pointgi {

/// Two converged pictures of other seeds. The product of a picture's differences from the two is, on average, its
/// squared difference from the truth: the halves' own noise falls out. Or one picture, whose noise is taken off by its
/// channels Variance.R, .G and .B where it has them, and stays in where it has none. What noise adds by way of the
/// denominator of relMSE is taken off to first order of its variance. Of the noise of mean(), its variance relative to
/// its square, the error is then off by less than this, found by simulation
/// (tests/unit/host/measure/reference_test.cpp: 64 x 48 pixels, Gaussian and skewed noise, pictures of relMSE 0.01 and,
/// with a bias of -10 %, 0.018):
///
///     variance   off by   without correction   half of the interval
///     1e-3       2e-5     3.4e-4               3.3e-4 to 4.8e-4
///     1e-2       2.2e-4   2.9e-3               7.4e-4
///     3e-2       7.4e-4   8.4e-3               1.5e-3 to 2.8e-3
///     1e-1       0.19     0.29                 0.007 to 0.08: too few samples for a reference
///
/// Path tracers have rare bright samples, and pixels whose variance is far above the mean's. In scenes/demo/room.toml
/// at 96 x 72 pixels, halves of 128 samples a pixel find an error of 0.0028 (0.0057 without correction, half of the
/// interval 0.0021) where halves of 1024 samples find 0.0021; halves of 16 samples find 0.023 (0.037, 0.015).
class Reference {
public:
  /// Both of one size, with R, G and B.
  Reference(Picture first, Picture second);
  explicit Reference(Picture alone);

  const Picture& mean() const { return mean_; }

  /// relMSE of mean(): of two halves by their difference, of one picture by its variance; 0 where that is not known.
  double own_noise() const;

  /// Of each pixel its share of relMSE: the mean over pixels is what `pointgi compare` calls relMSE, less the
  /// reference's own noise. `picture`: of mean()'s size.
  std::vector<double> errors(const Picture& picture) const;

  double error(const Picture& picture) const;

  /// What the pixels' variances, of its channels Variance.R, .G and .B, add to error(picture); infinite where they are
  /// not known.
  double noise(const Picture& picture) const;

  /// Standard deviation of error(picture) by the reference's noise alone, which all pictures have in common.
  double deviation(const Picture& picture) const;

  static constexpr const char* colours[] = {"R", "G", "B"};

private:
  double by_denominator(double product, double around, double b, double noise) const;

  /// Of pixel i, what the reference's noise adds to the squared difference from mean(), a colour.
  std::vector<std::vector<double>> noise_;
  Picture mean_;
  double eps_ = 0.0;
  /// Factor of noise_² in by_denominator. On average noise_² is 3 s⁴ where noise_ is of a difference of halves; it is
  /// s⁴, and the factor 1, where it is of a variance.
  double fourth_ = 2.0 / 3.0;
};

/// The error of repeated pictures of one setting, and its 95 % interval. The picture is cut into tiles of 8 x 8 pixels.
/// Of two or more pictures, made with other seeds, the interval comes from how the error of each tile varies from one
/// to the next, as if tiles varied independently, and from the reference's noise. Of one picture it comes from how
/// tiles differ within groups of 2 x 2: what differs there without being chance, as silhouettes do, counts too, and the
/// interval is rather too wide. The quantile is Student's, its degrees of freedom by Welch and Satterthwaite.
class ErrorOfRepeats {
public:
  ErrorOfRepeats() = default;
  /// As one with these tile_sums(), each of tiles(width, height), and this deviation().
  ErrorOfRepeats(int width, int height, std::vector<std::vector<double>> sums, double deviation);

  /// `errors` [height x width] as of Reference::errors; `reference_deviation` as of Reference::deviation.
  void add(const std::vector<double>& errors, int width, int height, double reference_deviation);
  std::size_t count() const { return repeats_.size(); }
  /// Of at least one picture.
  Estimate estimate() const;
  /// How much more error these pictures have than those `before`, of the same size and seeds, of which there is at
  /// least one of both. Where both are off by the same, as at silhouettes, it falls out. The interval comes from how
  /// the tiles' changes differ within groups, as that of one picture: what the reference's noise does to all is in it.
  Estimate change_from(const ErrorOfRepeats& before) const;

  static std::size_t tiles(int width, int height);
  /// Of each picture the sum of the errors of each tile, row after row.
  const std::vector<std::vector<double>>& tile_sums() const { return repeats_; }
  /// The greatest reference_deviation.
  double deviation() const { return deviation_; }

private:
  void set_size(int width, int height);

  std::size_t columns_ = 0, rows_ = 0;
  double pixels_ = 0.0, deviation_ = 0.0;
  std::vector<std::vector<double>> repeats_; ///< tile_sums
  std::vector<double> pixels_of_tile_;
};

} // namespace pointgi
