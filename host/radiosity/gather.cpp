#include "host/radiosity/gather.h"
#include "host/error.h"
#include "host/radiosity/block_launches.h"
#include "host/radiosity/point_planes.h"
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace pointgi {

namespace {

constexpr cl_uint senders_at_once = 64;            ///< SENDERS_AT_ONCE of kernels/visibility/senders_visible.cl
constexpr double first_pairs = 2e5;                ///< traced in a first launch, of which nothing is known yet
constexpr std::uint64_t scratch_bytes = 64u << 20; ///< of what is seen and not kept, about

/// Adaptive sampling begins with a sixteenth of the senders, and has twice as many in each pass.
constexpr std::size_t first_share = 16;

bool is_monte_carlo(const GatherOptions& options) {
  return options.sampling == GatherSampling::monte_carlo;
}

std::size_t most_senders(const ClusterTree& tree, const GatherOptions& options) {
  return std::max<std::size_t>(1, tree.points.size() / options.window);
}

void check(const GatherOptions& options) {
  if (options.window < 1) throw std::invalid_argument("gather: a window holds one point at least");
  if (options.reciprocity && options.sampling != GatherSampling::all)
    throw std::invalid_argument("gather: reciprocity is of all pairs");
  if (options.visibility_cache && (is_monte_carlo(options) || options.sampling == GatherSampling::adaptive))
    throw std::invalid_argument("gather: other pairs in each pass, so that nothing of their visibility can be kept");
}

} // namespace

std::uint64_t gather_cache_bytes(GatherSampling sampling, std::size_t points, std::size_t senders) {
  return sampling == GatherSampling::all ? direct_bytes(points)
                                         : (points + FMM_LANES - 1) / FMM_LANES * std::uint64_t{senders};
}

DeviceGather::DeviceGather(Session& session, const DevicePools& pools, const TraversalVariant& variant,
                           const ClusterTree& tree, const GatherOptions& options)
    : session_(session), pools_(pools), tree_(tree), options_(options),
      rows_(static_cast<cl_uint>((tree.points.size() + FMM_LANES - 1) / FMM_LANES)), group_(variant.group.size()) {
  check(options);
  options_.occupancy = nullptr;
  if (tree.points.empty()) return;
  if (options.occupancy != nullptr) occupancy_ = *options.occupancy;
  if (options.sampling == GatherSampling::all) {
    DirectOptions all;
    all.rays_a_pair = options.reciprocity ? 1 : 2;
    all.keep = options.visibility_cache;
    all.occupancy = options.occupancy;
    all.step_delta = options.step_delta;
    all.memory_bytes = options.memory_bytes;
    all.allocation_bytes = options.allocation_bytes;
    all.remedy = "set radiosity.visibility_cache = false, or radiosity.sampling = \"mipmap\"";
    all.progress = options.progress;
    pairs_ = std::make_unique<DeviceDirect>(session, pools, variant, tree.points, all);
    return;
  }
  points_ = std::vector<ExchangePoint>(tree.points.begin(), tree.points.end());
  stride_ = plane_stride(points_.size());
  table_ = session.upload(tree.points.data(), tree.points.size());
  point_planes_ = session.upload(point_planes(points_, stride_));
  irradiance_ = session.allocate<cl_float>(3 * static_cast<std::size_t>(stride_));
  ray_count_ = session.allocate<cl_uint>(1);
  const Program tracing = senders_program(variant, voxels_of(occupancy_), is_monte_carlo(options));
  trace_ = session.kernel(tracing.file, tracing.options, "senders_visible");
  const bool picked = is_monte_carlo(options);
  const Program summing =
      fmm_program(picked ? "radiosity/gather/receive_picked.cl" : "radiosity/gather/receive_from_senders.cl",
                  fmm_lanes_on(session.info()));
  receive_ = session.kernel(summing.file, summing.options, picked ? "receive_from_picked" : "receive_from_senders");
  if (options.sampling == GatherSampling::adaptive) {
    const std::vector<double> even(3 * points_.size(), 1.0);
    first_cut_ = refined_cut(tree, {0}, even, most_senders(tree, options) / first_share);
    take_cut(first_cut_);
  } else
    windows_ = sender_windows(tree, options.window);
  if (picked) {
    members_ = session.upload(windows_.members);
    device_windows_ = session.upload(windows_.windows);
    sender_count_ = static_cast<cl_uint>(windows_.windows.size());
    make_bands();
  } else if (options.sampling != GatherSampling::adaptive)
    take_senders(options.sampling == GatherSampling::fixed ? middle_senders(tree, windows_)
                                                           : mean_senders(tree, windows_));
}

void DeviceGather::take_senders(Senders&& senders) {
  senders_ = std::move(senders);
  sender_count_ = static_cast<cl_uint>(senders_.sends.size());
  sender_stride_ = plane_stride(senders_.sends.size());
  seen_ = session_.upload(senders_.seen);
  sender_planes_ = session_.upload(point_planes(senders_.sends, sender_stride_));
  make_bands();
}

void DeviceGather::take_cut(const ClusterCut& cut) {
  cut_ = cut;
  windows_ = windows_of_cut(tree_, cut_);
  take_senders(mean_senders(tree_, windows_));
}

void DeviceGather::make_bands() {
  bands_.clear();
  const std::uint64_t wanted = gather_cache_bytes(options_.sampling, points_.size(), sender_count_);
  const std::uint64_t available = options_.memory_bytes != 0 ? options_.memory_bytes : session_.bytes_left();
  if (options_.visibility_cache && wanted > available)
    throw Error(ErrorKind::memory, session_.info().name + ": the visibility cache of " +
                                       std::to_string(points_.size()) + " points and " + std::to_string(sender_count_) +
                                       " senders takes a bit a pair, " + megabytes(wanted) + ", and the device has " +
                                       megabytes(available) +
                                       " left; set radiosity.visibility_cache = false, or a larger radiosity.window");
  const std::uint64_t most =
      options_.allocation_bytes != 0 ? options_.allocation_bytes : session_.info().max_allocation_bytes;
  const std::uint64_t piece = options_.visibility_cache ? most : std::min(most, scratch_bytes);
  const auto rows = static_cast<cl_uint>(std::clamp<std::uint64_t>(piece / sender_count_, 1, rows_));
  for (cl_uint first = 0; first < rows_; first += rows) {
    Band band{{}, first, std::min(rows_, first + rows), false};
    if (options_.visibility_cache)
      band.seen = session_.allocate<cl_uchar>(std::size_t{band.end - first} * sender_count_);
    bands_.push_back(std::move(band));
  }
  const double row_pairs = static_cast<double>(FMM_LANES) * sender_count_;
  trace_pace_ = Pace(first_pairs / row_pairs, 1);
  receive_pace_ = pace_of_blocks(session_, 100.0 * first_pairs / row_pairs);
}

SenderRows DeviceGather::launch_of(const Band& band, std::size_t first, std::size_t rows, unsigned pass) const {
  return {band.first,
          band.first + static_cast<cl_uint>(first),
          static_cast<cl_uint>(rows),
          static_cast<cl_uint>(points_.size()),
          sender_count_,
          stride_,
          sender_stride_,
          pass,
          options_.seed,
          options_.step_delta};
}

void DeviceGather::trace(Band& band, unsigned pass) {
  const std::vector<cl::Memory> sight =
      occupancy_ ? occupancy_->arguments() : std::vector<cl::Memory>{pools_.nodes, pools_.leaves, pools_.points};
  const std::vector<cl::Memory> asked = is_monte_carlo(options_)
                                            ? std::vector<cl::Memory>{device_windows_.handle, members_.handle}
                                            : std::vector<cl::Memory>{seen_.handle};
  const auto report = [&](double share) {
    if (options_.progress)
      options_.progress((band.first + share * (band.end - band.first)) / static_cast<double>(rows_));
  };
  for_each_batch(EqualItems{band.end - band.first}, trace_pace_, {{}, report},
                 [&](std::size_t first, std::size_t count) {
                   const LaunchShape shape =
                       LaunchShape::grid((sender_count_ + senders_at_once - 1) / senders_at_once, count, group_, 1);
                   session_.fill(ray_count_, cl_uint{0}, 1);
                   const double seconds = session_.launch(trace_, shape, sight, table_, asked,
                                                          launch_of(band, first, count, pass), band.seen, ray_count_);
                   rays_ += session_.download(ray_count_, 1)[0];
                   return seconds;
                 });
  band.traced = true;
}

void DeviceGather::receive(const Band& band, unsigned pass, const Buffer<cl_float>& flux) {
  const std::size_t group = session_.info().is_cpu ? 8 : 32;
  for_each_batch(EqualItems{band.end - band.first}, receive_pace_, {}, [&](std::size_t first, std::size_t count) {
    const LaunchShape shape = line_of_blocks(session_, count, group);
    const SenderRows at = launch_of(band, first, count, pass);
    if (is_monte_carlo(options_))
      return session_.launch(receive_, shape, at, band.seen, device_windows_, members_, point_planes_, flux,
                             irradiance_);
    return session_.launch(receive_, shape, at, band.seen, point_planes_, sender_planes_, flux, irradiance_);
  });
}

void DeviceGather::gather(View<double> radiosity, unsigned pass, std::vector<double>& irradiance) {
  irradiance.clear();
  if (tree_.points.empty()) return;
  if (pairs_) {
    pairs_->apply(radiosity, LinearisationPoint::current, irradiance);
    return;
  }
  if (options_.sampling == GatherSampling::adaptive) {
    if (pass == 0)
      take_cut(first_cut_);
    else if (!is_refined())
      take_cut(refined_cut(tree_, cut_, radiosity, std::min(most_senders(tree_, options_), 2 * cut_.size())));
  }
  const auto sent = [&] {
    return options_.sampling == GatherSampling::fixed ? middle_radiosity(senders_, radiosity)
                                                      : mean_radiosity(tree_, windows_, radiosity);
  };
  const auto flux = is_monte_carlo(options_) ? session_.upload(flux_planes(radiosity, points_, stride_))
                                             : session_.upload(flux_planes(sent(), senders_.sends, sender_stride_));
  Buffer<cl_uchar> scratch;
  if (!options_.visibility_cache)
    scratch = session_.allocate<cl_uchar>(std::size_t{bands_.front().end} * sender_count_);
  for (Band& band : bands_) {
    if (!options_.visibility_cache) band.seen = scratch;
    if (!options_.visibility_cache || !band.traced) trace(band, pass);
    receive(band, pass, flux);
    if (!options_.visibility_cache) band.seen = {};
  }
  irradiance = rows_of_planes(session_.download(irradiance_, irradiance_.size), points_.size(), stride_);
}

std::size_t DeviceGather::senders() const {
  return pairs_ ? tree_.points.size() : sender_count_;
}

bool DeviceGather::is_refined() const {
  if (options_.sampling != GatherSampling::adaptive) return true;
  const bool divisible =
      std::any_of(cut_.begin(), cut_.end(), [&](std::uint32_t node) { return tree_.nodes[node].child_count > 0; });
  return !divisible || cut_.size() >= most_senders(tree_, options_);
}

std::uint64_t DeviceGather::rays() const {
  return pairs_ ? pairs_->rays() : rays_;
}

std::uint64_t DeviceGather::cache_bytes() const {
  if (pairs_) return pairs_->kept_bytes();
  std::uint64_t bytes = 0;
  for (const Band& band : bands_)
    bytes += band.seen.size;
  return bytes;
}

} // namespace pointgi
