#include "host/tune/self_test.h"
#include "host/cl/device_choice.h"
#include "host/passes/build_pools.h"
#include "host/passes/device_pools.h"
#include "host/run.h"
#include "host/tune/tuned.h"
#include "octree/ref/closest_hit.h"
#include "shared/traversal_types.h"
#include <cmath>
#include <random>

namespace pointgi {

namespace {

constexpr std::size_t splat_count = 500, ray_count = 2000;

/// The same on every platform, unlike the standard's distributions.
float between(std::mt19937& random, double low, double high) {
  return static_cast<float>(low + (high - low) * (static_cast<double>(random()) / 4294967296.0));
}

/// Discs anywhere in the root cube, facing anywhere, of radii from below a leaf's cell to above it.
std::vector<Splat> test_splats(std::mt19937& random) {
  std::vector<Splat> splats(splat_count);
  for (Splat& s : splats) {
    s = {};
    const float z = between(random, -1.0, 1.0), angle = between(random, 0.0, 6.2831853), r = std::sqrt(1.0f - z * z);
    const float normal[3] = {r * std::cos(angle), r * std::sin(angle), z};
    for (int a = 0; a < 3; ++a) {
      s.position[a] = between(random, 0.15, 0.85);
      s.normal[a] = normal[a];
    }
    s.radius = between(random, 0.01, 0.12);
    s.area = 3.14159265f * s.radius * s.radius;
  }
  return splats;
}

/// From anywhere about the cube to anywhere in it.
std::vector<RayQuery> test_rays(std::mt19937& random) {
  std::vector<RayQuery> rays(ray_count);
  for (RayQuery& ray : rays) {
    ray = {};
    ray.t_max = 8.0f;
    float length = 0.0f;
    for (int a = 0; a < 3; ++a) {
      ray.origin[a] = between(random, -0.5, 1.5);
      ray.direction[a] = between(random, 0.1, 0.9) - ray.origin[a];
      length = std::hypot(length, ray.direction[a]);
    }
    for (float& d : ray.direction)
      d /= length;
  }
  return rays;
}

std::vector<RayAnswer> traced(Session& session, const TraversalVariant& variant, const OctreePools& pools,
                              const std::vector<RayQuery>& rays) {
  const DevicePools on_device = upload_pools(session, pools, variant.storage);
  const auto queries = session.upload(rays);
  const auto answers = session.allocate<RayAnswer>(rays.size());
  session.fill(answers, RayAnswer{-1.0f, NO_SPLAT - 1}, rays.size()); // a kernel that does nothing is not right
  const Program program = trace_program(variant);
  cl::Kernel kernel = session.kernel(program.file, program.options, "trace_closest_rays");
  session.launch(kernel, LaunchShape::line(rays.size(), variant.group.size()), on_device.nodes, on_device.leaves,
                 on_device.points, queries, answers, static_cast<cl_uint>(rays.size()), 0.0f);
  return session.download(answers, rays.size());
}

/// Rays whose answer is not that of a linear scan in double precision.
std::size_t wrong_answers(const std::vector<Splat>& splats, const OctreePools& pools, const std::vector<RayQuery>& rays,
                          const std::vector<RayAnswer>& answers) {
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const double origin[3] = {rays[i].origin[0], rays[i].origin[1], rays[i].origin[2]};
    const double direction[3] = {rays[i].direction[0], rays[i].direction[1], rays[i].direction[2]};
    const RayHit truth = closest_hit(splats, origin, direction, 0.0, double{rays[i].t_max});
    const std::uint32_t found =
        answers[i].splat < splats.size() ? source_of(pools)[answers[i].splat] : answers[i].splat; // none, or nonsense
    const bool hits = truth.splat != RayHit::none;
    const std::uint32_t expected = hits ? truth.splat : NO_SPLAT;
    // t up to 3 in float: 2e-7 each in some operations, more where the ray grazes the disc.
    const bool right = found == expected && (!hits || std::fabs(double{answers[i].t} - truth.t) < 1e-3);
    wrong += right ? 0 : 1;
  }
  return wrong;
}

std::string test_of(Session& session) {
  const DeviceInfo& info = session.info();
  const TraversalVariant variant = choose_variant({}, {}, info, stored_winner(info).file).variant;
  for (const Program& program : {eye_rays_program(variant), shade_program(variant, {})})
    session.program(program.file, program.options);
  std::mt19937 random(1);
  const std::vector<Splat> splats = test_splats(random);
  const std::vector<RayQuery> rays = test_rays(random);
  const OctreePools pools = build_pools(splats, variant);
  const std::size_t wrong = wrong_answers(splats, pools, rays, traced(session, variant, pools, rays));
  // A ray passes a rim within float's error, and may rightly be answered otherwise, with a chance of some 1e-4.
  if (wrong <= ray_count / 200) return {};
  return std::to_string(wrong) + " of " + std::to_string(ray_count) + " rays do not find the nearest splat, by " +
         name_of(variant);
}

} // namespace

std::string self_test(Session& session) {
  try {
    return test_of(session);
  } catch (const std::exception& error) {
    return error.what();
  }
}

Device choose_tested_device(const std::string& selector) {
  const std::vector<Device> devices = list_devices();
  const DeviceChoice choice = choose_among(infos_of(devices), selector, [&](std::size_t place) -> std::string {
    try {
      Session session(devices[place]);
      return self_test(session);
    } catch (const Error& error) {
      return error.what(); // it cannot even be opened
    }
  });
  for (const std::string& warning : choice.warnings)
    log_warning("{}", warning);
  return devices[choice.place];
}

} // namespace pointgi
