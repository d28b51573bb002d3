#include "host/radiosity/direct.h"
#include "host/cl/resource_error.h"
#include "host/error.h"
#include "host/radiosity/block_launches.h"
#include "host/radiosity/point_planes.h"
#include <cmath>

namespace pointgi {

namespace {

constexpr double first_pairs = 2e7; ///< of a first launch, of which nothing is known yet

constexpr std::uint64_t scratch_bytes = 64u << 20; ///< of a band that is traced and forgotten, about

std::uint64_t bytes_of_rows(cl_uint first_square, cl_uint end_square) {
  return sizeof(cl_ulong) * (PAIR_TILES(end_square) - PAIR_TILES(first_square));
}

} // namespace

std::uint64_t direct_bytes(std::size_t points) {
  return sizeof(cl_ulong) * PAIR_TILES((points + SENDERS_SUMMED - 1) / SENDERS_SUMMED);
}

void DeviceDirect::check_memory(const DirectOptions& options) const {
  const std::uint64_t wanted = direct_bytes(points_.size());
  const std::uint64_t available = options.memory_bytes != 0 ? options.memory_bytes : session_.bytes_left();
  if (wanted > available)
    throw Error(ErrorKind::memory, session_.info().name + ": the visibility of all pairs of " +
                                       std::to_string(points_.size()) + " points takes a bit a pair, " +
                                       megabytes(wanted) + ", and the device has " + megabytes(available) + " left; " +
                                       options.remedy);
}

void DeviceDirect::make_bands(std::uint64_t bytes) {
  const cl_uint squares = (tiles_ + SQUARE_TILES - 1) / SQUARE_TILES;
  for (cl_uint first = 0, end = 0; first < squares; first = end) {
    for (end = first + 1; end < squares && bytes_of_rows(first, end + 1) <= bytes;)
      ++end;
    bands_.push_back({{}, SQUARE_TILES * first, std::min(SQUARE_TILES * end, tiles_)});
  }
}

void DeviceDirect::allocate(Band& band) {
  band.tiles = session_.allocate<cl_ulong>(PAIR_TILES((band.end + SQUARE_TILES - 1) / SQUARE_TILES) -
                                           PAIR_TILES(band.first / SQUARE_TILES));
}

template <class Launch>
void DeviceDirect::in_windows(const Band& band, const Launch& launch) {
  const double busy = static_cast<double>(busy_work_items(session_.info())) / static_cast<double>(group_);
  for (cl_uint row = band.first; row < band.end;) {
    // So many rows h that h (w + h), more than lie below the diagonal, is a launch's work.
    const double w = row, work = std::max(busy, trace_pace_.of_a_launch());
    const auto most = static_cast<cl_uint>(std::max(1.0, 0.5 * (std::sqrt(w * w + 4.0 * work) - w)));
    const cl_uint rows = std::min(band.end - row, most);
    std::vector<double> before{0.0}; // tiles of the window's columns, on and below the diagonal
    for (cl_uint column = 0; column < row + rows; ++column)
      before.push_back(before.back() + (column <= row ? rows : row + rows - column));
    trace_pace_.set_fewest(
        static_cast<std::size_t>(std::ceil(busy / rows))); // columns; a row may be more than a launch
    for_each_batch(WeighedItems{before}, trace_pace_, {}, [&](std::size_t first, std::size_t count) {
      return launch(static_cast<cl_uint>(first), static_cast<cl_uint>(count), row, rows);
    });
    row += rows;
  }
}

PairRows DeviceDirect::launch_of(const Band& band, cl_uint row, cl_uint rows, cl_uint column, cl_uint columns) const {
  return {band.first, band.end, row, rows, column, columns, static_cast<cl_uint>(points_.size()), stride_, step_delta_};
}

void DeviceDirect::trace(const Band& band) {
  const double all = 0.5 * tiles_ * (tiles_ + 1.0) * rays_a_pair_;
  const std::vector<cl::Memory> sight =
      occupancy_ ? occupancy_->arguments() : std::vector<cl::Memory>{pools_.nodes, pools_.leaves, pools_.points};
  for (unsigned end = 0; end < rays_a_pair_; ++end)
    in_windows(band, [&](cl_uint column, cl_uint columns, cl_uint row, cl_uint rows) {
      session_.fill(ray_count_, cl_uint{0}, 1);
      const double seconds = session_.launch(pairs_, LaunchShape::grid(columns, rows, group_, 1), sight, table_,
                                             launch_of(band, row, rows, column, columns), band.tiles, ray_count_);
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
      keep_(options.keep), rays_a_pair_(options.rays_a_pair), group_(variant.group.size()),
      step_delta_(options.step_delta) {
  if (points.size == 0) return;
  if (options.occupancy != nullptr) occupancy_ = *options.occupancy;
  if (keep_) check_memory(options);
  const std::uint64_t piece =
      options.allocation_bytes != 0 ? options.allocation_bytes : session_.info().max_allocation_bytes;
  make_bands(keep_ ? piece : std::min(piece, scratch_bytes));
  if (keep_)
    for (Band& band : bands_)
      allocate(band);
  point_buffer_ = session_.upload(point_planes(points_, stride_));
  irradiance_ = session_.allocate<cl_float>(3 * static_cast<std::size_t>(stride_));
  table_ = session_.upload(points.data, points.size);
  ray_count_ = session_.allocate<cl_uint>(1);
  receive_pace_ = pace_of_blocks(session_, first_pairs / (FMM_LANES * FMM_LANES));
  const Program summing = fmm_program("radiosity/direct/receive_from_all.cl", fmm_lanes_on(session_.info()));
  receive_ = session_.kernel(summing.file, summing.options, "receive_from_all");
  const Program tracing = pairs_program(variant, voxels_of(occupancy_));
  pairs_ = session_.kernel(tracing.file, tracing.options, "pairs_visible");
  progress_ = options.progress;
  if (keep_)
    for (const Band& band : bands_)
      trace(band);
}

void DeviceDirect::receive(const Band& band, const Buffer<cl_float>& flux) {
  const std::size_t group = session_.info().is_cpu ? 8 : 32;
  std::vector<double> before{0.0}; // tiles that the rows read
  for (cl_uint row = 0; row < band.end; ++row)
    before.push_back(before.back() + (row < band.first ? band.end - band.first : band.end));
  for_each_batch(WeighedItems{before}, receive_pace_, {}, [&](std::size_t first, std::size_t count) {
    const double seconds =
        session_.launch(receive_, line_of_blocks(session_, count, group),
                        launch_of(band, static_cast<cl_uint>(first), static_cast<cl_uint>(count), 0, band.end),
                        band.tiles, point_buffer_, flux, irradiance_);
    apply_seconds_ += seconds;
    return seconds;
  });
}

std::uint64_t DeviceDirect::kept_bytes() const {
  std::uint64_t bytes = 0;
  for (const Band& band : bands_)
    bytes += sizeof(cl_ulong) * band.tiles.size;
  return bytes;
}

void DeviceDirect::apply(View<double> radiosity, LinearisationPoint, std::vector<double>& irradiance) {
  irradiance.clear();
  if (points_.empty()) return;
  const auto flux = session_.upload(flux_planes(radiosity, points_, stride_));
  session_.fill(irradiance_, 0.0f, irradiance_.size);
  if (!keep_) tiles_done_ = 0.0;
  for (Band& band : bands_) {
    if (!keep_) {
      allocate(band);
      trace(band);
    }
    receive(band, flux);
    if (!keep_) band.tiles = {};
  }
  irradiance = rows_of_planes(session_.download(irradiance_, irradiance_.size), points_.size(), stride_);
}

} // namespace pointgi
