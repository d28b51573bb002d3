#include "host/passes/device_pools.h"
#include "host/passes/ray_packets.h"
#include "octree/ref/closest_hit.h"
#include "tests/support/clouds.h"
#include "tests/support/device.h"
#include "tests/support/rays.h"
#include <algorithm>
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;

namespace {

/// What the other two entry points say of the same rays.
struct Other {
  std::vector<cl_uint> blocked;
  std::vector<cl_float4> surfaces; ///< two a ray: normal and t, albedo and 1
};

/// Nearest hits through the octree; `splat` is the index into `splats`.
std::vector<RayAnswer> trace_tree(const std::vector<Splat>& splats, const std::vector<RayQuery>& rays,
                                  const TraversalVariant& variant, Other* other = nullptr,
                                  PointOrder order = PointOrder::morton) {
  TreeOptions options{variant.axis_bits, 8, 21 / variant.axis_bits};
  options.order = order;
  options.listing = variant.form == TraversalForm::wide ? Listing::centres : Listing::overlaps;
  const Tree tree = build_tree(splats, options);
  const OctreePools pools = variant.form == TraversalForm::wide ? OctreePools(pack_wide(splats, tree, variant.lanes))
                                                                : OctreePools(pack_step(splats, tree));
  std::visit([](const auto& p) { verify(p); }, pools);
  Session& device = session();
  const DevicePools on_device = upload_pools(device, pools, variant.storage);
  const auto queries = device.upload(rays);
  const auto answers = device.allocate<RayAnswer>(rays.size());
  cl::Kernel kernel = device.kernel("traverse/trace.cl", build_options(variant), "trace_closest_rays");
  device.launch(kernel, LaunchShape::line(rays.size()), on_device.nodes, on_device.leaves, on_device.points, queries,
                answers, static_cast<cl_uint>(rays.size()), 0.0f);
  if (other != nullptr) {
    const auto blocked = device.allocate<cl_uint>(rays.size());
    const auto surfaces = device.allocate<cl_float4>(2 * rays.size());
    cl::Kernel any = device.kernel("traverse/trace.cl", build_options(variant), "trace_any_rays");
    cl::Kernel blended = device.kernel("traverse/trace.cl", build_options(variant), "trace_blended_rays");
    const auto count = static_cast<cl_uint>(rays.size());
    const LaunchShape shape = LaunchShape::line(rays.size());
    device.launch(any, shape, on_device.nodes, on_device.leaves, on_device.points, queries, blocked, count, 0.0f);
    device.launch(blended, shape, on_device.nodes, on_device.leaves, on_device.points, queries, surfaces, count, 0.0f);
    other->blocked = device.download(blocked, rays.size());
    other->surfaces = device.download(surfaces, 2 * rays.size());
  }
  std::vector<RayAnswer> result = device.download(answers, rays.size());
  for (RayAnswer& answer : result)
    answer.splat = answer.splat == NO_SPLAT ? NO_SPLAT : source_of(pools)[answer.splat];
  return result;
}

/// The same by a linear scan over all splats, on the device.
std::vector<RayAnswer> trace_all(const std::vector<Splat>& splats, const std::vector<RayQuery>& rays) {
  Session& device = session();
  const auto points = device.upload(splats);
  const auto queries = device.upload(rays);
  const auto answers = device.allocate<RayAnswer>(rays.size());
  cl::Kernel kernel = device.kernel("traverse/brute_force.cl", "", "brute_force_closest");
  device.launch(kernel, LaunchShape::line(rays.size()), points, static_cast<cl_uint>(splats.size()), queries, answers,
                static_cast<cl_uint>(rays.size()));
  return device.download(answers, rays.size());
}

/// Rays that find another splat, unless both lie at exactly one distance, or a t further off than 1e-5. (Both kernels
/// round alike, so t should in fact agree to the bit on one device.)
std::size_t differences(const std::vector<RayAnswer>& a, const std::vector<RayAnswer>& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const bool same_splat = a[i].splat == b[i].splat;
    const bool tie = a[i].splat != NO_SPLAT && b[i].splat != NO_SPLAT && a[i].t == b[i].t;
    if (!(same_splat || tie) || !(std::fabs(a[i].t - b[i].t) <= 1e-5f)) ++count;
  }
  return count;
}

std::size_t hits(const std::vector<RayAnswer>& answers) {
  return static_cast<std::size_t>(
      std::count_if(answers.begin(), answers.end(), [](const RayAnswer& a) { return a.splat != NO_SPLAT; }));
}

} // namespace

TEST_CASE("a million hard rays find the splat that a linear scan finds, in every storage and branching") {
  const auto splats = mixed_splats();
  const auto rays = hard_rays(splats, 1'000'000, 11);
  const auto truth = trace_all(splats, rays);
  CHECK(hits(truth) > rays.size() / 3);
  for (const unsigned axis_bits : {1u, 2u})
    for (const PoolStorage storage : {PoolStorage::buffer, PoolStorage::image1d_buffer, PoolStorage::image2d}) {
      CAPTURE(static_cast<int>(storage), axis_bits);
      TraversalVariant variant;
      variant.storage = storage;
      variant.axis_bits = axis_bits;
      CHECK(differences(trace_tree(splats, rays, variant), truth) == 0);
    }
  for (const unsigned lanes : {8u, 16u}) {
    CAPTURE(lanes);
    TraversalVariant variant;
    variant.form = TraversalForm::wide;
    variant.lanes = lanes;
    CHECK(differences(trace_tree(splats, rays, variant), truth) == 0);
  }
}

TEST_CASE("the order of the points in memory does not change what rays find") {
  TraversalVariant variant;
  variant.form = GENERATE(TraversalForm::step, TraversalForm::wide);
  const auto splats = mixed_splats();
  const auto rays = hard_rays(splats, 100'000, 13);
  CHECK(differences(trace_tree(splats, rays, variant, nullptr, PointOrder::hilbert), trace_all(splats, rays)) == 0);
}

TEST_CASE("the device's linear scan agrees with the host's in double precision") {
  const auto splats = random_splats(300, 17);
  const auto rays = hard_rays(splats, 20'000, 19);
  const auto answers = trace_all(splats, rays);
  std::size_t different = 0, counted = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (i % 5 == 2 || i % 5 == 4) continue; // grazing rays and starts on a plane: there float rightly decides otherwise
    const double o[3] = {rays[i].origin[0], rays[i].origin[1], rays[i].origin[2]};
    const double d[3] = {rays[i].direction[0], rays[i].direction[1], rays[i].direction[2]};
    const RayHit truth = closest_hit(splats, o, d, 0.0, 8.0);
    different += truth.splat != answers[i].splat;
    ++counted;
  }
  // Rims: a ray passes within 1e-6 of one with a chance of about 2e-6 / radius a disc, discs being 0.01 to 0.1 in size.
  CHECK(static_cast<double>(different) <= 1e-3 * static_cast<double>(counted));
}

TEST_CASE("rays end: one splat, coincident splats, discs larger than the cells") {
  TraversalVariant variant;
  variant.form = GENERATE(TraversalForm::step, TraversalForm::wide);
  std::vector<Splat> splats;
  SECTION("one") {
    splats = {make_splat(0.5f, 0.5f, 0.5f, 0, 0, 1, 0.2f)};
  }
  SECTION("many in one place") {
    splats.assign(3000, make_splat(0.3f, 0.6f, 0.5f, 1, 2, 3, 1e-4f));
  }
  SECTION("all of them huge") {
    splats = random_splats(200, 9);
    for (Splat& s : splats)
      s.radius = 0.13f;
  }
  const auto rays = hard_rays(splats, 50'000, 21);
  CHECK(differences(trace_tree(splats, rays, variant), trace_all(splats, rays)) == 0);
}

TEST_CASE("any-hit says what closest-hit says, and blending agrees between the forms") {
  const auto splats = mixed_splats();
  const auto rays = hard_rays(splats, 100'000, 31);
  const auto truth = trace_all(splats, rays);
  std::vector<Other> forms;
  for (const TraversalForm form : {TraversalForm::step, TraversalForm::wide})
    for (const unsigned axis_bits : {1u, 2u}) {
      if (form == TraversalForm::wide && axis_bits == 2) continue;
      TraversalVariant variant;
      variant.form = form;
      variant.axis_bits = axis_bits;
      Other other;
      trace_tree(splats, rays, variant, &other);
      std::size_t wrong = 0;
      for (std::size_t i = 0; i < rays.size(); ++i)
        wrong += (other.blocked[i] != 0) != (truth[i].splat != NO_SPLAT);
      CHECK(wrong == 0);
      forms.push_back(other);
    }
  for (std::size_t f = 1; f < forms.size(); ++f) {
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < 2 * rays.size(); ++i)
      for (int c = 0; c < 4; ++c) // sums of a few weights in another order; NaN would be wrong too
        wrong += !(std::fabs(forms[f].surfaces[i].s[c] - forms[0].surfaces[i].s[c]) < 1e-3f);
    // A hit whose t rounds into the neighbouring cell at the window's end may count in one tree and not in the other,
    // and of discs at exactly one distance each tree blends about its own first: planes of discs are full of these.
    CHECK(static_cast<double>(wrong) < 0.01 * 8.0 * static_cast<double>(rays.size()));
  }
}

TEST_CASE("packets of rays find what the rays find one by one") {
  const auto splats = mixed_splats();
  // Narrow bundles and wide ones, along axes, across the octants, from inside discs.
  std::vector<RayQuery> rays;
  const auto middles = hard_rays(splats, 1500, 41);
  std::mt19937 g(43);
  std::normal_distribution<float> gauss;
  for (std::size_t i = 0; i < middles.size(); ++i) {
    const float spread = i % 4 == 0 ? 0.0f : i % 4 == 1 ? 1e-3f : i % 4 == 2 ? 0.05f : 1.0f;
    for (int k = 0; k < PACKET_RAYS; ++k) {
      float d[3];
      for (int a = 0; a < 3; ++a)
        d[a] = middles[i].direction[a] + spread * gauss(g);
      rays.push_back(make_ray(middles[i].origin, d));
    }
  }
  const auto truth = trace_all(splats, rays);
  for (const unsigned lanes : {8u, 16u}) {
    TreeOptions options;
    options.leaf_capacity = 64;
    options.listing = Listing::centres;
    const WidePools pools = pack_wide(splats, build_tree(splats, options), lanes);
    TraversalVariant variant;
    variant.form = TraversalForm::wide;
    variant.lanes = lanes;
    Session& device = session();
    const DevicePools on_device = upload_pools(device, pools);
    const auto queries = device.upload(packets_of(rays));
    const auto answers = device.allocate<RayPacketAnswer>(queries.size);
    cl::Kernel kernel = device.kernel("traverse/trace.cl", build_options(variant), "trace_packets");
    device.launch(kernel, LaunchShape::line(queries.size, 8), on_device.nodes, on_device.leaves, on_device.points,
                  queries, answers, static_cast<cl_uint>(queries.size));
    auto found = rays_of(device.download(answers, queries.size));
    for (RayAnswer& answer : found)
      answer.splat = answer.splat == NO_SPLAT ? NO_SPLAT : pools.source[answer.splat];
    CHECK(differences(found, truth) == 0);
  }
}
