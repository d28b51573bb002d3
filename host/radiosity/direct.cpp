#include "host/radiosity/direct.h"
#include "host/cl/resource_error.h"
#include "host/error.h"
#include "host/passes/variant.h"
#include "host/radiosity/point_planes.h"
#include <cmath>

namespace pointgi {

namespace {

constexpr double first_pairs = 2e7; ///< of a first launch, of which nothing is known yet

/// Rows of tiles that are traced and forgotten: a multiple of the senders that are summed apart, DIRECT_SOURCES of
/// kernels/radiosity/direct/receive_from_all.cl, so that sums have the bits of kept ones; and about this much memory.
constexpr cl_uint rows_of_sums = 256 / FMM_LANES;
constexpr std::uint64_t scratch_bytes = 64u << 20;

} // namespace

std::uint64_t direct_bytes(std::size_t points) {
  const std::uint64_t tiles = (points + FMM_LANES - 1) / FMM_LANES;
  return FMM_LANES * tiles * tiles;
}

DeviceDirect::Tiles DeviceDirect::allocate_tiles(cl_uint first, cl_uint end, cl_uint first_column, cl_uint end_column) {
  Tiles tiles{{}, first, end, first_column, end_column};
  // An empty piece is an argument of kernels that do not use it.
  tiles.bits =
      session_.allocate<cl_uchar>(std::max<std::uint64_t>(1, std::uint64_t{tiles.row_bytes()} * (end - first)));
  return tiles;
}

void DeviceDirect::make_bands(const DirectOptions& options) {
  const DeviceInfo& info = session_.info();
  const std::uint64_t row_bytes = static_cast<std::uint64_t>(FMM_LANES) * tiles_, wanted = direct_bytes(points_.size());
  const std::uint64_t available = options.memory_bytes != 0 ? options.memory_bytes : session_.bytes_left();
  if (wanted > available)
    throw Error(ErrorKind::memory, info.name + ": the visibility of all pairs of " + std::to_string(points_.size()) +
                                       " points takes a bit a pair, " + megabytes(wanted) + ", and the device has " +
                                       megabytes(available) + " left; " + options.remedy);
  const std::uint64_t piece = options.allocation_bytes != 0 ? options.allocation_bytes : info.max_allocation_bytes;
  const auto rows = static_cast<cl_uint>(std::clamp<std::uint64_t>(piece / row_bytes, 1, tiles_));
  for (cl_uint first = 0; first < tiles_; first += rows)
    bands_.push_back(allocate_tiles(first, std::min(tiles_, first + rows), 0, tiles_));
}

template <class Launch>
void DeviceDirect::in_windows(cl_uint first_row, cl_uint end_row, cl_uint first_column, cl_uint end_column,
                              const Launch& launch) {
  const double busy = static_cast<double>(busy_work_items(session_.info())) / static_cast<double>(group_);
  for (cl_uint row = first_row; row < end_row;) {
    // So many rows h that h (w + h), more than lie below the diagonal, is a launch's work.
    const double w = row - first_column, work = std::max(busy, trace_pace_.of_a_launch());
    const auto most = static_cast<cl_uint>(std::max(1.0, 0.5 * (std::sqrt(w * w + 4.0 * work) - w)));
    const cl_uint rows = std::min(end_row - row, most), end = std::min(end_column, row + rows);
    std::vector<double> before{0.0}; // tiles of the window's columns, on and below the diagonal
    for (cl_uint column = first_column; column < end; ++column)
      before.push_back(before.back() + (column <= row ? rows : row + rows - column));
    trace_pace_.set_fewest(
        static_cast<std::size_t>(std::ceil(busy / rows))); // columns; a row may be more than a launch
    for_each_batch(WeighedItems{before}, trace_pace_, {}, [&](std::size_t first, std::size_t count) {
      return launch(first_column + static_cast<cl_uint>(first), static_cast<cl_uint>(count), row, rows);
    });
    row += rows;
  }
}

void DeviceDirect::trace(const Tiles& of_rows, const Tiles& of_columns, cl_uint first_column, cl_uint end_column) {
  const double all = 0.5 * tiles_ * (tiles_ + 1.0);
  const std::vector<cl::Memory> sight =
      occupancy_ ? occupancy_->arguments() : std::vector<cl::Memory>{pools_.nodes, pools_.leaves, pools_.points};
  in_windows(of_rows.first, of_rows.end, first_column, end_column,
             [&](cl_uint column, cl_uint columns, cl_uint row, cl_uint rows) {
               session_.fill(ray_count_, cl_uint{0}, 1);
               const double seconds = session_.launch(
                   pairs_, LaunchShape::grid(columns, rows, group_, 1), sight, table_,
                   static_cast<cl_uint>(points_.size()), cl_uint4{{column, columns, row, rows}}, of_rows.bits,
                   of_rows.place(), of_columns.bits, of_columns.place(), ray_count_, step_delta_);
               rays_ += session_.download(ray_count_, 1)[0];
               trace_seconds_ += seconds;
               for (cl_uint r = row; r < row + rows; ++r)
                 tiles_done_ += r < column ? 0.0 : std::min(columns, r - column + 1);
               if (progress_) progress_(std::min(1.0, tiles_done_ / all));
               return seconds;
             });
}

DeviceDirect::DeviceDirect(Session& session, const DevicePools& pools, const TraversalVariant& variant,
                           View<Splat> points, const DirectOptions& options)
    : session_(session), pools_(pools), points_(points.begin(), points.end()),
      tiles_(static_cast<cl_uint>((points.size + FMM_LANES - 1) / FMM_LANES)), stride_(plane_stride(points.size)),
      keep_(options.keep), group_(variant.group.size()), step_delta_(options.step_delta) {
  if (points.size == 0) return;
  if (options.occupancy != nullptr) occupancy_ = *options.occupancy;
  if (keep_) make_bands(options);
  point_buffer_ = session_.upload(point_planes(points_, stride_));
  irradiance_ = session_.allocate<cl_float>(3 * static_cast<std::size_t>(stride_));
  table_ = session_.upload(points.data, points.size);
  ray_count_ = session_.allocate<cl_uint>(1);
  const double row_pairs = static_cast<double>(FMM_LANES) * static_cast<double>(points.size);
  rows_ = Pace(first_pairs / row_pairs, busy_work_items(session_.info()));
  const Program summing = fmm_program("radiosity/direct/receive_from_all.cl");
  receive_ = session_.kernel(summing.file, summing.options, "receive_from_all");
  const Program tracing = pairs_program(variant, voxels_of(occupancy_));
  pairs_ = session_.kernel(tracing.file, tracing.options, "pairs_visible");
  progress_ = options.progress;
  for (const Tiles& of_rows : bands_)
    for (const Tiles& of_columns : bands_) {
      if (of_columns.first > of_rows.first) break;
      trace(of_rows, of_columns, of_columns.first, of_columns.end);
    }
}

void DeviceDirect::receive(const Tiles& tiles, cl_uint first, cl_uint end, const Buffer<cl_float>& flux) {
  const std::size_t group = session_.info().is_cpu ? 8 : 32;
  const auto sources = static_cast<cl_uint>(points_.size());
  for_each_batch(EqualItems{end - first}, rows_, {}, [&](std::size_t from, std::size_t count) {
    const double seconds =
        session_.launch(receive_, LaunchShape::line(count, group), first + static_cast<cl_uint>(from),
                        static_cast<cl_uint>(count), tiles.bits, tiles.first, tiles.row_bytes(),
                        FMM_LANES * tiles.first_column, std::min(sources, FMM_LANES * tiles.end_column), point_buffer_,
                        stride_, point_buffer_, flux, stride_, irradiance_);
    apply_seconds_ += seconds;
    return seconds;
  });
}

void DeviceDirect::trace_and_receive(const Buffer<cl_float>& flux) {
  tiles_done_ = 0.0;
  const std::uint64_t a_row = 2 * std::uint64_t{FMM_LANES} * tiles_;
  const auto rows =
      static_cast<cl_uint>(std::max<std::uint64_t>(1, scratch_bytes / a_row / rows_of_sums)) * rows_of_sums;
  for (cl_uint first = 0; first < tiles_; first += rows) {
    const cl_uint end = std::min(tiles_, first + rows);
    const Tiles of_rows = allocate_tiles(first, end, 0, end), of_columns = allocate_tiles(0, first, first, end);
    trace(of_rows, of_columns, 0, end);
    receive(of_rows, first, end, flux);
    receive(of_columns, 0, first, flux);
  }
}

void DeviceDirect::apply(View<double> radiosity, LinearisationPoint, std::vector<double>& irradiance) {
  irradiance.clear();
  if (points_.empty()) return;
  const auto flux = session_.upload(flux_planes(radiosity, points_, stride_));
  session_.fill(irradiance_, 0.0f, irradiance_.size);
  for (const Tiles& band : bands_)
    receive(band, band.first, band.end, flux);
  if (!keep_) trace_and_receive(flux);
  irradiance = rows_of_planes(session_.download(irradiance_, irradiance_.size), points_.size(), stride_);
}

} // namespace pointgi
