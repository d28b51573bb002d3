#include "host/scene/lighting.h"
#include "host/tune/profile.h"
#include "tests/support/clouds.h"
#include "tests/support/device.h"
#include "tests/support/photon_scene.h"
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;

namespace {

/// A ball under a lamp with a small one before it, so that bounced rays meet something.
struct Ball {
  Scene scene;
  Frame frame;
  std::vector<Splat> splats = sphere_splats(900);
  SplatClips clips;
  PatchBends bends;

  Ball() {
    for (Splat small : sphere_splats(300, 0.1f)) {
      for (float& x : small.position)
        x += 0.27f;
      splats.push_back(small);
    }
    scene.render.width = 64;
    scene.render.height = 48;
    scene.camera.position = {0.5, 0.5, 2.5};
    scene.camera.look_at = {0.5, 0.5, 0.5};
    scene.materials.emplace_back();
    scene.lights.push_back({LightType::point, false, {0.9, 0.9, 2.0}, {0.08, 0.08, 0.08}, 0.0, {}});
  }

  ProfileRequest request() const {
    ProfileRequest request{scene, frame, splats, clips, bends, {}};
    request.rounds = 1;
    request.launch_seconds = 1e-3;
    return request;
  }
};

/// A mirrored and a glass ball on a floor before a flat mirror, in the light of a lamp of splats, a point light and an
/// even sky: photons set out from every kind of source, and meet several surfaces.
std::string caustics_scene(const std::string& caustics) {
  return "version = 1\n[render]\nsize = [64, 48]\n[camera]\nposition = [0.0, 1.0, 4.0]\nlook_at = [0.0, 0.0, 0.0]\n"
         "[environment]\nradiance = [0.1, 0.2, 0.3]\n[caustics]\n" +
         caustics +
         "\n[[light]]\ntype = \"point\"\nposition = [0.3, 1.4, 0.2]\npower_w = [10.0, 20.0, 30.0]\n"
         "[[material]]\nname = \"mirror\"\ntype = \"mirror\"\nreflectance = [0.9, 0.5, 0.1]\n"
         "[[material]]\nname = \"glass\"\ntype = \"glass\"\nior = 1.5\n"
         "[[material]]\nname = \"white\"\ntype = \"diffuse\"\nalbedo = [0.5, 0.5, 0.5]\n"
         "[[material]]\nname = \"lamp\"\ntype = \"diffuse\"\nalbedo = [0.0, 0.0, 0.0]\nemission = [5.0, 5.0, 4.0]\n"
         "[[shape]]\ntype = \"sphere\"\ncentre = [-0.5, 0.0, 0.0]\nradius = 0.3\nmaterial = \"mirror\"\nspacing = "
         "0.05\n"
         "[[shape]]\ntype = \"sphere\"\ncentre = [0.4, 0.0, 0.0]\nradius = 0.4\nmaterial = \"glass\"\nspacing = 0.05\n"
         "[[shape]]\ntype = \"quad\"\ncorner = [-1.0, -0.5, -1.0]\nedge_u = [0.0, 0.0, 2.0]\nedge_v = [2.0, 0.0, 0.0]\n"
         "material = \"white\"\nspacing = 0.1\n"
         "[[shape]]\ntype = \"quad\"\ncorner = [-1.0, -0.5, -1.2]\nedge_u = [2.0, 0.0, 0.1]\nedge_v = [0.0, 1.0, 0.0]\n"
         "material = \"mirror\"\nspacing = 0.1\n"
         "[[shape]]\ntype = \"disc\"\ncentre = [0.0, 1.5, -0.5]\nnormal = [0.0, -1.0, 0.3]\nradius = 0.2\n"
         "material = \"lamp\"\nspacing = 0.05\n";
}

/// A few that differ in everything; the reference is not among them.
std::vector<TraversalVariant> some_variants() {
  std::vector<TraversalVariant> some;
  for (const TraversalVariant& v : all_variants()) {
    const std::string name = name_of(v);
    for (const char* wanted : {"step-n4-buffer-morton-leaf16-ray-64x1", "step-n2-image2d-hilbert-leaf64-ray-32x1",
                               "wide-lanes8-hilbert-leaf32-packet-16x4", "wide-lanes16-morton-leaf64-ray-8x4"})
      if (name == wanted && why_not(v, session().info()).empty()) some.push_back(v);
  }
  return some;
}

Profile run(
    const ProfileRequest& request, const std::function<bool()>& stop = [] { return false; }) {
  return profile_variants(
      session(), request, [](double) {}, stop);
}

} // namespace

TEST_CASE("a profile of splats that end at borders finds nothing wrong with the variants", "[long]") {
  Ball ball;
  for (std::uint32_t i = 0; i < ball.splats.size(); i += 2) {
    const Eigen::Vector3f across = Eigen::Map<const Eigen::Vector3f>(ball.splats[i].normal).unitOrthogonal();
    const float r = ball.splats[i].radius;
    ball.clips.push_back({i, {{{{across[0], across[1], across[2]}, -0.3f * r, 0.6f * r}}}});
  }
  ProfileRequest request = ball.request();
  request.variants = some_variants();
  for (const VariantProfile& v : run(request).variants) {
    CAPTURE(name_of(v.variant));
    CHECK(v.variant.clips);
    CHECK_FALSE(v.wrong());
  }
}

TEST_CASE("a profile measures the reference and all that is asked for, and finds nothing wrong with them", "[long]") {
  const Ball ball;
  ProfileRequest request = ball.request();
  request.variants = some_variants();
  for (const std::uint64_t bytes : {request.pool_bytes, std::uint64_t{1}}) { // all at a time, and one by one
    request.pool_bytes = bytes;
    const Profile profile = run(request);
    REQUIRE(profile.variants.size() == request.variants.size() + 1);
    CHECK(name_of(profile.variants[0].variant) == name_of(reference_variant()));
    CHECK(profile.variants[0].speedup() == 1.0);
    CHECK_FALSE(profile.interrupted);
    CHECK(profile.proved_rays > 0);
    for (const VariantProfile& v : profile.variants) {
      CAPTURE(name_of(v.variant), v.failure);
      CHECK(v.complete());
      CHECK_FALSE(v.wrong());
      CHECK(v.pool_bytes > 0);
    }
    CHECK(profile.ranking().size() == profile.variants.size());
    CHECK(profile.winner() != nullptr);
  }
}

TEST_CASE("photons end alike by all variants, in trees of any order", "[long]") {
  for (const char* caustics : {"photons = 1000", "power = \"equal\""}) {
    CAPTURE(caustics);
    const PhotonScene mirrors(caustics_scene(caustics));
    ProfileRequest request{mirrors.scene,        mirrors.placed.frame, mirrors.placed.splats,
                           mirrors.placed.clips, mirrors.placed.bends, some_variants()};
    request.rounds = 1;
    request.launch_seconds = 1e-3;
    const Profile profile = run(request);
    CHECK(profile.without_photons.empty());
    for (const VariantProfile& v : profile.variants) {
      CAPTURE(name_of(v.variant), v.failure);
      const KernelProfile& photons = v.kernels[static_cast<std::size_t>(ProfiledKernel::photons)];
      CHECK(v.complete());
      CHECK(photons.wrong == 0);
      CHECK(photons.rays >= 1024); // asked for are as many at least
      CHECK(photons.bytes > 64 * photons.rays);
      CHECK(photons.seconds.size() == 1);
      CHECK_FALSE(photons.skipped);
    }
  }
}

TEST_CASE("a profile says why there are no photons to time", "[long]") {
  const auto reason = [](const PhotonScene& scene) {
    ProfileRequest request{scene.scene,        scene.placed.frame, scene.placed.splats,
                           scene.placed.clips, scene.placed.bends, {}};
    request.rounds = 1;
    request.launch_seconds = 1e-3;
    const Profile profile = run(request);
    CHECK(profile.variants[0].complete());
    CHECK(profile.variants[0].kernels[static_cast<std::size_t>(ProfiledKernel::photons)].skipped);
    return profile.without_photons;
  };
  CHECK(reason(PhotonScene(caustics_scene("photons = 0"))) == "caustics.photons = 0");
  const Ball ball;
  CHECK(run(ball.request()).without_photons == "no specular material");
}

TEST_CASE("a profile that is stopped tells what is complete and what is not", "[long]") {
  const Ball ball;
  ProfileRequest request = ball.request();
  request.variants = some_variants();
  request.rounds = 3;
  for (const int calls : {0, 3, 30, 45}) {
    int left = calls;
    const Profile profile = run(request, [&] { return left-- <= 0; });
    CHECK(profile.interrupted);
    for (const std::size_t i : profile.ranking())
      CHECK(profile.variants[i].complete());
    if (calls == 0) CHECK(profile.winner() == nullptr);
  }
}

TEST_CASE("a variant that the device cannot take is told of, and the others are measured", "[long]") {
  const Ball ball;
  ProfileRequest request = ball.request();
  request.variants = {plain_variant(TraversalForm::wide)};
  TraversalVariant large = plain_variant(TraversalForm::step);
  large.group = {1024, 1024};
  request.variants.push_back(large);
  const Profile profile = run(request);
  REQUIRE(profile.variants.size() == 3);
  CHECK(profile.variants[1].complete());
  CHECK_FALSE(profile.variants[2].complete());
  CHECK_FALSE(profile.variants[2].failure.empty());
  CHECK(profile.ranking().size() == 2);
}
