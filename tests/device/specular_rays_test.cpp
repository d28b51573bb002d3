/// Rays through glass made of discs, against those through glass made of a formula (truths.md §1).
#include "host/cloud/normal_field.h"
#include "host/passes/build_pools.h"
#include "host/passes/device_pools.h"
#include "host/tune/variant_list.h"
#include "shared/render_types.h"
#include "shared/traversal_types.h"
#include "tests/support/clouds.h"
#include "tests/support/device.h"
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace pointgi;
using namespace pointgi::test;

namespace {

constexpr float radius = 0.2f; // of the sphere, about (0.5, 0.5, 0.5)

/// Without the gaps that discs of sphere_splats leave around its poles.
std::vector<Splat> closed_sphere(std::size_t count) {
  std::vector<Splat> splats = sphere_splats(count, radius);
  for (Splat& s : splats)
    s.radius *= 1.25f;
  return splats;
}

struct RayEnd {
  double origin[3], direction[3], surfaces;
};

std::vector<RayEnd> trace(const std::vector<Splat>& splats, const TraversalVariant& variant, float ior,
                          const std::vector<RayQuery>& rays) {
  Session& device = session();
  const OctreePools pools = build_pools(splats, variant);
  const DevicePools on_device = upload_pools(device, pools, variant.storage);
  const auto slopes = fit_normal_field(points_of(pools), [](const Splat&) { return true; });
  std::vector<cl_float4> texels(slopes.size());
  for (std::size_t i = 0; i < slopes.size(); ++i)
    std::copy_n(slopes[i].slope, 4, texels[i].s);
  Material glass{};
  glass.type = MATERIAL_GLASS;
  glass.flags = MATERIAL_SPECULAR | MATERIAL_TRANSMITS;
  glass.ior = ior;
  const auto field = device.upload(texels);
  const auto materials = device.upload(&glass, 1);
  const auto queries = device.upload(rays);
  const auto out = device.allocate<cl_float4>(2 * rays.size());
  const Program program = specular_rays_program(variant);
  cl::Kernel kernel = device.kernel(program.file, program.options, "trace_specular_rays");
  device.launch(kernel, LaunchShape::line(rays.size()), on_device.nodes, on_device.leaves, on_device.points, field,
                materials, queries, out, static_cast<cl_uint>(rays.size()), 0.05f);
  const auto found = device.download(out, 2 * rays.size());
  std::vector<RayEnd> ends;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const cl_float4 &o = found[2 * i], &d = found[2 * i + 1];
    ends.push_back({{o.s[0], o.s[1], o.s[2]}, {d.s[0], d.s[1], d.s[2]}, o.s[3]});
  }
  return ends;
}

/// Rays along the sphere's axes, `height` radii from them, all round; x, y and z take turns.
std::vector<RayQuery> parallel_rays(float height, int count) {
  std::vector<RayQuery> rays;
  for (int k = 0; k < count; ++k) {
    const float angle = 2.399963f * static_cast<float>(k);
    RayQuery ray{};
    const int axis = k % 3;
    ray.origin[axis] = 0.02f;
    ray.origin[(axis + 1) % 3] = 0.5f + height * radius * std::cos(angle);
    ray.origin[(axis + 2) % 3] = 0.5f + height * radius * std::sin(angle);
    ray.direction[axis] = 1.0f;
    ray.t_max = INFINITY;
    rays.push_back(ray);
  }
  return rays;
}

/// Of such rays, the root mean square distance between where they come nearest to their axis and `truth`, in radii; -1
/// where one met not two surfaces.
double focus_error(const std::vector<RayEnd>& ends, double truth) {
  double sum = 0.0;
  for (std::size_t k = 0; k < ends.size(); ++k) {
    if (ends[k].surfaces != 2.0) return -1.0;
    const int a = static_cast<int>(k % 3), b = (a + 1) % 3, c = (a + 2) % 3;
    const double *o = ends[k].origin, *d = ends[k].direction;
    const double t = -((o[b] - 0.5) * d[b] + (o[c] - 0.5) * d[c]) / (d[b] * d[b] + d[c] * d[c]);
    const double off = (o[a] + t * d[a] - 0.5) / radius - truth;
    sum += off * off;
  }
  return std::sqrt(sum / static_cast<double>(ends.size()));
}

} // namespace

TEST_CASE("a glass sphere bends rays to where its foci are, better with more splats") {
  struct Focus {
    float height;
    double at;
  };
  for (const Focus focus : {Focus{0.3f, 1.4620}, Focus{0.5f, 1.3916}}) {
    double before = 0.0;
    for (const std::size_t count : {1000u, 4000u, 16000u}) {
      CAPTURE(focus.height, count);
      const auto rays = parallel_rays(focus.height, 300);
      const double error =
          focus_error(trace(closed_sphere(count), plain_variant(TraversalForm::wide), 1.5f, rays), focus.at);
      const double spacing = std::sqrt(4.0 * 3.14159265 / static_cast<double>(count)); // in radii
      CHECK(error >= 0.0);
      CHECK(error < spacing);
      // Discs lie off the sphere by the square of the spacing, a quarter at each step; half of that leaves room.
      if (before > 0.0) CHECK(error < 0.5 * before);
      before = error;
    }
  }
}

TEST_CASE("rays through glass are the same through every form") {
  const auto splats = closed_sphere(3000);
  const auto rays = parallel_rays(0.6f, 300);
  const auto truth = trace(splats, reference_variant(), 1.5f, rays);
  TraversalVariant branching = reference_variant(), sixteen = plain_variant(TraversalForm::wide);
  branching.axis_bits = 2;
  sixteen.lanes = 16;
  for (const TraversalVariant& variant : {branching, plain_variant(TraversalForm::wide), sixteen}) {
    const auto found = trace(splats, variant, 1.5f, rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      CHECK(found[i].surfaces == truth[i].surfaces);
      for (int a = 0; a < 3; ++a) // sums in another order
        CHECK(found[i].direction[a] == Approx(truth[i].direction[a]).margin(1e-4));
    }
  }
}

TEST_CASE("glass of index 1 leaves rays alone, at any height") {
  for (const float height : {0.0f, 0.5f, 0.9f, 0.99f}) {
    CAPTURE(height);
    const auto rays = parallel_rays(height, 300);
    const auto ends = trace(closed_sphere(3000), plain_variant(TraversalForm::wide), 1.0f, rays);
    for (std::size_t k = 0; k < ends.size(); ++k) // 1e-3: at grazing angles the cosine's square is lost in rounding
      REQUIRE(ends[k].direction[k % 3] == Approx(1.0).margin(1e-3));
  }
}

TEST_CASE("rays into a glass sphere leave it again after two surfaces, up to its rim") {
  // Of 3000 rays evenly over its cross section all but those at the very rim, where discs end beyond the sphere.
  std::vector<RayQuery> rays;
  for (int ring = 0; ring < 10; ++ring)
    for (const RayQuery& ray : parallel_rays(std::sqrt((static_cast<float>(ring) + 0.5f) / 10.0f), 300))
      rays.push_back(ray);
  const auto ends = trace(closed_sphere(3000), plain_variant(TraversalForm::wide), 1.5f, rays);
  const auto others = std::count_if(ends.begin(), ends.end(), [](const RayEnd& e) { return e.surfaces != 2.0; });
  CHECK(others <= 3);
}

TEST_CASE("a disc met at its very rim, behind a back that does not count, is a surface and no NaN") {
  // Rays pass the rim of the second disc, whose middle the first one hides, and go on from there, another origin than
  // their own, to just the rim of the third: in some of them rounding tells the two origins apart.
  const Splat front = make_splat(0.38f, 0.5f, 0.5f, -1.0f, 0.0f, 0.0f, 0.02f),
              back = make_splat(0.40f, 0.5f, 0.5f, 1.0f, 0.0f, 0.0f, 0.06f),
              third = make_splat(0.61f, 0.5f, 0.5f, -0.9f, 0.3f, 0.2f, 0.05f);
  std::vector<RayQuery> rays;
  for (int k = 0; k < 20000; ++k) {
    const double angle = 2.399963 * k, rim[2] = {std::cos(angle), std::sin(angle)};
    // Two directions across the third disc's normal.
    const double u[3] = {0.0, 0.2 / std::sqrt(0.13), -0.3 / std::sqrt(0.13)};
    const double n[3] = {third.normal[0], third.normal[1], third.normal[2]};
    const double v[3] = {n[1] * u[2] - n[2] * u[1], n[2] * u[0] - n[0] * u[2], n[0] * u[1] - n[1] * u[0]};
    double to[3], from[3], length = 0.0;
    for (int a = 0; a < 3; ++a) {
      to[a] = third.position[a] + third.radius * (rim[0] * u[a] + rim[1] * v[a]);
      from[a] = a == 0 ? 0.1 : to[a] + 1e-3 * std::sin(7.0 * k + a);
      length += (to[a] - from[a]) * (to[a] - from[a]);
    }
    RayQuery ray{};
    for (int a = 0; a < 3; ++a) {
      ray.origin[a] = static_cast<float>(from[a]);
      ray.direction[a] = static_cast<float>((to[a] - from[a]) / std::sqrt(length));
    }
    ray.t_max = INFINITY;
    rays.push_back(ray);
  }
  for (const TraversalForm form : traversal_forms()) {
    const auto ends = trace({front, back, third}, plain_variant(form), 1.5f, rays);
    std::size_t met = 0;
    for (const RayEnd& e : ends) {
      REQUIRE(std::isfinite(e.origin[0] + e.origin[1] + e.origin[2] + e.direction[0]));
      met += e.surfaces > 0.0 && e.origin[0] > 0.5;
    }
    CHECK(met > ends.size() / 4); // about half of them, as rounding has it
    CHECK(met < ends.size());
  }
}
