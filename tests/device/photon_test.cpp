#include "tests/support/number.h"
#include "tests/support/photon_scene.h"
#include <catch2/catch.hpp>
#include <cstring>

using namespace pointgi;
using namespace pointgi::test;

namespace {

/// A mirrored ball of radius 0.5 about the origin, a light of 1 W/sr at a distance of 1.5 and a floor.
std::string ball_scene(double spacing, const std::string& caustics, const std::string& light = "") {
  const std::string lamp = light.empty() ? "[[light]]\ntype = \"point\"\nposition = [0.0, 1.5, 0.0]\n"
                                           "power_w = [12.566371, 12.566371, 12.566371]\n"
                                         : light;
  return "version = 1\n[caustics]\n" + caustics + "\n" + lamp +
         "[[material]]\nname = \"mirror\"\ntype = \"mirror\"\n"
         "[[material]]\nname = \"white\"\ntype = \"diffuse\"\nalbedo = [0.5, 0.5, 0.5]\n"
         "[[shape]]\ntype = \"sphere\"\ncentre = [0.0, 0.0, 0.0]\nradius = 0.5\nmaterial = \"mirror\"\nspacing = " +
         number(spacing) +
         "\n[[shape]]\ntype = \"quad\"\ncorner = [-2.0, -1.0, -2.0]\nedge_u = [0.0, 0.0, 4.0]\nedge_v = [4.0, 0.0, "
         "0.0]\n"
         "material = \"white\"\nspacing = 0.1\n";
}

/// Everything that can happen to a photon.
const std::string all_of_it =
    "version = 1\n[caustics]\nphotons = 20000\n[environment]\nradiance = [0.1, 0.2, 0.3]\n"
    "[[light]]\ntype = \"point\"\nposition = [0.3, 1.4, 0.2]\npower_w = [10.0, 20.0, 30.0]\n"
    "[[light]]\ntype = \"directional\"\ndirection = [0.2, -1.0, 0.1]\nirradiance = [3.0, 2.0, 1.0]\n"
    "[[material]]\nname = \"mirror\"\ntype = \"mirror\"\nreflectance = [0.9, 0.5, 0.1]\n"
    "[[material]]\nname = \"glass\"\ntype = \"glass\"\nior = 1.5\nabsorption = [0.1, 1.0, 3.0]\n"
    "[[material]]\nname = \"gloss\"\ntype = \"phong\"\nalbedo = [0.3, 0.4, 0.5]\nspecular = [0.4, 0.4, 0.4]\n"
    "exponent = 30.0\n"
    "[[material]]\nname = \"white\"\ntype = \"diffuse\"\nalbedo = [0.5, 0.5, 0.5]\n"
    "[[material]]\nname = \"lamp\"\ntype = \"diffuse\"\nalbedo = [0.0, 0.0, 0.0]\nemission = [5.0, 5.0, 4.0]\n"
    "[[shape]]\ntype = \"sphere\"\ncentre = [-0.5, 0.0, 0.0]\nradius = 0.3\nmaterial = \"mirror\"\nspacing = 0.05\n"
    "[[shape]]\ntype = \"sphere\"\ncentre = [0.4, 0.0, 0.0]\nradius = 0.4\nmaterial = \"glass\"\nspacing = 0.05\n"
    "[[shape]]\ntype = \"quad\"\ncorner = [-1.0, -1.0, 0.9]\nedge_u = [2.0, 0.0, 0.0]\nedge_v = [0.0, 2.0, 0.0]\n"
    "material = \"gloss\"\nspacing = 0.1\n"
    "[[shape]]\ntype = \"quad\"\ncorner = [-1.0, -1.0, -1.0]\nedge_u = [0.0, 0.0, 2.0]\nedge_v = [2.0, 0.0, 0.0]\n"
    "material = \"white\"\nspacing = 0.1\n"
    "[[shape]]\ntype = \"disc\"\ncentre = [0.0, 1.5, -0.5]\nnormal = [0.0, -1.0, 0.3]\nradius = 0.2\n"
    "material = \"lamp\"\nspacing = 0.05\n";

double flux(const PhotonScene& scene, const PhotonLedger& ledger) {
  return scene.watts(ledger.emitted_power[1]);
}

bool same_bits(const std::vector<Photon>& a, const std::vector<Photon>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Photon)) == 0;
}

} // namespace

TEST_CASE("the flux aimed at a mirrored ball is the light's over its solid angle") {
  const double exact = 2.0 * 3.14159265358979 * (1.0 - std::sqrt(1.0 - 1.0 / 9.0));
  // Flat discs on the horizon stick out of the ball by about their radius squared over its diameter, so the error falls
  // with the spacing; the sampling noise is stratified away to below 0.1 %.
  double before = 1.0;
  for (const double spacing : {0.1, 0.05, 0.025}) {
    const PhotonScene scene(ball_scene(spacing, "photons = 100000"));
    const TracedPhotons traced = scene.send();
    const double error = flux(scene, traced.ledger) / exact - 1.0;
    CAPTURE(spacing, error, traced.ledger.aimed, traced.ledger.emitted);
    CHECK(std::fabs(error) < before);
    before = std::fabs(error);
  }
  CHECK(before < 0.01);
}

TEST_CASE("photons of equal power make the flux too large") {
  // Measured: 2.6, 2.1, 2.2 times the flux at spacings 0.1, 0.05, 0.025: the average discs reach to the far rims of
  // their splats, so they overlap, and photons that would pass their leaf by meet another. The thesis' way is here to
  // be compared with; that it is as far off as measured, and no more, is what is checked, with a fifth to spare.
  const double exact = 2.0 * 3.14159265358979 * (1.0 - std::sqrt(1.0 - 1.0 / 9.0));
  const PhotonScene scene(ball_scene(0.05, "photons = 100000\npower = \"equal\""));
  const TracedPhotons traced = scene.send();
  CHECK(traced.ledger.aimed == 100'000);
  CHECK(flux(scene, traced.ledger) / exact == Approx(2.1).epsilon(0.2));
  for (const Photon& photon : traced.stored)
    REQUIRE(photon.power[1] == traced.stored[0].power[1]);
}

TEST_CASE("every photon's power is accounted for") {
  for (const char* power : {"unbiased", "equal"}) {
    PhotonScene scene(all_of_it);
    scene.scene.caustics.power = power;
    const TracedPhotons traced = scene.send();
    const PhotonLedger& l = traced.ledger;
    CAPTURE(power, l.aimed, l.emitted, l.stored, l.absorbed, l.escaped, l.cut);
    CHECK(l.emitted == l.stored + l.absorbed + l.escaped + l.cut);
    CHECK(l.stored == traced.stored.size());
    CHECK(l.stored > 1000);
    CHECK(l.absorbed > 100);
    CHECK(l.escaped > 1000);
    for (std::size_t c = 0; c < 3; ++c) {
      CHECK(l.absorbed_power[c] > 0.01 * l.emitted_power[c]);
      CHECK(l.stored_power[c] + l.absorbed_power[c] + l.escaped_power[c] + l.cut_power[c] ==
            Approx(l.emitted_power[c]).epsilon(1e-5));
    }
  }
}

TEST_CASE("photons are bit-identical however they are cut into launches, and others with another seed") {
  const PhotonScene scene(all_of_it);
  const auto points = scene.points();
  const SpecularLeaves leaves = specular_leaves(
      points, [&](const Splat& s) { return scene.lighting.materials[static_cast<std::size_t>(s.material)].type != 0; },
      1000, false);
  EmissionOptions options;
  options.photons = 3000;
  const auto all_see = [](View<Splat>, View<Segment> segments) { return std::vector<std::uint8_t>(segments.size, 0); };
  const EmissionPlan plan = plan_emission(leaves, points, scene.sources, all_see, options);
  REQUIRE(plan.photons > 3000);
  const auto traced = [&](std::size_t batch, const DeviceLighting& lighting) {
    PhotonRequest request{lighting, scene.sources, leaves, plan, *scene.field, scene.variant, scene.placed.frame.side};
    request.batch = batch;
    return trace_photons(session(), scene.pools, request, {[] { return false; }, {}}).stored;
  };
  const auto once = traced(plan.photons, scene.lighting);
  CHECK(once.size() > 100);
  CHECK(same_bits(once, traced(1000, scene.lighting)));
  CHECK(same_bits(once, traced(0, scene.lighting)));
  DeviceLighting other = scene.lighting;
  other.params.seed = 2;
  CHECK_FALSE(same_bits(once, traced(0, other)));
}

TEST_CASE("photons fly in bounded memory, with progress, until they are stopped") {
  const PhotonScene scene(all_of_it);
  const auto never = [] { return false; };
  const TracedPhotons all = scene.send();
  std::vector<double> shares;
  const TracedPhotons few = scene.send({never, [&](double share) { shares.push_back(share); }, 150});
  REQUIRE(all.stored.size() > 1000);
  CHECK(few.ledger.stored == all.ledger.stored); // the ledger is of all
  CHECK(few.ledger.kept == few.stored.size());
  CHECK(all.ledger.kept == all.ledger.stored);
  CHECK(few.ledger.stored_power == all.ledger.stored_power);
  CHECK(few.one_of >= 8);
  // Half of them until there are at most 150.
  CHECK(few.stored.size() <= 150);
  CHECK(few.stored.size() > 40);
  CHECK(std::is_sorted(shares.begin(), shares.end()));
  CHECK(shares.back() == 1.0);
  CHECK(scene.send({[] { return true; }, {}}).stopped);
}

TEST_CASE("no photons") {
  PhotonScene scene(ball_scene(0.1, "photons = 0"));
  const TracedPhotons traced = scene.send();
  CHECK(traced.stored.empty());
  CHECK(traced.ledger.aimed == 0);
}

namespace {

/// A ball of radius 0.5 about the origin in a closed cube of side 4.
std::string ball_in_cube(const std::string& material) {
  return "version = 1\n[[light]]\ntype = \"point\"\nposition = [0.0, 1.5, 0.0]\npower_w = [1.0, 1.0, 1.0]\n"
         "[[material]]\nname = \"ball\"\n" +
         material +
         "[[material]]\nname = \"white\"\ntype = \"diffuse\"\nalbedo = [0.5, 0.5, 0.5]\n"
         "[[shape]]\ntype = \"sphere\"\ncentre = [0.0, 0.0, 0.0]\nradius = 0.5\nmaterial = \"ball\"\n"
         "spacing = 0.03\n[[shape]]\ntype = \"box\"\nmin = [-2.0, -2.0, -2.0]\nmax = [2.0, 2.0, 2.0]\n"
         "inward = true\nmaterial = \"white\"\nspacing = 0.2\n";
}

} // namespace

TEST_CASE("photons from surfaces carry what a ball receives, each as much as any other") {
  const std::string materials[] = {"type = \"mirror\"\n", "type = \"glass\"\nior = 1.5\n"};
  for (const std::string& material : materials) {
    CAPTURE(material);
    const PhotonScene scene(ball_in_cube(material));
    std::vector<float> radiosity;
    double area = 0.0; // of the ball's splats
    for (const Splat& s : scene.points()) {
      const bool white = scene.lighting.materials[static_cast<std::size_t>(s.material)].type == MATERIAL_DIFFUSE;
      if (!white) area += double{s.area};
      radiosity.insert(radiosity.end(), {white ? 1.0f : 0.0f, white ? 2.0f : 0.0f, 0.0f});
    }
    const auto never = [] { return false; };
    const TracedPhotons traced =
        send_photons_from_surfaces(session(), scene.pools, scene.variant, scene.lighting, radiosity, scene.points(),
                                   *scene.field, 40000, 1, scene.placed.frame.side, {never, {}});
    // Rays along the ball miss it on their way back, as its discs stick out: 0.5 %. Of glass, half look inwards, at
    // glass: by chance alone 0.5 % of those that do not.
    CHECK(traced.ledger.emitted_power[0] == Approx(area).epsilon(0.02));
    CHECK(traced.ledger.emitted_power[1] == Approx(2.0 * area).epsilon(0.02));
    CHECK(traced.ledger.emitted_power[2] == 0.0);
    double least = 1e30, most = 0.0;
    for (const Photon& p : traced.stored) {
      least = std::min(least, double{p.power[0]});
      most = std::max(most, double{p.power[0]});
    }
    REQUIRE(traced.stored.size() > 10000);
    CHECK(most <= 1.01 * least); // shares are rounded to 2^-24
  }
}

TEST_CASE("photons from surfaces come from where the form factor says") {
  // A small mirror that looks up at the ceiling of the cube, 4 x 4 and 2 above it, alone bright.
  std::string text = ball_in_cube("type = \"mirror\"\n");
  const std::size_t at = text.find("[[shape]]\ntype = \"sphere\""), end = text.find("[[shape]]", at + 1);
  text.replace(at, end - at,
               "[[shape]]\ntype = \"quad\"\ncorner = [-0.05, 0.0, -0.05]\nedge_u = [0.0, 0.0, 0.1]\n"
               "edge_v = [0.1, 0.0, 0.0]\nmaterial = \"ball\"\nspacing = 0.02\n");
  const PhotonScene scene(text);
  const auto is_white = [&](const Splat& s) {
    return scene.lighting.materials[static_cast<std::size_t>(s.material)].type == MATERIAL_DIFFUSE;
  };
  std::vector<float> radiosity;
  double area = 0.0;
  for (const Splat& s : scene.points()) {
    const bool bright = is_white(s) && s.normal[1] < -0.9f;
    if (!is_white(s)) area += double{s.area};
    radiosity.insert(radiosity.end(), 3, bright ? 1.0f : 0.0f);
  }
  const TracedPhotons traced =
      send_photons_from_surfaces(session(), scene.pools, scene.variant, scene.lighting, radiosity, scene.points(),
                                 *scene.field, 40000, 1, scene.placed.frame.side, {[] { return false; }, {}});
  const double factor = 4.0 / 3.14159265358979 * std::sqrt(0.5) * std::atan(std::sqrt(0.5)); // 0.554
  // Of 40000 photons, by chance alone, 0.45 %.
  CHECK(traced.ledger.emitted_power[1] == Approx(factor * area).epsilon(0.015));
}
