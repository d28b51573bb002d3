#include "host/image/difference.h"
#include "host/error.h"
#include "host/image/srgb.h"
#include "host/image/ssim.h"
#include <algorithm>
#include <cmath>

namespace pointgi {

namespace {

constexpr const char* names[3] = {"R", "G", "B"};

std::string text(const PixelWindow& w) {
  return "[" + std::to_string(w.x0) + ", " + std::to_string(w.x1) + ") x [" + std::to_string(w.y0) + ", " +
         std::to_string(w.y1) + ")";
}

void require_colours(const Picture& picture, const std::string& name) {
  for (const char* channel : names) {
    if (picture.channels.count(channel) == 1) continue;
    std::string list;
    for (const auto& [known, values] : picture.channels)
      list += (list.empty() ? "" : ", ") + known;
    throw Error(ErrorKind::input, name + ": has no channel \"" + channel +
                                      "\", expected R, G and B; its channels are " + (list.empty() ? "none" : list));
  }
}

/// A picture's values of one colour inside `area`, row after row.
std::vector<float> cut(const Picture& picture, const char* channel, const PixelWindow& area) {
  const std::vector<float>& all = picture.channels.at(channel);
  std::vector<float> values;
  values.reserve(static_cast<std::size_t>(area.x1 - area.x0) * static_cast<std::size_t>(area.y1 - area.y0));
  for (int y = area.y0; y < area.y1; ++y) {
    const auto row = all.begin() + static_cast<std::ptrdiff_t>(y - picture.window.y0) * picture.width;
    values.insert(values.end(), row + (area.x0 - picture.window.x0), row + (area.x1 - picture.window.x0));
  }
  return values;
}

/// The value that `share` of the values do not exceed; 0 of none.
double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const double rank = std::ceil(share * static_cast<double>(values.size()));
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::max(rank, 1.0)) - 1;
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// The colours of both pictures in the common area, and which pixels are finite in both.
struct Planes {
  std::vector<float> a[3], b[3];
  std::vector<char> finite;
};

Planes planes_of(const Picture& a, const Picture& b, PictureDifference& result) {
  Planes planes;
  for (int k = 0; k < 3; ++k) {
    planes.a[k] = cut(a, names[k], result.area);
    planes.b[k] = cut(b, names[k], result.area);
  }
  planes.finite.resize(planes.a[0].size());
  for (std::size_t i = 0; i < planes.finite.size(); ++i) {
    bool finite = true;
    for (int k = 0; k < 3; ++k)
      finite = finite && std::isfinite(planes.a[k][i]) && std::isfinite(planes.b[k][i]);
    planes.finite[i] = finite;
    result.pixels += finite;
    result.not_finite += !finite;
  }
  return planes;
}

/// eps and white, which all colours share.
void measure_truth(const Planes& planes, PictureDifference& result) {
  std::vector<double> values;
  double sum = 0.0;
  for (const std::vector<float>& plane : planes.b)
    for (std::size_t i = 0; i < plane.size(); ++i)
      if (planes.finite[i]) {
        values.push_back(static_cast<double>(plane[i]));
        sum += values.back();
      }
  const double mean = values.empty() ? 0.0 : sum / static_cast<double>(values.size());
  result.eps = mean != 0.0 ? 0.01 * mean * mean : 0.01;
  result.white = percentile(std::move(values), 0.99);
  if (!(result.white > 0.0)) result.white = 1.0;
}

/// Everything but ssim over the finite pixels of some planes.
Difference figures(const std::vector<float>* a, const std::vector<float>* b, int planes,
                   const std::vector<char>& finite, double eps) {
  Difference d;
  std::vector<double> apart;
  for (int k = 0; k < planes; ++k)
    for (std::size_t i = 0; i < finite.size(); ++i) {
      if (!finite[i]) continue;
      const double x = static_cast<double>(a[k][i]), y = static_cast<double>(b[k][i]), off = x - y;
      d.mean_a += x;
      d.mean_b += y;
      d.mse += off * off;
      d.rel_mse += off * off / (y * y + eps);
      apart.push_back(std::fabs(off));
    }
  const double count = std::max<double>(static_cast<double>(apart.size()), 1.0);
  for (double* value : {&d.mean_a, &d.mean_b, &d.mse, &d.rel_mse})
    *value /= count;
  d.bias = d.mean_a == d.mean_b ? 0.0 : (d.mean_a - d.mean_b) / d.mean_b;
  d.p99 = percentile(std::move(apart), 0.99);
  return d;
}

/// As a viewer sees it; pixels that are left out are black in both.
std::vector<float> displayed(const std::vector<float>& plane, const std::vector<char>& finite, double white) {
  std::vector<float> values(plane.size());
  for (std::size_t i = 0; i < plane.size(); ++i)
    if (finite[i])
      values[i] = linear_to_srgb(std::clamp(static_cast<float>(static_cast<double>(plane[i]) / white), 0.0f, 1.0f));
  return values;
}

} // namespace

PictureDifference difference(const Picture& a, const std::string& name_a, const Picture& b, const std::string& name_b) {
  require_colours(a, name_a);
  require_colours(b, name_b);
  PictureDifference result;
  result.area = {std::max(a.window.x0, b.window.x0), std::min(a.window.x1, b.window.x1),
                 std::max(a.window.y0, b.window.y0), std::min(a.window.y1, b.window.y1)};
  const int width = result.area.x1 - result.area.x0, height = result.area.y1 - result.area.y0;
  if (width <= 0 || height <= 0)
    throw Error(ErrorKind::input, name_a + " and " + name_b + ": no pixel in common: the first holds " +
                                      text(a.window) + ", the second " + text(b.window) +
                                      "; render the same --pixelbounds");
  const Planes planes = planes_of(a, b, result);
  measure_truth(planes, result);
  result.all = figures(planes.a, planes.b, 3, planes.finite, result.eps);
  result.all.ssim = 0.0;
  for (int k = 0; k < 3; ++k) {
    Difference& d = result.channel[k];
    d = figures(planes.a + k, planes.b + k, 1, planes.finite, result.eps);
    d.ssim = ssim(displayed(planes.a[k], planes.finite, result.white),
                  displayed(planes.b[k], planes.finite, result.white), width, height);
    result.all.ssim += d.ssim / 3.0;
  }
  return result;
}

} // namespace pointgi
