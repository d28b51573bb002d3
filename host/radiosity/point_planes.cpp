#include "host/radiosity/point_planes.h"
#include "host/error.h"
#include <limits>
#include <stdexcept>

namespace pointgi {

cl_uint plane_stride(std::size_t points) {
  const std::size_t stride = (points + FMM_LANES - 1) / FMM_LANES * FMM_LANES + FMM_LANES;
  if (stride > std::numeric_limits<cl_uint>::max())
    throw Error(ErrorKind::memory, "radiosity: " + std::to_string(points) +
                                       " points exchange light, and kernels count 4294967280 at most; use a coarser "
                                       "spacing, or a smaller cloud");
  return static_cast<cl_uint>(stride);
}

std::vector<cl_float> point_planes(View<ExchangePoint> points, cl_uint stride) {
  std::vector<cl_float> planes(7 * static_cast<std::size_t>(stride), 0.0f);
  for (std::size_t i = 0; i < points.size; ++i) {
    for (std::size_t a = 0; a < 3; ++a) {
      planes[a * stride + i] = static_cast<float>(points[i].x[static_cast<Eigen::Index>(a)]);
      planes[(3 + a) * stride + i] = static_cast<float>(points[i].n[static_cast<Eigen::Index>(a)]);
    }
    planes[6 * static_cast<std::size_t>(stride) + i] = static_cast<float>(points[i].area);
  }
  return planes;
}

std::vector<cl_float> flux_planes(View<double> radiosity, View<ExchangePoint> points, cl_uint stride) {
  if (radiosity.size != 3 * points.size) throw std::invalid_argument("radiosity is not [points x 3]");
  std::vector<cl_float> planes(3 * static_cast<std::size_t>(stride), 0.0f);
  for (std::size_t i = 0; i < points.size; ++i)
    for (std::size_t c = 0; c < 3; ++c)
      planes[c * stride + i] = static_cast<float>(radiosity[3 * i + c] * points[i].area);
  return planes;
}

std::vector<double> rows_of_planes(const std::vector<cl_float>& planes, std::size_t points, cl_uint stride) {
  std::vector<double> rows(3 * points);
  for (std::size_t i = 0; i < points; ++i)
    for (std::size_t c = 0; c < 3; ++c)
      rows[3 * i + c] = planes[c * stride + i];
  return rows;
}

} // namespace pointgi
