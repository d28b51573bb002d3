#include "host/tune/profile_bench.h"
#include "host/error.h"
#include "host/passes/ray_packets.h"
#include "host/tune/profile_rays.h"
#include <algorithm>

namespace pointgi {

namespace {

std::size_t at(ProfiledKernel kernel) {
  return static_cast<std::size_t>(kernel);
}

constexpr std::size_t first_rays = 4096, fewest_rays = 1024, most_rays = std::size_t{1} << 22;
/// Of a picture: 1024 pixels, so that groups of 64 pixels still keep several cores busy.
constexpr std::size_t fewest_picture_rays = 1024 * GRID_RAYS;
/// Of photons those that set out from leaves; up to four times as many fly, 64 bytes each.
constexpr std::size_t most_photons = std::size_t{1} << 18;

/// Tests of one ray with one splat that the linear scan may take: about a second.
constexpr std::size_t scan_tests = std::size_t{1} << 28;

} // namespace

std::string tree_key(const TraversalVariant& v) {
  return std::string(name_of(v.form)) + " " + std::to_string(v.axis_bits) + " " + name_of(v.order) + " " +
         std::to_string(v.leaf_capacity) + " " + std::to_string(v.form == TraversalForm::wide ? v.lanes : 0) + " " +
         std::to_string(v.max_depth);
}

std::string pools_key(const TraversalVariant& v) {
  return tree_key(v) + " " + name_of(v.storage);
}

ProfileBench::ProfileBench(Session& session, const ProfileRequest& request)
    : session_(session), request_(request), photons_(session, request) {}

bool ProfileBench::measures(ProfiledKernel kernel) const {
  return kernel != ProfiledKernel::photons || photons_.reason_against().empty();
}

ProfiledPools ProfileBench::load(const TraversalVariant& variant) {
  if (last_key_ != tree_key(variant)) {
    last_pools_ = build_pools(request_.splats, variant, request_.clips, request_.bends);
    auto tree = std::make_shared<ProfiledTree>();
    tree->source.assign(source_of(last_pools_).begin(), source_of(last_pools_).end());
    tree->lighting = device_lighting(request_.scene, request_.frame, points_of(last_pools_), clips_of(last_pools_));
    tree->bytes = summary_of(last_pools_).bytes;
    last_tree_ = tree;
    last_key_ = tree_key(variant);
  }
  if (!images_fit(session_.info(), last_pools_, variant.storage))
    throw Error(ErrorKind::device, "the device's images are too small for these pools");
  ProfiledPools pools{last_tree_, upload_pools(session_, last_pools_, variant.storage), nullptr};
  if (photons_.flights().size > 0)
    pools.flight = std::make_shared<DeviceFlight>(photons_.flight(variant, pools.device, pools.tree->source));
  return pools;
}

void ProfileBench::set_photons(const TraversalVariant& reference, ProfiledPools& pools, std::size_t count) {
  session_.label_launches("photons planned");
  rays_[at(ProfiledKernel::photons)] = photons_.plan(reference, pools.device, std::min(count, most_photons));
  if (!measures(ProfiledKernel::photons)) return;
  pools.flight = std::make_shared<DeviceFlight>(photons_.flight(reference, pools.device, pools.tree->source));
}

void ProfileBench::set_rays(ProfiledKernel kernel, std::size_t count) {
  const RenderSettings& picture = request_.scene.render;
  if (kernel == ProfiledKernel::eye) {
    eye_window_ = middle_window(picture.width, picture.height, count / GRID_RAYS);
    const auto rays = eye_rays(device_camera(request_.scene, request_.frame), eye_window_);
    eye_ = session_.upload(rays);
    rays_[at(kernel)] = eye_.size;
    eye_packets_ = session_.upload(packets_of(rays));
    packet_answers_ = session_.allocate<RayPacketAnswer>(eye_packets_.size);
  } else if (kernel == ProfiledKernel::render) {
    render_window_ = middle_window(picture.width, picture.height, count / GRID_RAYS);
  } else {
    bounced_ = session_.upload(bounced_rays(request_.splats, count, request_.seed));
    rays_[at(ProfiledKernel::bounced)] = rays_[at(ProfiledKernel::any)] = rays_[at(ProfiledKernel::segments)] = count;
    blocked_ = session_.allocate<cl_uint>(count);
    if (splats_.size == 0) splats_ = session_.upload(request_.splats);
    segments_ = session_.upload(segments_between(request_.splats.size(), count, request_.seed));
    hidden_ = session_.allocate<cl_uchar>(count);
  }
  answers_ = session_.allocate<RayAnswer>(std::max(eye_.size, bounced_.size));
}

double ProfileBench::trace(ProfiledKernel kernel, const TraversalVariant& variant, const ProfiledPools& pools) {
  const Program program = trace_program(variant);
  const DevicePools& p = pools.device;
  const bool packets = kernel == ProfiledKernel::eye && variant.grouping == RayGrouping::packet;
  const bool any = kernel == ProfiledKernel::any;
  cl::Kernel traced = session_.kernel(program.file, program.options,
                                      packets ? "trace_packets"
                                      : any   ? "trace_any_rays"
                                              : "trace_closest_rays");
  const Buffer<RayQuery>& rays = kernel == ProfiledKernel::eye ? eye_ : bounced_;
  const std::size_t count = packets ? eye_packets_.size : rays.size;
  const LaunchShape shape = LaunchShape::line(count, packets ? 1 : variant.group.size()); // packets as render has them
  const auto number = static_cast<cl_uint>(count);
  if (packets)
    return session_.launch(traced, shape, p.nodes, p.leaves, p.points, eye_packets_, packet_answers_, number);
  if (any) return session_.launch(traced, shape, p.nodes, p.leaves, p.points, rays, blocked_, number, 0.0f);
  return session_.launch(traced, shape, p.nodes, p.leaves, p.points, rays, answers_, number, 0.0f);
}

double ProfileBench::segments(const TraversalVariant& variant, const ProfiledPools& pools) {
  const Program program = segments_program(variant);
  cl::Kernel kernel = session_.kernel(program.file, program.options, "segments_blocked");
  const DevicePools& p = pools.device;
  return session_.launch(kernel, LaunchShape::line(segments_.size, variant.group.size()), p.nodes, p.leaves, p.points,
                         splats_, segments_, hidden_, static_cast<cl_uint>(segments_.size), 0.0f);
}

double ProfileBench::render(const TraversalVariant& variant, const ProfiledPools& pools, Answers* answers) {
  TileRenderer tiles(session_, pools.device, pools.tree->lighting, request_.frame.side, variant, {}, nullptr, true,
                     nullptr, nullptr, Backfaces::shade, nullptr, nullptr, pools.tree->source.size());
  const PixelWindow& w = render_window_;
  const double seconds = tiles.launch(w.x0, w.y0, w.x1 - w.x0, w.y1 - w.y0, 0).all();
  if (answers == nullptr) return seconds;
  answers->film = tiles.film(w.x1 - w.x0, w.y1 - w.y0);
  const auto rays = std::min<pg_uint>(tiles.samples(), GRID_RAYS);
  for (const EyeHits& pixel : tiles.hits(w.x1 - w.x0, w.y1 - w.y0))
    for (pg_uint k = 0; k < rays; ++k)
      answers->hits.push_back({pixel.t[k], pixel.splat[k]});
  to_inputs(answers->hits, pools.tree->source);
  return seconds;
}

double ProfileBench::launch(ProfiledKernel kernel, const TraversalVariant& variant, const ProfiledPools& pools) {
  session_.label_launches(name_of(variant) + " " + name_of(kernel));
  if (kernel == ProfiledKernel::segments) return segments(variant, pools);
  if (kernel == ProfiledKernel::photons) return pools.flight->launch(photons_.flights(), 0, pools.flight->photons());
  return kernel == ProfiledKernel::render ? render(variant, pools, nullptr) : trace(kernel, variant, pools);
}

ProfileBench::Answers ProfileBench::answers(ProfiledKernel kernel, const TraversalVariant& variant,
                                            const ProfiledPools& pools) {
  session_.label_launches(name_of(variant) + " " + name_of(kernel) + ", checked");
  Answers found;
  if (kernel == ProfiledKernel::render) {
    render(variant, pools, &found);
    return found;
  }
  if (kernel == ProfiledKernel::segments) {
    session_.fill(hidden_, cl_uchar{2}, hidden_.size);
    segments(variant, pools);
    const std::vector<cl_uchar> hidden = session_.download(hidden_, hidden_.size);
    found.blocked.assign(hidden.begin(), hidden.end());
    return found;
  }
  if (kernel == ProfiledKernel::photons) {
    PhotonFlight unwritten{};
    unwritten.end = PHOTON_ENDS;
    session_.fill(photons_.flights(), unwritten, photons_.flights().size);
    launch(kernel, variant, pools);
    found.flights = session_.download(photons_.flights(), photons_.flights().size);
    return found;
  }
  // What a kernel leaves unwritten must not be another one's right answer.
  const std::size_t count = kernel == ProfiledKernel::eye ? eye_.size : bounced_.size;
  if (kernel == ProfiledKernel::any) {
    session_.fill(blocked_, 0xffffffffu, count);
    trace(kernel, variant, pools);
    found.blocked = session_.download(blocked_, count);
  } else {
    session_.fill(answers_, RayAnswer{-1.0f, 0xfffffffeu}, count);
    RayPacketAnswer unwritten;
    std::fill(std::begin(unwritten.t), std::end(unwritten.t), -1.0f);
    std::fill(std::begin(unwritten.splat), std::end(unwritten.splat), 0xfffffffeu);
    session_.fill(packet_answers_, unwritten, packet_answers_.size);
    trace(kernel, variant, pools);
    found.hits = kernel == ProfiledKernel::eye && variant.grouping == RayGrouping::packet
                     ? rays_of(session_.download(packet_answers_, packet_answers_.size))
                     : session_.download(answers_, count);
    to_inputs(found.hits, pools.tree->source);
  }
  return found;
}

Differences ProfileBench::launch_and_compare(ProfiledKernel kernel, const TraversalVariant& variant,
                                             const ProfiledPools& pools) {
  const Answers found = answers(kernel, variant, pools), &truth = truth_[at(kernel)];
  switch (kernel) {
  case ProfiledKernel::any:
  case ProfiledKernel::segments:
    return compare_blocked(found.blocked, truth.blocked);
  case ProfiledKernel::photons:
    return compare_flights(found.flights, truth.flights);
  case ProfiledKernel::render:
    return compare_answers(found.hits, truth.hits) +
           compare_films(found.film, truth.film, pools.tree->lighting.emitters.empty());
  case ProfiledKernel::eye:
  case ProfiledKernel::bounced:
    break;
  }
  return compare_answers(found.hits, truth.hits);
}

void ProfileBench::prove(const TraversalVariant& reference, Profile& profile) {
  const std::size_t splats = request_.splats.size();
  const cl::Memory points = upload_points(session_, request_.splats, request_.bends);
  const bool clipped = !request_.clips.empty();
  const Program program = scan_program(reference);
  cl::Kernel scan = session_.kernel(program.file, program.options, "brute_force_closest");
  std::vector<DiscClip> clip_of_each(clipped ? splats : 0); // zero cuts nothing off
  for (const ClippedSplat& c : request_.clips)
    clip_of_each[c.splat] = c.clip;
  for (const ProfiledKernel kernel : {ProfiledKernel::eye, ProfiledKernel::bounced}) {
    const Buffer<RayQuery>& all = kernel == ProfiledKernel::eye ? eye_ : bounced_;
    const std::size_t count = std::min<std::size_t>(std::max<std::size_t>(scan_tests / splats, 256), all.size);
    // Spread over all rays: the first rows of a window may show nothing.
    const std::vector<RayQuery> every = session_.download(all, all.size);
    std::vector<RayQuery> some(count);
    std::vector<RayAnswer> found(count);
    for (std::size_t i = 0; i < count; ++i) {
      some[i] = every[i * all.size / count];
      found[i] = truth_[at(kernel)].hits[i * all.size / count];
    }
    const auto rays = session_.upload(some);
    const auto answers = session_.allocate<RayAnswer>(count);
    session_.label_launches("linear scan");
    const LaunchShape shape = LaunchShape::line(count);
    const auto splat_count = static_cast<cl_uint>(splats), ray_count = static_cast<cl_uint>(count);
    if (clipped)
      session_.launch(scan, shape, points, splat_count, rays, answers, ray_count, session_.upload(clip_of_each));
    else
      session_.launch(scan, shape, points, splat_count, rays, answers, ray_count);
    const Differences d = compare_answers(found, session_.download(answers, count));
    if (d.wrong > 0)
      throw Error(ErrorKind::device, session_.info().name + ": " + name_of(reference) +
                                         ", which all others are checked against, differs from a linear scan in " +
                                         std::to_string(d.wrong) + " of " + std::to_string(count) + " " +
                                         name_of(kernel) + " rays; do not trust this driver, or mend the kernels");
    profile.proved_rays += count;
  }
}

void ProfileBench::take_reference(const TraversalVariant& reference, ProfiledPools& pools, Profile& profile) {
  const auto set = [&](ProfiledKernel kernel, std::size_t count) {
    kernel == ProfiledKernel::photons ? set_photons(reference, pools, count) : set_rays(kernel, count);
  };
  for (const ProfiledKernel kernel :
       {ProfiledKernel::eye, ProfiledKernel::bounced, ProfiledKernel::photons, ProfiledKernel::render}) {
    std::size_t count = first_rays;
    for (int pass = 0; pass < 3; ++pass) { // the first also builds and warms; few rays tell little of many
      if (measures(kernel)) set(kernel, count);
      if (!measures(kernel)) break;
      launch(kernel, reference, pools);
      double seconds = launch(kernel, reference, pools);
      for (int k = 0; k < 2; ++k) // the least: a busy machine must not make the launches small
        seconds = std::min(seconds, launch(kernel, reference, pools));
      seconds = std::max(seconds, 1e-6);
      const double factor = std::clamp(request_.launch_seconds / seconds, 0.05, 50.0);
      count = std::clamp(static_cast<std::size_t>(static_cast<double>(count) * factor),
                         kernel == ProfiledKernel::render ? fewest_picture_rays : fewest_rays, most_rays);
      count = count / GRID_RAYS * GRID_RAYS;
    }
    if (measures(kernel)) set(kernel, count);
  }
  for (std::size_t k = 0; k < profiled_kernels; ++k)
    if (measures(static_cast<ProfiledKernel>(k))) truth_[k] = answers(static_cast<ProfiledKernel>(k), reference, pools);
  const std::vector<float>& film = truth_[at(ProfiledKernel::render)].film;
  for (std::size_t pixel = 0; pixel < film.size(); pixel += FILM_CHANNELS)
    rays_[at(ProfiledKernel::render)] += static_cast<std::uint64_t>(film[pixel + FILM_RAYS]);
  prove(reference, profile);
  profile.rays = rays_;
  profile.without_photons = photons_.reason_against();
  profile.eye_window = eye_window_;
  profile.render_window = render_window_;
}

std::uint64_t ProfileBench::bytes(ProfiledKernel kernel, const TraversalVariant& variant,
                                  const ProfiledPools& pools) const {
  const std::uint64_t pool_bytes = pools.tree->bytes;
  switch (kernel) {
  case ProfiledKernel::any:
    return pool_bytes + rays(kernel) * (sizeof(RayQuery) + sizeof(cl_uint));
  case ProfiledKernel::segments:
    return pool_bytes + rays(kernel) * (sizeof(SegmentQuery) + 2 * sizeof(Splat) + sizeof(cl_uchar));
  case ProfiledKernel::photons:
    return pool_bytes + rays(kernel) * sizeof(PhotonFlight);
  case ProfiledKernel::render: { // two kernels: both read the pools, hits are written and read
    const PixelWindow& w = render_window_;
    const auto pixels = static_cast<std::uint64_t>(w.x1 - w.x0) * (w.y1 - w.y0);
    return 2 * pool_bytes + pixels * (2 * sizeof(EyeHits) + sizeof(float) * FILM_CHANNELS);
  }
  case ProfiledKernel::eye:
    if (variant.grouping == RayGrouping::packet)
      return pool_bytes + eye_packets_.size * (sizeof(RayPacketQuery) + sizeof(RayPacketAnswer));
    break;
  case ProfiledKernel::bounced:
    break;
  }
  return pool_bytes + rays(kernel) * (sizeof(RayQuery) + sizeof(RayAnswer));
}

} // namespace pointgi
