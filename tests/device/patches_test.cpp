/// Rays against patches of the moving-least-squares surface, through every form of the octree.
#include "host/passes/build_pools.h"
#include "host/passes/device_pools.h"
#include "host/passes/ray_packets.h"
#include "octree/ref/closest_patch.h"
#include "tests/support/answers.h"
#include "tests/support/clouds.h"
#include "tests/support/rays.h"
#include <catch2/catch.hpp>
#include <set>

using namespace pointgi;
using namespace pointgi::test;

namespace {

struct Patches {
  std::vector<Splat> splats;
  SplatClips clips;
  PatchBends bends;
};

Patches random_patches(bool sheets, bool clipped) {
  Patches p;
  p.splats = sheets ? sheet_splats(mixed_splats()) : mixed_splats();
  p.bends = random_bends(p.splats, 5);
  if (clipped) p.clips = random_clips(p.splats, 7);
  return p;
}

/// A tree of patches on the device.
struct Traced {
  TraversalVariant variant;
  OctreePools pools;
  DevicePools on_device;

  Traced(const Patches& p, TraversalVariant of) : variant(of) {
    variant.clips = !p.clips.empty();
    variant.patches = true;
    pools = build_pools(p.splats, variant, p.clips, p.bends);
    std::visit([](const auto& built) { verify(built); }, pools);
    on_device = upload_pools(session(), pools, variant.storage);
  }
  template <class Answer, class... Args>
  std::vector<Answer> run(const char* kernel_name, std::size_t items, std::size_t answers, Backfaces backfaces,
                          const Args&... args) {
    const Program program = trace_program(variant, backfaces);
    cl::Kernel kernel = session().kernel(program.file, program.options, kernel_name);
    const auto out = session().allocate<Answer>(answers);
    session().launch(kernel, LaunchShape::line(items, variant.group.size()), on_device.nodes, on_device.leaves,
                     on_device.points, args..., out, static_cast<cl_uint>(items), 0.0f);
    return session().download(out, answers);
  }
  std::vector<RayAnswer> of_splats(std::vector<RayAnswer> found) const {
    for (RayAnswer& answer : found)
      answer.splat = answer.splat == NO_SPLAT ? NO_SPLAT : source_of(pools)[answer.splat];
    return found;
  }
  std::vector<RayAnswer> closest(const std::vector<RayQuery>& rays, Backfaces backfaces = Backfaces::shade) {
    return of_splats(run<RayAnswer>("trace_closest_rays", rays.size(), rays.size(), backfaces, session().upload(rays)));
  }
  std::vector<RayAnswer> in_packets(const std::vector<RayQuery>& rays, Backfaces backfaces = Backfaces::shade) {
    const auto queries = session().upload(packets_of(rays));
    const auto answers = session().allocate<RayPacketAnswer>(queries.size);
    const Program program = trace_program(variant, backfaces);
    cl::Kernel kernel = session().kernel(program.file, program.options, "trace_packets");
    session().launch(kernel, LaunchShape::line(queries.size, variant.group.size()), on_device.nodes, on_device.leaves,
                     on_device.points, queries, answers, static_cast<cl_uint>(queries.size));
    return of_splats(rays_of(session().download(answers, queries.size)));
  }
};

/// By a linear scan on the device; of rays that leave surfaces, if there are any.
std::vector<RayAnswer> scan(const Patches& p, const std::vector<RayQuery>& rays, Backfaces backfaces = Backfaces::shade,
                            const std::vector<cl_float4>& surfaces = {}) {
  TraversalVariant variant;
  variant.patches = true;
  variant.clips = !p.clips.empty();
  const Program program = scan_program(variant, backfaces);
  cl::Kernel kernel = session().kernel(program.file, program.options,
                                       surfaces.empty() ? "brute_force_closest" : "brute_force_closest_from");
  const cl::Memory points = upload_points(session(), p.splats, p.bends);
  const auto queries = session().upload(rays);
  const auto answers = session().allocate<RayAnswer>(rays.size());
  const auto splats = static_cast<cl_uint>(p.splats.size()), count = static_cast<cl_uint>(rays.size());
  const LaunchShape shape = LaunchShape::line(rays.size());
  if (!surfaces.empty())
    session().launch(kernel, shape, points, splats, queries, session().upload(surfaces), answers, count);
  else if (p.clips.empty())
    session().launch(kernel, shape, points, splats, queries, answers, count);
  else
    session().launch(kernel, shape, points, splats, queries, answers, count,
                     session().upload(of_all(p.clips, p.splats)));
  return session().download(answers, rays.size());
}

/// Packets of every kind.
std::vector<RayQuery> few_bundles(const std::vector<Splat>& splats) {
  std::vector<RayQuery> rays = bundles(splats);
  rays.resize(240 * std::size_t{PACKET_RAYS});
  return rays;
}

/// Of the variants those whose programs or trees for patches differ.
std::vector<TraversalVariant> distinct_variants() {
  std::vector<TraversalVariant> distinct;
  std::set<std::string> seen;
  for (const TraversalVariant& variant : valid_variants())
    if (seen.insert(trace_program(variant).options + name_of(variant.order)).second) distinct.push_back(variant);
  return distinct;
}

} // namespace

TEST_CASE("the device's linear scan of patches agrees with the host's, which finds their roots by bisection") {
  const bool clipped = GENERATE(false, true);
  const Patches p = random_patches(false, clipped);
  const auto rays = hard_rays(p.splats, 20'000, 19);
  const auto answers = scan(p, rays);
  const std::vector<DiscClip> clips = clipped ? of_all(p.clips, p.splats) : std::vector<DiscClip>{};
  std::size_t different = 0, counted = 0;
  for (std::size_t i = 0; i < rays.size(); i += 3) {
    if (i % 5 == 4) continue; // starts on a patch: float rightly decides otherwise
    const double o[3] = {rays[i].origin[0], rays[i].origin[1], rays[i].origin[2]};
    const double d[3] = {rays[i].direction[0], rays[i].direction[1], rays[i].direction[2]};
    const RayHit truth = closest_patch_hit(p.splats, p.bends, o, d, 0.0, 8.0, clips);
    const bool hits = truth.splat != RayHit::none;
    // Of a ray that grazes a patch t is known to the root of float's error, over the bend: 1e-3 at most.
    different += (answers[i].splat != NO_SPLAT) != hits || (hits && std::fabs(answers[i].t - truth.t) > 1e-3);
    ++counted;
  }
  // Rims and tangents: as of discs, a ray passes within 1e-6 of one with a chance below 1e-3.
  CHECK(static_cast<double>(different) <= 2e-3 * static_cast<double>(counted));
}

TEST_CASE("every form and grouping meets a patch where a linear scan does", "[long]") {
  const bool sheets = GENERATE(false, true), clipped = sheets;
  CAPTURE(sheets);
  const Patches p = random_patches(sheets, clipped);
  const auto rays = hard_rays(p.splats, 40'009, 23);
  const auto in_bundles = few_bundles(p.splats);
  const auto truth = scan(p, rays), truth_of_bundles = scan(p, in_bundles);
  CHECK(hits(truth) > rays.size() / 4);
  Patches flat = p;
  flat.bends.assign(p.bends.size(), {});
  CHECK(differences(scan(flat, rays), truth) > rays.size() / 10); // it does make a difference
  for (const TraversalVariant& variant : distinct_variants()) {
    CAPTURE(name_of(variant));
    Traced traced(p, variant);
    if (variant.grouping == RayGrouping::packet) {
      CHECK(differences(traced.in_packets(in_bundles), truth_of_bundles) == 0);
      continue;
    }
    CHECK(differences(traced.closest(rays), truth) == 0);
    const auto queries = session().upload(rays);
    const auto blocked = traced.run<cl_uint>("trace_any_rays", rays.size(), rays.size(), Backfaces::shade, queries);
    const auto surfaces =
        traced.run<cl_float4>("trace_blended_rays", rays.size(), 2 * rays.size(), Backfaces::shade, queries);
    std::size_t wrong = 0, unblended = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const bool hit = truth[i].splat != NO_SPLAT;
      wrong += (blocked[i] != 0) != hit;
      unblended += hit && surfaces[2 * i + 1].s[3] == 0.0f;
    }
    CHECK(wrong == 0);
    // A ray that meets the backs of rims alone goes on past them (kernels/surface/rims.cl).
    CHECK(unblended <= rays.size() / 20);
  }
}

TEST_CASE("of patches the fronts alone are found where backs are seen through", "[long]") {
  const Patches p = random_patches(false, false);
  const auto rays = hard_rays(p.splats, 20'011, 29);
  const auto in_bundles = few_bundles(p.splats);
  const auto truth = scan(p, rays, Backfaces::see_through), of_bundles = scan(p, in_bundles, Backfaces::see_through);
  CHECK(differences(scan(p, rays), truth) > rays.size() / 10);
  for (const TraversalVariant& variant : distinct_variants()) {
    CAPTURE(name_of(variant));
    Traced traced(p, variant);
    if (variant.grouping == RayGrouping::packet)
      CHECK(differences(traced.in_packets(in_bundles, Backfaces::see_through), of_bundles) == 0);
    else
      CHECK(differences(traced.closest(rays, Backfaces::see_through), truth) == 0);
  }
}

TEST_CASE("rays that leave a patch pass what belongs to its surface, as a linear scan says", "[long]") {
  const Patches p = random_patches(GENERATE(false, true), false);
  auto rays = hard_rays(p.splats, 20'000, 31);
  std::vector<cl_float4> surfaces(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) { // off the middle of a patch, or of a place near it
    const Splat& s = p.splats[(i * 7919) % p.splats.size()];
    surfaces[i] = {{s.normal[0], s.normal[1], s.normal[2], i % 3 == 0 ? 4.0f * s.radius : s.radius}};
    for (int a = 0; a < 3; ++a)
      rays[i].origin[a] = s.position[a] + (i % 2 == 0 ? 0.0f : 0.3f * s.radius * s.normal[(a + 1) % 3]);
    rays[i].t_min = -4e-6f; // as light does (kernels/lights/lights.cl)
  }
  const auto truth = scan(p, rays, Backfaces::shade, surfaces);
  CHECK(differences(scan(p, rays), truth) > rays.size() / 10); // it does make a difference
  for (const TraversalVariant& variant : distinct_variants()) {
    if (variant.grouping == RayGrouping::packet) continue; // whose rays leave no surface
    CAPTURE(name_of(variant));
    Traced traced(p, variant);
    const auto found =
        traced.of_splats(traced.run<RayAnswer>("trace_closest_from_rays", rays.size(), rays.size(), Backfaces::shade,
                                               session().upload(rays), session().upload(surfaces)));
    CHECK(differences(found, truth) == 0);
  }
}
