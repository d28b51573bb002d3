#pragma once
/// A noisy reference that leaves no noise of its own in the errors measured against it.
#include "host/image/difference.h"
#include <vector>

namespace pointgi {

/// Two converged pictures of other seeds. The product of a picture's differences from the two is, on average, its
/// squared difference from the truth: the halves' own noise falls out.
class Reference {
public:
  Reference(Picture first, Picture second) : first_(std::move(first)), second_(std::move(second)), mean_(first_) {
    for (const char* colour : colours) {
      const std::vector<float>& other = second_.channels.at(colour);
      std::vector<float>& mean = mean_.channels.at(colour);
      for (std::size_t i = 0; i < mean.size(); ++i)
        mean[i] = 0.5f * (mean[i] + other[i]);
    }
    eps_ = difference(mean_, "reference", mean_, "reference").eps;
  }

  const Picture& mean() const { return mean_; }

  /// relMSE of the mean of the two halves, by their difference.
  double own_noise() const { return difference(first_, "half", mean_, "reference").all.rel_mse; }

  /// Of each pixel its share of relMSE: the mean over pixels is what `pointgi compare` calls relMSE, less the
  /// reference's own noise.
  std::vector<double> errors(const Picture& picture) const {
    std::vector<double> errors(mean_.channels.at("R").size(), 0.0);
    for (const char* colour : colours) {
      const std::vector<float>&a = picture.channels.at(colour), &x = first_.channels.at(colour),
            &y = second_.channels.at(colour), &b = mean_.channels.at(colour);
      for (std::size_t i = 0; i < errors.size(); ++i)
        errors[i] += (double{a[i]} - x[i]) * (double{a[i]} - y[i]) / (double{b[i]} * b[i] + eps_) / 3.0;
    }
    return errors;
  }

  double error(const Picture& picture) const {
    const std::vector<double> each = errors(picture);
    double sum = 0.0;
    for (const double e : each)
      sum += e;
    return sum / static_cast<double>(each.size());
  }

  static constexpr const char* colours[] = {"R", "G", "B"};

private:
  Picture first_, second_, mean_;
  double eps_ = 0.0;
};

} // namespace pointgi
