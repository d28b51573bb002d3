#include "host/cloud/smooth_cell.h"
#include <algorithm>

namespace pointgi {

namespace {

constexpr float far = 1e18f; // along an edge, in its lengths

} // namespace

/// As unfold() does for smooth surfaces. Neighbours beyond an edge, whose paths are no shorter than their distance, are
/// left out; returns the least of their squared distances, or 0 where they are among the nearest.
float SmoothCell::lay_flat(const TangentFrame& frame) {
  const Eigen::Vector3f n = frame.n.cast<float>(), u = frame.u.cast<float>(), v = frame.v.cast<float>();
  cosine_of_ = nx_ * n.x() + ny_ * n.y() + nz_ * n.z();
  const Lanes along = ex_ * (n.x() + nx_) + ey_ * (n.y() + ny_) + ez_ * (n.z() + nz_);
  const Lanes height2 = along.square() / (2.0f + 2.0f * cosine_of_);
  const Lanes distance2 = ex_.square() + ey_.square() + ez_.square();
  const Lanes chord2 = (distance2 - height2).max(0.0f);
  const Lanes flat_u = ex_ * u.x() + ey_ * u.y() + ez_ * u.z(), flat_v = ex_ * v.x() + ey_ * v.y() + ez_ * v.z();
  const Lanes flat2 = flat_u.square() + flat_v.square();
  const Lanes t2 = (0.5f - 0.5f * cosine_of_).max(0.0f);
  const Lanes arc = 1.0f + t2 * (1.0f / 6.0f + t2 * (3.0f / 40.0f));
  const Lanes stretch = (chord2 / flat2).sqrt() * arc;
  const Lanes x = flat_u * stretch, y = flat_v * stretch, length2 = x * x + y * y;
  constexpr auto crease = static_cast<float>(detail::crease_cosine),
                 other_side = static_cast<float>(detail::other_side);
  constexpr auto steepest2 = static_cast<float>(detail::steepest * detail::steepest);
  float beyond_edge2 = far;
  count_ = 0;
  for (unsigned j = 0; j < neighbours; ++j) {
    if (cosine_of_[j] < crease && cosine_of_[j] >= other_side)
      beyond_edge2 = std::min(beyond_edge2, count_ < nearest ? 0.0f : distance2[j]);
    x_[count_] = x[j];
    y_[count_] = y[j];
    length2_[count_] = length2[j];
    cosine_of_[count_] = cosine_of_[j];
    const bool low = height2[j] <= std::max(steepest2 * chord2[j], 1.0f);
    count_ += (cosine_of_[j] >= crease) & low & (flat2[j] > 1e-12f) ? 1u : 0u;
  }
  return beyond_edge2;
}

void SmoothCell::find_cosine() {
  const unsigned m = std::min(count_, nearest);
  float first = 1.0f, second = 1.0f, third = 1.0f; // the least so far
  for (unsigned j = 0; j < m; ++j) {
    const float c = cosine_of_[j];
    third = std::min(third, std::max(second, c));
    second = std::min(second, std::max(first, c));
    first = std::min(first, c);
  }
  cosine_ = static_cast<double>(m / 3 == 2 ? third : m / 3 == 1 ? second : first);
}

/// Area and reach of the cell that the bisectors with the first `count` neighbours leave. Each bisector is a line
/// q/2 + t (-q_y, q_x); every other one leaves t on one side of where they meet.
void SmoothCell::cut_edges(unsigned count) {
  const unsigned padded = (count + lanes - 1) / lanes * lanes;
  std::array<float, neighbours + lanes> low, high;
  std::fill_n(low.begin(), padded, -far);
  std::fill_n(high.begin(), padded, far);
  for (unsigned j = 0; j < count; ++j) {
    const float x = x_[j], y = y_[j], length2 = length2_[j];
    for (unsigned i = 0; i < padded; ++i) {
      const float slope = x_[i] * y - y_[i] * x;
      const float room = 0.5f * (length2 - (x_[i] * x + y_[i] * y));
      const float t = room / slope;
      const float none_left = room < 0.0f ? -far : far; // parallel, and nearer
      const float above = slope > 0.0f ? t : slope < 0.0f ? far : none_left;
      const float below = slope < 0.0f ? t : -far;
      high[i] = above < high[i] ? above : high[i];
      low[i] = below > low[i] ? below : low[i];
    }
  }
  area_ = reach2_ = 0.0f;
  for (unsigned i = 0; i < count; ++i) {
    const float length = high[i] - low[i];
    if (length <= 0.0f) continue;
    area_ += 0.25f * length2_[i] * length;
    reach2_ = std::max(reach2_, length2_[i] * (0.25f + std::max(low[i] * low[i], high[i] * high[i])));
  }
}

std::optional<SmoothCell::Cell> SmoothCell::find(const TangentFrame& frame, double known) {
  const float beyond_edge2 = lay_flat(frame);
  find_cosine();
  if (count_ < 3) return {};
  for (unsigned i = count_; i < count_ + lanes; ++i)
    x_[i] = y_[i] = length2_[i] = 1.0f; // lanes that nobody reads
  const unsigned first = std::min(few, count_);
  cut_edges(first);
  const auto within = [&](float length2) { return length2 < 4.0f * reach2_; };
  if (std::any_of(length2_.begin() + first, length2_.begin() + count_, within)) cut_edges(count_);
  const double reach = std::sqrt(static_cast<double>(reach2_));
  if (!(2.0 * reach <= known) || beyond_edge2 < 4.0f * reach2_) return {};
  return Cell{static_cast<double>(area_), reach};
}

} // namespace pointgi
