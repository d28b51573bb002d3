#include "host/radiosity/direct.h"
#include "host/cl/resource_error.h"
#include "host/error.h"
#include "host/passes/variant.h"
#include "host/radiosity/point_planes.h"
#include <cmath>

namespace pointgi {

namespace {

constexpr double first_pairs = 2e7; ///< of a first launch, of which nothing is known yet

} // namespace

void DeviceDirect::make_bands(const DirectOptions& options) {
  const DeviceInfo& info = session_.info();
  const std::uint64_t row_bytes = static_cast<std::uint64_t>(FMM_LANES) * tiles_, wanted = row_bytes * tiles_;
  const std::uint64_t available = options.memory_bytes != 0 ? options.memory_bytes : session_.bytes_left();
  if (wanted > available)
    throw Error(ErrorKind::memory, info.name + ": radiosity.method = \"direct\" keeps a bit for each pair of its " +
                                       std::to_string(points_.size()) + " points, " + megabytes(wanted) +
                                       ", and the device has " + megabytes(available) +
                                       " left; use method = \"fmm\", a coarser spacing, or another --device");
  const std::uint64_t piece = options.allocation_bytes != 0 ? options.allocation_bytes : info.max_allocation_bytes;
  const auto rows = static_cast<cl_uint>(std::clamp<std::uint64_t>(piece / row_bytes, 1, tiles_));
  for (cl_uint first = 0; first < tiles_; first += rows) {
    const cl_uint end = std::min(tiles_, first + rows);
    bands_.push_back({session_.allocate<cl_uchar>(row_bytes * (end - first)), first, end});
  }
}

template <class Launch>
void DeviceDirect::in_windows(const VisibilityRows& of_rows, const VisibilityRows& of_columns, std::size_t group,
                              Pace& pace, const Launch& launch) {
  const double busy = static_cast<double>(busy_work_items(session_.info())) / static_cast<double>(group);
  for (cl_uint row = of_rows.first; row < of_rows.end;) {
    // So many rows h that h (w + h), more than lie below the diagonal, is a launch's work.
    const double w = row - of_columns.first, work = std::max(busy, pace.of_a_launch());
    const auto most = static_cast<cl_uint>(std::max(1.0, 0.5 * (std::sqrt(w * w + 4.0 * work) - w)));
    const cl_uint rows = std::min(of_rows.end - row, most), end = std::min(of_columns.end, row + rows);
    std::vector<double> before{0.0}; // tiles of the window's columns, on and below the diagonal
    for (cl_uint column = of_columns.first; column < end; ++column)
      before.push_back(before.back() + (column <= row ? rows : row + rows - column));
    pace.set_fewest(static_cast<std::size_t>(std::ceil(busy / rows))); // columns; a row may be more than a launch
    for_each_batch(WeighedItems{before}, pace, {}, [&](std::size_t first, std::size_t count) {
      return launch(of_columns.first + static_cast<cl_uint>(first), static_cast<cl_uint>(count), row, rows);
    });
    row += rows;
  }
}

void DeviceDirect::trace(const DevicePools& pools, const TraversalVariant& variant, View<Splat> points,
                         const DirectOptions& options) {
  const Program program = pairs_program(variant);
  cl::Kernel kernel = session_.kernel(program.file, program.options, "pairs_visible");
  const auto table = session_.upload(points.data, points.size);
  const auto rays = session_.allocate<cl_uint>(1);
  Pace pace{2e4}; // tiles
  double done = 0.0;
  const double all = 0.5 * tiles_ * (tiles_ + 1.0);
  for (const VisibilityRows& of_rows : bands_)
    for (const VisibilityRows& of_columns : bands_) {
      if (of_columns.first > of_rows.first) break;
      in_windows(of_rows, of_columns, variant.group.size(), pace,
                 [&](cl_uint column, cl_uint columns, cl_uint row, cl_uint rows) {
                   session_.fill(rays, cl_uint{0}, 1);
                   const double seconds =
                       session_.launch(kernel, LaunchShape::grid(columns, rows, variant.group.size(), 1), pools.nodes,
                                       pools.leaves, pools.points, table, static_cast<cl_uint>(points.size),
                                       cl_uint4{{column, columns, row, rows}}, of_rows.bits, of_columns.bits,
                                       cl_uint2{{of_rows.first, of_columns.first}}, tiles_, rays, options.step_delta);
                   rays_ += session_.download(rays, 1)[0];
                   trace_seconds_ += seconds;
                   double tiles = 0.0;
                   for (cl_uint r = row; r < row + rows; ++r)
                     tiles += r < column ? 0.0 : std::min(columns, r - column + 1);
                   done += tiles;
                   if (options.progress) options.progress(done / all);
                   return seconds;
                 });
    }
}

DeviceDirect::DeviceDirect(Session& session, const DevicePools& pools, const TraversalVariant& variant,
                           View<Splat> points, const DirectOptions& options)
    : session_(session), points_(points.begin(), points.end()),
      tiles_(static_cast<cl_uint>((points.size + FMM_LANES - 1) / FMM_LANES)), stride_(plane_stride(points.size)) {
  if (points.size == 0) return;
  make_bands(options);
  point_buffer_ = session_.upload(point_planes(points_, stride_));
  irradiance_ = session_.allocate<cl_float>(3 * static_cast<std::size_t>(stride_));
  const double row_pairs = static_cast<double>(FMM_LANES) * static_cast<double>(points.size);
  rows_ = Pace(first_pairs / row_pairs, busy_work_items(session_.info()));
  const Program program = fmm_program("radiosity/direct/receive_from_all.cl");
  receive_ = session_.kernel(program.file, program.options, "receive_from_all");
  trace(pools, variant, points, options);
}

void DeviceDirect::apply(View<double> radiosity, LinearisationPoint, std::vector<double>& irradiance) {
  irradiance.clear();
  if (points_.empty()) return;
  const auto flux = session_.upload(flux_planes(radiosity, points_, stride_));
  const std::size_t group = session_.info().is_cpu ? 8 : 32;
  const auto sources = static_cast<cl_uint>(points_.size());
  for (const VisibilityRows& band : bands_)
    for_each_batch(EqualItems{band.end - band.first}, rows_, {}, [&](std::size_t first, std::size_t count) {
      const double seconds =
          session_.launch(receive_, LaunchShape::line(count, group), band.first + static_cast<cl_uint>(first),
                          static_cast<cl_uint>(count), band.bits, band.first, FMM_LANES * tiles_, point_buffer_,
                          sources, stride_, flux, irradiance_);
      apply_seconds_ += seconds;
      return seconds;
    });
  irradiance = rows_of_planes(session_.download(irradiance_, irradiance_.size), points_.size(), stride_);
}

} // namespace pointgi
