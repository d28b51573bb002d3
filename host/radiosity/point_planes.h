#pragma once
/// Points as the kernels of kernels/radiosity/fmm read them: a number of all points after another.
#include "fmm/operators/point_pair.h"
#include "host/cl/session.h"
#include "octree/view.h"

namespace pointgi {

/// Points padded to blocks of FMM_LANES, and a block more: a leaf's last block may begin at any point. Throws
/// Error(memory) where kernels, which count points with 32 bits, cannot.
cl_uint plane_stride(std::size_t points);

/// Positions, normals and areas as seven planes, `stride` apart, zero behind the last point.
std::vector<cl_float> point_planes(View<ExchangePoint> points, cl_uint stride);

/// B A of radiosity [points x 3] as three planes. Throws std::invalid_argument on sizes that differ.
std::vector<cl_float> flux_planes(View<double> radiosity, View<ExchangePoint> points, cl_uint stride);

/// [points x 3] of three planes, `stride` apart.
std::vector<double> rows_of_planes(const std::vector<cl_float>& planes, std::size_t points, cl_uint stride);

} // namespace pointgi
