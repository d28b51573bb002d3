#include "host/radiosity/directions.h"
#include "host/radiosity/point_blocks.h"
#include "shared/fmm_types.h"
#include "shared/traversal_types.h"
#include <algorithm>

namespace pointgi {

namespace {

/// Points of the first launch, of which nothing is known yet.
constexpr double first_traced = 256, first_received = 65536;

cl_uint points_an_item(const TraversalVariant& variant, DirectionPattern pattern) {
  return directions_in_beams(variant, pattern == DirectionPattern::hemicube) ? BEAM_RAYS : 1;
}

constexpr std::size_t receive_group = 64;
constexpr std::size_t piece = 1 << 18;      ///< points whose light travels between host and device at once
constexpr std::size_t most_rays = 1u << 30; ///< of the smallest launch: their count has 32 bits

/// Points whose hits lie together; of beams besides. Bands begin at whole blocks.
constexpr cl_uint block = BEAM_RAYS;
static_assert(block % FMM_LANES == 0);

std::uint64_t in_whole_blocks(std::uint64_t points) {
  return points / block * block;
}

} // namespace

std::uint64_t bytes_for_hits(std::uint64_t left, std::size_t pool) {
  constexpr std::uint64_t a_run = 350, least = 24; // a point
  const std::uint64_t usable = left / 4 * 3, an_apply = 2 * sizeof(cl_float4) * pool;
  const std::uint64_t room = usable - std::min(usable, an_apply);
  return std::max(room - std::min(room, a_run * pool), std::min(room, least * pool));
}

DeviceDirections::DeviceDirections(Session& session, const DevicePools& pools, const TraversalVariant& variant,
                                   View<Splat> pool, View<std::uint32_t> places, const DirectionsOptions& options)
    : session_(session), pools_(pools), set_(direction_set(options.pattern, options.directions)), pool_(pool),
      hemicube_(options.pattern == DirectionPattern::hemicube),
      points_an_item_(points_an_item(variant, options.pattern)), group_(points_an_item_ > 1 ? 1 : variant.group.size()),
      seed_(options.seed), step_delta_(options.step_delta), places_(places),
      trace_pace_(first_traced / points_an_item_,
                  std::min<std::size_t>(busy_work_items(session.info()),
                                        most_rays / points_an_item_ / set_.weights.size() + 1)),
      receive_pace_(first_received, busy_work_items(session.info())) {
  if (places_.size == 0) return;
  if (!std::is_sorted(places_.begin(), places_.end())) throw std::invalid_argument("directions: places do not ascend");
  const Program tracing = directions_program(variant, hemicube_);
  trace_ = session.kernel(tracing.file, tracing.options, "trace_directions");
  receive_ = session.kernel("radiosity/directions/receive.cl", "", "receive_by_directions");
  order_.assign(places_.begin(), places_.end());
  if (points_an_item_ > 1) order_ = in_blocks(pool, std::move(order_), points_an_item_);
  place_buffer_ = session.upload(order_);
  if (places_[places_.size - 1] + std::size_t{1} != places_.size) // else each point is its own place
    for (std::uint32_t& place : order_)
      place = static_cast<std::uint32_t>(std::lower_bound(places_.begin(), places_.end(), place) - places_.begin());
  cells_ = session.upload(set_.cells);
  weights_ = session.upload(set_.weights);
  ways_ = session.allocate<float>(places_.size);
  ray_count_ = session.allocate<cl_uint>(2);
  irradiance_ = session.allocate<cl_float4>(places_.size);
  keep_bands(options);
}

void DeviceDirections::keep_bands(const DirectionsOptions& options) {
  const std::uint64_t a_point = sizeof(cl_uint) * set_.weights.size(), points = places_.size;
  const std::uint64_t one_buffer = session_.info().max_allocation_bytes;
  const std::uint64_t available = options.memory_bytes != 0
                                      ? options.memory_bytes
                                      : std::max<std::uint64_t>(1, bytes_for_hits(session_.bytes_left(), pool_.size));
  const std::uint64_t largest = std::max<std::uint64_t>(block, in_whole_blocks(one_buffer / a_point));
  // A band that is not kept needs its room, too.
  at_once_ = static_cast<cl_uint>(std::clamp<std::uint64_t>(in_whole_blocks(available / 8 / a_point), block,
                                                            std::min<std::uint64_t>(largest, 1u << 16)));
  std::uint64_t keep = points;
  if (points * a_point > available)
    keep = in_whole_blocks((available - std::min(available, at_once_ * a_point)) / a_point);
  while (kept_ < keep) {
    Band band;
    band.first = kept_;
    band.end = static_cast<cl_uint>(std::min(keep, kept_ + largest));
    const std::uint64_t room = (band.end - band.first + block - 1) / block * block;
    band.hits = session_.allocate<cl_uint>(room * set_.weights.size());
    trace(band, [&](double share) {
      if (options.progress)
        options.progress((band.first + share * (band.end - band.first)) / static_cast<double>(keep));
    });
    kept_ = band.end;
    bands_.push_back(std::move(band));
  }
}

void DeviceDirections::trace(const Band& band, const std::function<void(double)>& progress) {
  const auto count = static_cast<cl_uint>(set_.weights.size());
  const std::size_t items = (band.end - band.first + points_an_item_ - 1) / points_an_item_;
  for_each_batch(EqualItems{items}, trace_pace_, {{}, progress}, [&](std::size_t first, std::size_t size) {
    const cl_uint from = band.first + points_an_item_ * static_cast<cl_uint>(first);
    const cl_uint to = std::min(band.end, from + points_an_item_ * static_cast<cl_uint>(size));
    session_.fill(ray_count_, cl_uint{0}, 2);
    const double seconds = session_.launch(trace_, LaunchShape::line(size, group_), pools_.nodes, pools_.leaves,
                                           pools_.points, place_buffer_, from, to, cells_, count, seed_, band.hits,
                                           band.first, ways_, ray_count_, step_delta_);
    const auto counts = session_.download(ray_count_, 2);
    rays_ += counts[0];
    beam_rays_ += counts[1];
    trace_seconds_ += seconds;
    return seconds;
  });
}

void DeviceDirections::receive(const Band& band, const Buffer<cl_float4>& radiosity) {
  for_each_batch(EqualItems{band.end - band.first}, receive_pace_, {}, [&](std::size_t first, std::size_t size) {
    const cl_uint from = band.first + static_cast<cl_uint>(first);
    return session_.launch(receive_, LaunchShape::line(size, receive_group), band.hits, band.first, from,
                           from + static_cast<cl_uint>(size), weights_, static_cast<cl_uint>(set_.weights.size()),
                           radiosity, irradiance_);
  });
}

void DeviceDirections::for_each_band(const std::function<void(const Band&)>& use) {
  for (const Band& band : bands_)
    use(band);
  Band again;
  if (kept_ < places_.size) again.hits = session_.allocate<cl_uint>(std::size_t{at_once_} * set_.weights.size());
  for (again.first = kept_; again.first < places_.size; again.first = again.end) {
    again.end = static_cast<cl_uint>(std::min<std::size_t>(places_.size, again.first + at_once_));
    trace(again, {});
    use(again);
  }
}

/// Of the points in the order in which they are traced; in pieces, as upload_radiosity.
Buffer<cl_float4> DeviceDirections::upload_normals() {
  const auto sent = session_.allocate<cl_float4>(places_.size, CL_MEM_READ_ONLY);
  std::vector<cl_float4> texels;
  for (std::size_t first = 0; first < places_.size; first += piece) {
    texels.clear();
    for (std::size_t k = first; k < std::min(places_.size, first + piece); ++k) {
      const float* normal = pool_[places_[order_[k]]].normal;
      texels.push_back({{normal[0], normal[1], normal[2], 0.0f}});
    }
    session_.write(sent, texels.data(), texels.size(), first);
  }
  return sent;
}

std::vector<float> DeviceDirections::sky(const DeviceLighting& lighting) {
  if (places_.size == 0) return {};
  const bool map = lighting.sky != nullptr;
  const Program program = sky_program(hemicube_, map);
  cl::Kernel kernel = session_.kernel(program.file, program.options, "sky_by_directions");
  const auto count = static_cast<cl_uint>(set_.weights.size());
  const auto launch_with = [&](const auto&... sky) {
    for_each_band([&](const Band& band) {
      for_each_batch(EqualItems{band.end - band.first}, receive_pace_, {}, [&](std::size_t first, std::size_t size) {
        const cl_uint from = band.first + static_cast<cl_uint>(first);
        return session_.launch(kernel, LaunchShape::line(size, receive_group), band.hits, band.first, from,
                               from + static_cast<cl_uint>(size), weights_, count, sky..., irradiance_);
      });
    });
  };
  if (map) {
    launch_with(place_buffer_, upload_normals(), cells_, seed_, session_.upload(lighting.smooth_sky));
  } else {
    const float* radiance = lighting.params.environment;
    launch_with(cl_float4{{radiance[0], radiance[1], radiance[2], 0.0f}});
  }
  std::vector<float> of_places(3 * places_.size);
  for_each_piece(irradiance_,
                 [&](std::size_t place, const cl_float4& found) { std::copy_n(found.s, 3, &of_places[3 * place]); });
  return of_places;
}

std::vector<float> DeviceDirections::mean_ways() {
  if (places_.size == 0) return {};
  if (!keeps_all()) for_each_band([](const Band&) {});
  std::vector<float> of_places(places_.size);
  for_each_piece(ways_, [&](std::size_t place, float way) { of_places[place] = way; });
  return of_places;
}

template <class T, class Take>
void DeviceDirections::for_each_piece(const Buffer<T>& found, const Take& take) {
  for (std::size_t first = 0; first < places_.size; first += piece) {
    const std::vector<T> some = session_.download(found, std::min(piece, places_.size - first), first);
    for (std::size_t k = 0; k < some.size(); ++k)
      take(order_[first + k], some[k]);
  }
}

/// Of all points of the pool, 0 of those that exchange none; in pieces, so that the host needs no copy of them all.
Buffer<cl_float4> DeviceDirections::upload_radiosity(View<double> radiosity) {
  const auto sent = session_.allocate<cl_float4>(pool_.size, CL_MEM_READ_ONLY);
  std::vector<cl_float4> texels;
  for (std::size_t first = 0, i = 0; first < pool_.size; first += piece) {
    const std::size_t end = std::min(pool_.size, first + piece);
    texels.assign(end - first, cl_float4{{0, 0, 0, 0}});
    for (; i < places_.size && places_[i] < end; ++i)
      for (std::size_t c = 0; c < 3; ++c)
        texels[places_[i] - first].s[c] = static_cast<float>(radiosity[3 * i + c]);
    session_.write(sent, texels.data(), texels.size(), first);
  }
  return sent;
}

void DeviceDirections::apply(View<double> radiosity, LinearisationPoint, std::vector<double>& irradiance) {
  if (radiosity.size != 3 * places_.size) throw std::invalid_argument("radiosity is not [points x 3]");
  irradiance.resize(radiosity.size);
  if (places_.size == 0) return;
  const auto sent = upload_radiosity(radiosity);
  for_each_band([&](const Band& band) { receive(band, sent); });
  for_each_piece(irradiance_, [&](std::size_t place, const cl_float4& received) {
    std::copy_n(received.s, 3, &irradiance[3 * place]);
  });
}

std::uint64_t DeviceDirections::kept_bytes() const {
  std::uint64_t bytes = 0;
  for (const Band& band : bands_)
    bytes += sizeof(cl_uint) * band.hits.size;
  return bytes;
}

} // namespace pointgi
