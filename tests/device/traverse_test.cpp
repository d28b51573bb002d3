#include "host/passes/build_pools.h"
#include "host/passes/device_pools.h"
#include "host/passes/ray_packets.h"
#include "host/tune/variant_list.h"
#include "octree/ref/closest_hit.h"
#include "tests/support/answers.h"
#include "tests/support/clouds.h"
#include "tests/support/device.h"
#include "tests/support/rays.h"
#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

using namespace pointgi;
using namespace pointgi::test;

namespace {

/// What the other two entry points say of the same rays.
struct Other {
  std::vector<cl_uint> blocked;
  std::vector<cl_float4> surfaces; ///< two a ray: normal and t, albedo and 1
};

/// Nearest hits through the octree, one ray a work-item whatever the variant's grouping; `splat` is the index into
/// `splats`.
std::vector<RayAnswer> trace_tree(const std::vector<Splat>& splats, const std::vector<RayQuery>& rays,
                                  TraversalVariant variant, Other* other = nullptr,
                                  Backfaces backfaces = Backfaces::shade, const SplatClips& clips = {}) {
  variant.clips = !clips.empty();
  const OctreePools pools = build_pools(splats, variant, clips);
  std::visit([](const auto& p) { verify(p); }, pools);
  Session& device = session();
  const DevicePools on_device = upload_pools(device, pools, variant.storage);
  const auto queries = device.upload(rays);
  const auto answers = device.allocate<RayAnswer>(rays.size());
  const Program program = trace_program(variant, backfaces);
  const LaunchShape shape = LaunchShape::line(rays.size(), variant.group.size());
  cl::Kernel kernel = device.kernel(program.file, program.options, "trace_closest_rays");
  device.launch(kernel, shape, on_device.nodes, on_device.leaves, on_device.points, queries, answers,
                static_cast<cl_uint>(rays.size()), 0.0f);
  if (other != nullptr) {
    const auto blocked = device.allocate<cl_uint>(rays.size());
    const auto surfaces = device.allocate<cl_float4>(2 * rays.size());
    cl::Kernel any = device.kernel(program.file, program.options, "trace_any_rays");
    cl::Kernel blended = device.kernel(program.file, program.options, "trace_blended_rays");
    const auto count = static_cast<cl_uint>(rays.size());
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
std::vector<RayAnswer> trace_all(const std::vector<Splat>& splats, const std::vector<RayQuery>& rays,
                                 Backfaces backfaces = Backfaces::shade, const SplatClips& clips = {}) {
  Session& device = session();
  const auto points = device.upload(splats);
  const auto queries = device.upload(rays);
  const auto answers = device.allocate<RayAnswer>(rays.size());
  const std::string options =
      std::string(backfaces == Backfaces::see_through ? "-D FRONTS_ONLY" : "") + (clips.empty() ? "" : " -D HAS_CLIPS");
  cl::Kernel kernel = device.kernel("test/brute_force.cl", options, "brute_force_closest");
  const auto count = static_cast<cl_uint>(rays.size());
  const LaunchShape shape = LaunchShape::line(rays.size());
  const auto splat_count = static_cast<cl_uint>(splats.size());
  if (clips.empty())
    device.launch(kernel, shape, points, splat_count, queries, answers, count);
  else
    device.launch(kernel, shape, points, splat_count, queries, answers, count, device.upload(of_all(clips, splats)));
  return device.download(answers, rays.size());
}

} // namespace

TEST_CASE("a million hard rays find the splat that a linear scan finds, through every kernel and order", "[long]") {
  const auto splats = mixed_splats();
  const auto rays = hard_rays(splats, 1'000'000, 11);
  const auto truth = trace_all(splats, rays);
  CHECK(hits(truth) > rays.size() / 3);
  std::set<std::string> seen;
  for (TraversalVariant variant : valid_variants()) {
    variant.leaf_capacity = 8; // deeper than any that is used: more borders to go wrong at
    if (!seen.insert(trace_program(variant).options + name_of(variant.order)).second) continue;
    CAPTURE(name_of(variant));
    CHECK(differences(trace_tree(splats, rays, variant), truth) == 0);
  }
}

TEST_CASE("every variant's trees and work-groups find what a linear scan finds", "[long]") {
  const auto splats = mixed_splats();
  const auto rays = hard_rays(splats, 20'011, 13); // no whole number of groups
  const auto truth = trace_all(splats, rays);
  for (const TraversalVariant& variant : valid_variants()) {
    if (variant.grouping == RayGrouping::packet) continue; // below
    CAPTURE(name_of(variant));
    CHECK(differences(trace_tree(splats, rays, variant), truth) == 0);
  }
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
  const TraversalVariant variant = plain_variant(GENERATE(TraversalForm::step, TraversalForm::wide));
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

TEST_CASE("rays that are no numbers meet nothing, through every kernel", "[long]") {
  const float nan = std::nanf(""), inf = INFINITY;
  std::vector<RayQuery> rays = hard_rays(sphere_splats(500), 8, 3);
  for (std::size_t k = 0; k < rays.size(); ++k)
    (k % 2 == 0 ? rays[k].origin : rays[k].direction)[k % 3] = k % 4 < 2 ? nan : inf;
  for (const TraversalVariant& variant : valid_variants()) {
    CAPTURE(name_of(variant));
    CHECK(hits(trace_tree(sphere_splats(500), rays, variant)) == 0);
  }
}

TEST_CASE("any-hit says what closest-hit says, and blending agrees between the forms", "[long]") {
  const auto splats = mixed_splats();
  const auto rays = hard_rays(splats, 100'000, 31);
  const auto truth = trace_all(splats, rays);
  std::vector<Other> forms;
  std::set<std::string> seen;
  for (const TraversalVariant& variant : valid_variants()) {
    if (!seen.insert(trace_program(variant).options + name_of(variant.order)).second) continue;
    CAPTURE(name_of(variant));
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

TEST_CASE("rays that leave a surface pass what belongs to it, as a linear scan says", "[long]") {
  const auto splats = GENERATE(mixed_splats(), sheet_splats(mixed_splats()));
  auto rays = hard_rays(splats, 100'000, 51);
  std::vector<cl_float4> surfaces(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) { // off the middle of a disc, or of a place near it
    const Splat& s = splats[(i * 7919) % splats.size()];
    surfaces[i] = {{s.normal[0], s.normal[1], s.normal[2], i % 3 == 0 ? 4.0f * s.radius : s.radius}};
    for (int a = 0; a < 3; ++a)
      rays[i].origin[a] = s.position[a] + (i % 2 == 0 ? 0.0f : 0.3f * s.radius * s.normal[(a + 1) % 3]);
    rays[i].t_min = -4e-6f; // as light does (kernels/lights/lights.cl)
  }
  Session& device = session();
  const auto queries = device.upload(rays);
  const auto starts = device.upload(surfaces);
  const auto count = static_cast<cl_uint>(rays.size());
  const auto answers = device.allocate<RayAnswer>(rays.size());
  const auto points = device.upload(splats);
  cl::Kernel scan = device.kernel("test/brute_force.cl", "", "brute_force_closest_from");
  device.launch(scan, LaunchShape::line(rays.size()), points, static_cast<cl_uint>(splats.size()), queries, starts,
                answers, count);
  const std::vector<RayAnswer> truth = device.download(answers, rays.size());
  CHECK(hits(truth) > rays.size() / 4);
  CHECK(differences(trace_all(splats, rays), truth) > rays.size() / 10); // it does make a difference
  std::set<std::string> seen;
  for (const TraversalVariant& variant : valid_variants()) {
    const Program program = trace_program(variant);
    if (!seen.insert(program.options + name_of(variant.order)).second) continue;
    CAPTURE(name_of(variant));
    const OctreePools pools = build_pools(splats, variant);
    const DevicePools on_device = upload_pools(device, pools, variant.storage);
    cl::Kernel kernel = device.kernel(program.file, program.options, "trace_closest_from_rays");
    device.launch(kernel, LaunchShape::line(rays.size(), variant.group.size()), on_device.nodes, on_device.leaves,
                  on_device.points, queries, starts, answers, count, 0.0f);
    std::vector<RayAnswer> found = device.download(answers, rays.size());
    for (RayAnswer& answer : found)
      answer.splat = answer.splat == NO_SPLAT ? NO_SPLAT : source_of(pools)[answer.splat];
    CHECK(differences(found, truth) == 0);
  }
}

namespace {

/// Answers of packets of PACKET_RAYS rays each.
std::vector<RayAnswer> trace_in_packets(const std::vector<Splat>& splats, const std::vector<RayQuery>& rays,
                                        TraversalVariant variant, Backfaces backfaces = Backfaces::shade,
                                        const SplatClips& clips = {}) {
  variant.clips = !clips.empty();
  const OctreePools pools = build_pools(splats, variant, clips);
  Session& device = session();
  const DevicePools on_device = upload_pools(device, pools, variant.storage);
  const auto queries = device.upload(packets_of(rays));
  const auto answers = device.allocate<RayPacketAnswer>(queries.size);
  const Program program = trace_program(variant, backfaces);
  cl::Kernel kernel = device.kernel(program.file, program.options, "trace_packets");
  device.launch(kernel, LaunchShape::line(queries.size, variant.group.size()), on_device.nodes, on_device.leaves,
                on_device.points, queries, answers, static_cast<cl_uint>(queries.size));
  auto found = rays_of(device.download(answers, queries.size));
  for (RayAnswer& answer : found)
    answer.splat = answer.splat == NO_SPLAT ? NO_SPLAT : source_of(pools)[answer.splat];
  return found;
}

} // namespace

TEST_CASE("packets of rays find what the rays find one by one", "[long]") {
  const auto splats = mixed_splats();
  const auto rays = bundles(splats);
  const auto truth = trace_all(splats, rays);
  for (const TraversalVariant& variant : valid_variants()) {
    if (variant.grouping != RayGrouping::packet) continue;
    CAPTURE(name_of(variant));
    CHECK(differences(trace_in_packets(splats, rays, variant), truth) == 0);
  }
}

TEST_CASE("where backs are seen through, every form and grouping finds the nearest front of a linear scan", "[long]") {
  const bool sheets = GENERATE(false, true);
  const auto splats = sheets ? sheet_splats(mixed_splats()) : mixed_splats();
  const auto rays = hard_rays(splats, 50'011, 61);
  const auto in_bundles = bundles(splats);
  const auto truth = trace_all(splats, rays, Backfaces::see_through);
  const auto truth_of_bundles = trace_all(splats, in_bundles, Backfaces::see_through);
  if (!sheets) CHECK(differences(trace_all(splats, rays), truth) > rays.size() / 10); // it does make a difference
  std::size_t backs = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (truth[i].splat == NO_SPLAT) continue;
    const Splat& s = splats[truth[i].splat];
    double cosine = 0.0;
    for (int a = 0; a < 3; ++a)
      cosine += double{s.normal[a]} * double{rays[i].direction[a]};
    backs += cosine > 1e-6; // rounding of the device's floats
  }
  CHECK(backs == 0);
  std::set<std::string> seen;
  for (const TraversalVariant& variant : valid_variants()) {
    if (!seen.insert(trace_program(variant).options + name_of(variant.order)).second) continue;
    CAPTURE(name_of(variant));
    CHECK(differences(trace_tree(splats, rays, variant, nullptr, Backfaces::see_through), truth) == 0);
    if (variant.grouping == RayGrouping::packet)
      CHECK(differences(trace_in_packets(splats, in_bundles, variant, Backfaces::see_through), truth_of_bundles) == 0);
  }
}

TEST_CASE("every form and grouping meets a clipped disc where a linear scan does", "[long]") {
  const bool sheets = GENERATE(false, true);
  const auto splats = sheets ? sheet_splats(mixed_splats()) : mixed_splats();
  const SplatClips clips = random_clips(splats, 71);
  const auto rays = hard_rays(splats, 100'003, 73);
  const auto in_bundles = bundles(splats);
  const auto truth = trace_all(splats, rays, Backfaces::shade, clips);
  const auto truth_of_bundles = trace_all(splats, in_bundles, Backfaces::shade, clips);
  CHECK(differences(trace_all(splats, rays), truth) > rays.size() / 50); // it does make a difference
  // Another twin, which shares no code: a ray within float's error of a rim or border may differ.
  const std::vector<DiscClip> each = of_all(clips, splats);
  std::size_t unlike = 0;
  for (std::size_t i = 0; i < rays.size(); i += 50) {
    const double o[3] = {rays[i].origin[0], rays[i].origin[1], rays[i].origin[2]};
    const double d[3] = {rays[i].direction[0], rays[i].direction[1], rays[i].direction[2]};
    const RayHit hit = closest_hit(splats, o, d, 0.0, 8.0, each);
    unlike += (hit.splat == RayHit::none) != (truth[i].splat == NO_SPLAT) ||
              (hit.splat != RayHit::none && std::fabs(hit.t - truth[i].t) > 1e-4);
  }
  CHECK(unlike <= rays.size() / 50 / 200);
  std::set<std::string> seen;
  for (const TraversalVariant& variant : valid_variants()) {
    CAPTURE(name_of(variant));
    if (variant.grouping == RayGrouping::packet) {
      CHECK(differences(trace_in_packets(splats, in_bundles, variant, Backfaces::shade, clips), truth_of_bundles) == 0);
      continue;
    }
    if (!seen.insert(trace_program(variant).options + name_of(variant.order)).second) continue;
    Other other;
    CHECK(differences(trace_tree(splats, rays, variant, &other, Backfaces::shade, clips), truth) == 0);
    std::size_t wrong = 0, unblended = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const bool hit = truth[i].splat != NO_SPLAT;
      wrong += (other.blocked[i] != 0) != hit;
      unblended += hit && other.surfaces[2 * i + 1].s[3] == 0.0f;
    }
    CHECK(wrong == 0);
    // A ray that meets the backs of rims alone goes on past them (kernels/surface/rims.cl).
    CHECK(unblended <= rays.size() / 20);
  }
}
