#pragma once
/// A noisy reference that leaves no noise of its own in the errors measured against it.
#include "host/image/difference.h"
#include "host/measure/trade.h"
#include <vector>

namespace pointgi {

/// Two converged pictures of other seeds. The product of a picture's differences from the two is, on average, its
/// squared difference from the truth: the halves' own noise falls out. Or one picture, whose noise is taken off by its
/// channels Variance.R, .G and .B where it has them, and stays in where it has none.
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

  static constexpr const char* colours[] = {"R", "G", "B"};

private:
  /// Of pixel i, what the reference's noise adds to the squared difference from mean(), a colour.
  std::vector<std::vector<double>> noise_;
  Picture mean_;
  double eps_ = 0.0;
};

/// The mean of values of pixels [height x width] and its 95 % interval, by batches: the picture is cut into tiles of
/// 8 x 8 pixels, of which the means vary; as neighbours are alike in what they show, only differences within groups of
/// 2 x 2 tiles count. The quantile is Student's, its degrees of freedom by Welch and Satterthwaite. What differs from
/// tile to tile without being chance counts too, so that the interval is rather too wide; what all tiles have in common
/// by chance, as a light that was solved by few rays, does not: repeats with other seeds show that.
Estimate mean_of_pixels(const std::vector<double>& values, int width, int height);

} // namespace pointgi
