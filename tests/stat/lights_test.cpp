/// Samples of lights and photons that set out, against densities written here.
#include "host/passes/build_pools.h"
#include "host/passes/device_lights.h"
#include "host/passes/device_pools.h"
#include "host/scene/lighting.h"
#include "host/scene/shares.h"
#include "shared/photon_types.h"
#include "tests/stat/samplers.h"
#include "tests/support/clouds.h"

using namespace pointgi;
using namespace pointgi::test;

namespace {

constexpr std::size_t samples = 50'000;

enum Materials : std::size_t { red_lamp, blue_lamp, mirror, glass };

void add_light(Scene& scene, LightType type, const Vector3d& vector, const Vector3d& strength) {
  LightSettings light;
  light.type = type;
  light.is_far = type == LightType::directional;
  light.vector = vector;
  light.strength = strength;
  scene.lights.push_back(light);
}

Scene scene_of_lights() {
  Scene scene;
  scene.materials.resize(4);
  for (const Materials lamp : {red_lamp, blue_lamp})
    scene.materials[lamp].flags = MATERIAL_REFLECTS_DIFFUSELY;
  scene.materials[red_lamp].emission = {6.0, 2.0, 0.5};
  scene.materials[blue_lamp].emission = {0.5, 0.7, 3.0};
  scene.materials[mirror].flags = MATERIAL_SPECULAR;
  scene.materials[glass].flags = MATERIAL_SPECULAR | MATERIAL_TRANSMITS;
  scene.environment = {0.7, 0.2, 0.4};
  for (const double x : {0.1, 0.5, 0.9}) { // points of intensities 1, 25, 81 and as many directions
    add_light(scene, LightType::point, {x, 0.9, 0.7 - 0.3 * x}, Vector3d(2.0, 1.0, 0.5) * 100.0 * x * x);
    add_light(scene, LightType::directional, Vector3d(x - 0.4, 0.6, 0.3 * x).normalized(),
              Vector3d(0.5, 1.0, 3.0) * 40.0 * x);
  }
  return scene;
}

/// Discs of several sizes and materials, apart from each other, that look down by and large.
std::vector<Splat> splats_of_lights() {
  std::vector<Splat> splats;
  std::mt19937 random(12);
  std::uniform_real_distribution<float> tilt(-0.5f, 0.5f);
  for (const std::size_t material : {red_lamp, blue_lamp, mirror, glass})
    for (int k = 0; k < 4; ++k) {
      const auto x = 0.2f + 0.2f * static_cast<float>(k), z = 0.2f + 0.2f * static_cast<float>(material);
      Splat s = make_splat(x, 0.75f, z, tilt(random), -1.0f, tilt(random), 0.02f + 0.02f * static_cast<float>(k));
      s.material = static_cast<float>(material);
      s.area *= 0.8f; // what a disc stands for is not what it covers
      splats.push_back(s);
    }
  return splats;
}

struct LightScene {
  Scene scene = scene_of_lights();
  OctreePools octree = build_pools(splats_of_lights(), plain_variant(TraversalForm::wide));
  DevicePools pools = upload_pools(session(), octree, PoolStorage::buffer);
  DeviceLighting lighting = device_lighting(scene, Frame{}, points_of(octree));
  DeviceLights device = upload_lights(session(), lighting, lighting.params, false);
  Buffer<cl_float4> field = session().upload(std::vector<cl_float4>(points_of(octree).size())); ///< flat surfaces

  const Splat& point(const Emitter& e) const { return points_of(octree)[e.point]; }
  Vector3d centre(const Emitter& e) const {
    const float* p = point(e).position;
    return {p[0], p[1], p[2]};
  }
  Vector3d normal(const Emitter& e) const {
    const float* n = point(e).normal;
    return Vector3d(n[0], n[1], n[2]).normalized();
  }
  double radius(const Emitter& e) const { return std::sqrt(static_cast<double>(point(e).area) / pi); }
  /// Luminance times area: what shares go by.
  double power(const Emitter& e) const {
    const Vector3d emission = scene.materials[static_cast<std::size_t>(point(e).material)].emission;
    return (0.2126 * emission.x() + 0.7152 * emission.y() + 0.0722 * emission.z()) * static_cast<double>(point(e).area);
  }
  /// Emission as the device has it, green.
  double green(const Emitter& e) const {
    return static_cast<double>(lighting.materials[static_cast<std::size_t>(point(e).material)].emission[1]);
  }
  /// The emitter on which a place lies.
  std::size_t under(const std::vector<Emitter>& emitters, const Vector3d& place) const {
    std::size_t nearest = 0;
    for (std::size_t k = 1; k < emitters.size(); ++k)
      if ((centre(emitters[k]) - place).norm() < (centre(emitters[nearest]) - place).norm()) nearest = k;
    return nearest;
  }
  template <typename Weight>
  std::vector<double> shares(const std::vector<Emitter>& emitters, const Weight& weight) const {
    std::vector<double> result;
    double total = 0.0;
    for (const Emitter& e : emitters)
      total += weight(e);
    for (const Emitter& e : emitters)
      result.push_back(weight(e) / total);
    return result;
  }
};

double off(double value, double truth) {
  return std::fabs(value / truth - 1.0);
}

} // namespace

TEST_CASE("emitting splats are sampled by their power, evenly over their discs, with the stated density") {
  const LightScene lights;
  const std::vector<Emitter>& emitters = lights.lighting.emitters;
  REQUIRE(emitters.size() == 8);
  const std::vector<double> shares = lights.shares(emitters, [&](const Emitter& e) { return lights.power(e); });
  const Vector3d position(0.45, 0.2, 0.4), up(0.0, 1.0, 0.0);
  const auto drawn = draw("probe_emitter", samples, 3, 7, lights.pools.nodes, lights.pools.leaves, lights.pools.points,
                          lights.field, lights.device.materials, lights.device.emitters,
                          static_cast<cl_uint>(emitters.size()), float4_of(position), float4_of(up));
  EvenSquares squares(shares);
  double off_pdf = 0.0, off_ray = 0.0, off_irradiance = 0.0;
  for (std::size_t i = 0; i < drawn.size(); i += 3) {
    const Vector3d towards = vector_of(drawn[i]), place = position + static_cast<double>(drawn[i].s[3]) * towards;
    const std::size_t k = lights.under(emitters, place);
    const Emitter& e = emitters[k];
    count_in_disc(squares, k, lights.normal(e), lights.radius(e), place - lights.centre(e));
    REQUIRE(drawn[i + 2].s[1] == 1.0f); // they all face the surface
    const double cosine_at_light = -towards.dot(lights.normal(e)), d2 = (place - position).squaredNorm();
    const double pdf = shares[k] / static_cast<double>(lights.point(e).area) * d2 / cosine_at_light;
    off_pdf = std::fmax(off_pdf, off(drawn[i + 1].s[3], pdf));
    off_ray = std::fmax(off_ray, off(drawn[i + 2].s[0], pdf));
    off_irradiance = std::fmax(off_irradiance, off(drawn[i + 1].s[1], lights.green(e) * towards.dot(up) / pdf));
  }
  squares.check();
  // Places are recovered from a float distance: 1e-7; shares are rounded to 2^-24, the smallest is 0.002.
  CHECK(off_pdf < 1e-4);
  CHECK(off_ray < 1e-4);
  CHECK(off_irradiance < 1e-4);
}

TEST_CASE("of many lights one is drawn by its strength") {
  const LightScene lights;
  const std::vector<LightSource>& delta = lights.lighting.light_sources;
  REQUIRE(delta.size() == 6);
  std::vector<double> shares;
  double total = 0.0;
  for (const LightSettings& light : lights.scene.lights) {
    shares.push_back(Vector3d(0.2126, 0.7152, 0.0722).dot(light.strength));
    total += shares.back();
  }
  for (double& share : shares)
    share /= total;
  const Vector3d position(0.45, 0.2, 0.4), up(0.0, 1.0, 0.0);
  const auto drawn =
      draw("probe_delta_light", samples, 2, 8, lights.device.arguments(), float4_of(position), float4_of(up));
  std::vector<double> counts(delta.size());
  double off_irradiance = 0.0;
  for (std::size_t i = 0; i < drawn.size(); i += 2) {
    const Vector3d towards = vector_of(drawn[i]);
    std::size_t found = delta.size();
    double irradiance = 0.0;
    for (std::size_t k = 0; k < delta.size(); ++k) {
      const LightSettings& light = lights.scene.lights[k];
      const Vector3d to = light.is_far ? light.vector : light.vector - position;
      if ((to.normalized() - towards).norm() > 1e-5) continue;
      found = k;
      irradiance = light.strength.y() * towards.dot(up) / (light.is_far ? 1.0 : to.squaredNorm()) / shares[k];
    }
    REQUIRE(found < delta.size());
    counts[found] += 1.0;
    off_irradiance = std::fmax(off_irradiance, off(drawn[i + 1].s[1] * lights.lighting.radiance.scale, irradiance));
    REQUIRE(drawn[i + 1].s[3] == 0.0f); // no ray can meet them
  }
  check_fit(counts, shares);
  CHECK(off_irradiance < 1e-4);
}

TEST_CASE("a surface looks for the environment with the density that rays to it are weighed by") {
  const LightScene lights;
  const Vector3d normal = Vector3d(0.36, -0.48, 0.8);
  const PolarBins bins(normal, even_edges(1.0, 16), 12);
  std::vector<double> counts(bins.size());
  double off_density = 0.0;
  for (const cl_float4& d : draw("probe_sky", samples, 1, 9, lights.device.arguments(), float4_of(normal))) {
    counts[bins.of(vector_of(d))] += 1.0;
    off_density = std::fmax(off_density, std::fabs(static_cast<double>(d.s[3])));
  }
  check_fit(counts, bins.masses([](double height) { return (1.0 - height) / pi; }));
  CHECK(off_density == 0.0);
}

namespace {

struct Emitted {
  Vector3d origin, direction;
  double power; ///< green
};

constexpr float leaf_radius = 0.08f;
const Vector3d leaf_centre(0.55, 0.3, 0.45);

/// First photons of `samples` batches from that source to the leaf, a photon each.
std::vector<Emitted> emit(const LightScene& lights, const std::vector<Emitter>& emitters, cl_uint source, bool looks,
                          const Vector3d& centre = leaf_centre) {
  std::vector<EmissionBatch> batches;
  for (cl_uint i = 0; i < samples; ++i)
    batches.push_back({i, 1, source, 0, 1.0f});
  PhotonLeaf leaf{};
  for (int c = 0; c < 3; ++c)
    leaf.centre[c] = static_cast<float>(centre[c]);
  leaf.radius = leaf_radius;
  RenderParams params = lights.lighting.params;
  params.emitters = static_cast<pg_uint>(emitters.size());
  std::vector<std::array<float, 4>> radiance;
  for (const Emitter& e : emitters)
    radiance.push_back({0.0f, static_cast<float>(lights.green(e)), 0.0f, 0.0f});
  Session& device = session();
  DeviceLights sent = upload_lights(device, lights.lighting, params, false);
  sent.emitters = device.upload(emitters);
  const auto drawn = device.allocate<cl_float4>(3 * samples);
  cl::Kernel kernel = sampler("probe_emission");
  device.launch(kernel, LaunchShape::line(samples), lights.pools.nodes, lights.pools.leaves, lights.pools.points,
                lights.field, sent.arguments(), device.upload(radiance), device.upload(batches),
                device.upload(std::vector<PhotonLeaf>{leaf}), device.upload(std::vector<cl_uint>{0}),
                static_cast<cl_uint>(looks), drawn, static_cast<cl_uint>(samples));
  const auto values = device.download(drawn, 3 * samples);
  std::vector<Emitted> photons;
  for (std::size_t i = 0; i < values.size(); i += 3)
    photons.push_back({vector_of(values[i]), vector_of(values[i + 1]), values[i + 2].s[1]});
  return photons;
}

/// 1 - cosine of half the angle under which the leaf is seen; 2 from inside.
double height_of_leaf(const Vector3d& centre, const Vector3d& from) {
  const double sine2 = std::pow(double{leaf_radius}, 2) / (centre - from).squaredNorm();
  return sine2 < 1.0 ? sine2 / (1.0 + std::sqrt(1.0 - sine2)) : 2.0;
}

} // namespace

TEST_CASE("photons of a point light are even over the solid angle of their leaf") {
  const LightScene lights;
  const cl_uint source = 2; // a point
  const LightSettings& light = lights.scene.lights[source];
  // Beside the light, close by, and around it.
  const Vector3d centre = GENERATE(leaf_centre, Vector3d(0.5, 0.8, 0.5), Vector3d(0.52, 0.9, 0.55));
  const double last = height_of_leaf(centre, light.vector);
  EvenSquares squares({1.0}, 12);
  double off_power = 0.0;
  for (const Emitted& photon : emit(lights, lights.lighting.emitters, source, false, centre)) {
    REQUIRE((photon.origin - light.vector).norm() < 1e-6);
    count_in_cone(squares, 0, (centre - light.vector).normalized(), last, photon.direction);
    off_power =
        std::fmax(off_power, off(photon.power * lights.lighting.radiance.scale, light.strength.y() * 2.0 * pi * last));
  }
  squares.check();
  CHECK(off_power < 1e-5);
}

TEST_CASE("photons of a directional light are even over the disc before their leaf") {
  const LightScene lights;
  const cl_uint source = 3;
  const LightSettings& light = lights.scene.lights[source];
  EvenSquares squares({1.0}, 12);
  double off_power = 0.0;
  for (const Emitted& photon : emit(lights, lights.lighting.emitters, source, false)) {
    REQUIRE((photon.direction + light.vector).norm() < 1e-6);
    const Vector3d from_centre = photon.origin - leaf_centre;
    const double height = from_centre.dot(light.vector);
    REQUIRE(height > 1.8); // outside the root cube
    count_in_disc(squares, 0, light.vector, double{leaf_radius}, from_centre - height * light.vector);
    off_power = std::fmax(off_power, off(photon.power * lights.lighting.radiance.scale,
                                         light.strength.y() * pi * std::pow(double{leaf_radius}, 2)));
  }
  squares.check();
  CHECK(off_power < 1e-5);
}

TEST_CASE("photons of the environment come from all sides alike and are even over the disc before their leaf") {
  const LightScene lights;
  EvenSquares places({1.0}, 12), directions({1.0}, 12);
  double off_power = 0.0;
  for (const Emitted& photon : emit(lights, lights.lighting.emitters, SOURCE_ENVIRONMENT, false)) {
    const Vector3d towards = -photon.direction, from_centre = photon.origin - leaf_centre;
    count_in_cone(directions, 0, Vector3d(0.6, 0.0, 0.8), 2.0, towards);
    count_in_disc(places, 0, towards.normalized(), double{leaf_radius},
                  from_centre - from_centre.dot(towards) * towards);
    off_power = std::fmax(off_power, off(photon.power * lights.lighting.radiance.scale,
                                         0.2 * 4.0 * pi * pi * std::pow(double{leaf_radius}, 2)));
  }
  places.check();
  directions.check();
  CHECK(off_power < 1e-5);
}

TEST_CASE("photons of emitting splats: splat by power, place even on the disc, direction even over the leaf") {
  const LightScene lights;
  const std::vector<Emitter>& emitters = lights.lighting.emitters;
  const std::vector<double> shares = lights.shares(emitters, [&](const Emitter& e) { return lights.power(e); });
  EvenSquares places(shares), directions(shares);
  double off_power = 0.0;
  for (const Emitted& photon : emit(lights, emitters, SOURCE_EMITTERS, false)) {
    const std::size_t k = lights.under(emitters, photon.origin);
    const Emitter& e = emitters[k];
    const double last = height_of_leaf(leaf_centre, photon.origin);
    count_in_disc(places, k, lights.normal(e), lights.radius(e), photon.origin - lights.centre(e));
    count_in_cone(directions, k, (leaf_centre - photon.origin).normalized(), last, photon.direction);
    const double cosine = photon.direction.dot(lights.normal(e));
    if (cosine < 1e-3) {
      REQUIRE(photon.power < 1e-2 * lights.green(e));
      continue;
    }
    off_power = std::fmax(off_power, off(photon.power, lights.green(e) * static_cast<double>(lights.point(e).area) /
                                                           shares[k] * 2.0 * pi * last * cosine));
  }
  places.check();
  directions.check();
  CHECK(off_power < 1e-3); // a cosine of 1e-3 in float
}

TEST_CASE(
    "specular splats look for light by their shares, evenly over their discs, by the cosine, glass on both sides") {
  const LightScene lights;
  std::vector<Emitter> specular;
  for (std::uint32_t p = 0; p < points_of(lights.octree).size(); ++p)
    if (points_of(lights.octree)[p].material >= static_cast<float>(mirror)) specular.push_back({p, 0.0f, {}});
  REQUIRE(specular.size() == 8);
  const auto is_glass = [&](const Emitter& e) { return lights.point(e).material == static_cast<float>(glass); };
  const auto weight = [&](const Emitter& e) {
    return static_cast<double>(lights.point(e).area) * (is_glass(e) ? 2.0 : 0.7);
  };
  accumulate_shares(specular, weight);
  const std::vector<double> shares = lights.shares(specular, weight);
  std::vector<double> sides = shares; // of fronts, then of backs
  for (std::size_t k = 0; k < specular.size(); ++k) {
    if (is_glass(specular[k])) sides[k] *= 0.5;
    sides.push_back(is_glass(specular[k]) ? sides[k] : 0.0);
  }
  EvenSquares places(shares), directions(sides);
  double off_power = 0.0;
  for (const Emitted& photon : emit(lights, specular, SOURCE_EMITTERS, true)) {
    const std::size_t k = lights.under(specular, photon.origin);
    const Emitter& e = specular[k];
    count_in_disc(places, k, lights.normal(e), lights.radius(e), photon.origin - lights.centre(e));
    const double cosine = photon.direction.dot(lights.normal(e));
    if (cosine < 0.0) REQUIRE(is_glass(e));
    directions.count(cosine < 0.0 ? k + specular.size() : k, cosine * cosine,
                     turn_about(lights.normal(e), photon.direction));
    off_power = std::fmax(off_power, off(photon.power, pi * static_cast<double>(lights.point(e).area) *
                                                           (is_glass(e) ? 2.0 : 1.0) / shares[k]));
  }
  places.check();
  directions.check();
  CHECK(off_power < 1e-4);
}
