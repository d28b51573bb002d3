/// Materials with two_sided = true against what is known: each side has light of its own, and none passes through.
#include "host/scene/scene.h"
#include "tests/support/bake.h"
#include "tests/support/render.h"
#include "tests/support/statistics.h"
#include "tests/support/stats_file.h"
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <functional>
#include <random>

using namespace pointgi;
using namespace pointgi::test;

namespace {

constexpr double pi = 3.14159265358979323846;

std::string material(const std::string& name, double albedo, const std::string& more) {
  return fmt::format("[[material]]\nname = \"{0}\"\ntype = \"diffuse\"\nalbedo = [{1:.9f}, {1:.9f}, {1:.9f}]\n{2}\n",
                     name, albedo, more);
}

std::string quad(const Vector3d& corner, const Vector3d& u, const Vector3d& v, double spacing,
                 const std::string& name) {
  const auto vector = [](const Vector3d& x) { return fmt::format("[{:.9f}, {:.9f}, {:.9f}]", x.x(), x.y(), x.z()); };
  return fmt::format("[[shape]]\ntype = \"quad\"\ncorner = {}\nedge_u = {}\nedge_v = {}\nspacing = {:.9f}\nmaterial = "
                     "\"{}\"\n",
                     vector(corner), vector(u), vector(v), spacing, name);
}

std::string point_light(const Vector3d& at, double watts_a_steradian) {
  return fmt::format(
      "[[light]]\ntype = \"point\"\nposition = [{0:.9f}, {1:.9f}, {2:.9f}]\npower_w = [{3:.9f}, {3:.9f}, "
      "{3:.9f}]\n",
      at.x(), at.y(), at.z(), 4.0 * pi * watts_a_steradian);
}

const std::string two_sided = "two_sided = true";

/// Mean of B in green over the points that `chosen` takes.
double mean_of(const std::vector<LitPoint>& points, const std::function<bool(const LitPoint&)>& chosen) {
  double sum = 0.0, count = 0.0;
  for (const LitPoint& p : points)
    if (chosen(p)) {
      sum += p.radiosity[1];
      count += 1.0;
    }
  REQUIRE(count > 0.0);
  return sum / count;
}

double largest_of(const std::vector<LitPoint>& points, const std::function<bool(const LitPoint&)>& chosen) {
  double most = 0.0;
  for (const LitPoint& p : points)
    if (chosen(p)) most = std::max<double>(most, p.radiosity[1]);
  return most;
}

/// A cube of edge 2 about the origin, which faces inwards.
std::string box(bool inward, const std::string& name) {
  return fmt::format("[[shape]]\ntype = \"box\"\nmin = [-1.0, -1.0, -1.0]\nmax = [1.0, 1.0, 1.0]\ninward = {}\nspacing "
                     "= 0.2\nmaterial = \"{}\"\n",
                     inward, name);
}

bool faces_outwards(const LitPoint& p) {
  return p.normal.cast<double>().dot(p.position) > 0.0;
}

} // namespace

TEST_CASE("a sheet between two lamps: each side has the irradiance of its own lamp") {
  const double above = 3.0, below = GENERATE(0.0, 5.0), rho = 0.6;
  const std::string scene = "version = 1\n" + material("leaf", rho, two_sided) +
                            quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 0.1, "leaf") + point_light({0.3, 0.7, 0.0}, above) +
                            point_light({-0.2, -1.1, 0.1}, below);
  const auto points = bake(scene);
  REQUIRE(points.size() == 800);
  for (const LitPoint& p : points) {
    const bool up = p.normal.y() > 0.0f;
    const Vector3d lamp = up ? Vector3d(0.3, 0.7, 0.0) : Vector3d(-0.2, -1.1, 0.1);
    const Vector3d to = lamp - p.position;
    const double irradiance = (up ? above : below) * std::fabs(to.y()) / std::pow(to.norm(), 3.0);
    // One ray tells the whole: float's rounding of places and quotients.
    CHECK(p.radiosity[1] == Approx(rho * irradiance).epsilon(1e-5).margin(1e-6));
  }
}

TEST_CASE("a sheet that divides a room of two skies: pi L of its own on each side, and nothing of the other's") {
  // Walls that shine with L and reflect nothing are a sky of radiance L.
  const double bright = 2.0, dark = GENERATE(0.0, 0.5), rho = 0.5;
  const auto sky = [](double radiance) { return fmt::format("emission = [{0:.3f}, {0:.3f}, {0:.3f}]", radiance); };
  std::string scene = "version = 1\n" + material("leaf", rho, two_sided) + material("above", 0.0, sky(bright)) +
                      material("below", 0.0, sky(dark)) + quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 0.1, "leaf");
  // A wall's lowest discs reach 0.006 below the sheet's plane: where the other side is to be black, walls begin higher.
  const double lowest = dark > 0.0 ? 0.0 : 0.1;
  for (const double side : {1.0, -1.0}) { // walls, then the ceiling or the floor, which face the middle
    const std::string name = side > 0.0 ? "above" : "below";
    const Vector3d up(0, side * (1.0 - lowest), 0);
    const auto wall = [&](const Vector3d& corner, const Vector3d& u, const Vector3d& v, const Vector3d& normal) {
      const bool right_way = u.cross(v).dot(normal) > 0.0;
      scene += quad(corner, right_way ? u : v, right_way ? v : u, 0.1, name);
    };
    wall({-1, side * lowest, -1}, up, {2, 0, 0}, {0, 0, 1});
    wall({-1, side * lowest, 1}, up, {2, 0, 0}, {0, 0, -1});
    wall({-1, side * lowest, -1}, up, {0, 0, 2}, {1, 0, 0});
    wall({1, side * lowest, -1}, up, {0, 0, 2}, {-1, 0, 0});
    wall({-1, side, -1}, {2, 0, 0}, {0, 0, 2}, {0, -side, 0});
  }
  const std::string mode = GENERATE("shadow_rays", "radiosity");
  CAPTURE(mode, dark);
  const auto points = bake(scene, {"radiosity.light_samples=256", "radiosity.direct_light=" + mode});
  const auto is_side = [](float up) {
    return [up](const LitPoint& p) { return std::fabs(p.position.y()) < 1e-4 && p.normal.y() * up > 0.5f; };
  };
  // 256 estimates for each of 400 points, and 1 % of the area in the last row of discs along the walls; by the
  // exchange, what points of a wall give to the discs beside them is coarser.
  const double tolerance = mode == "radiosity" ? 0.04 : 0.02;
  if (dark > 0.0) {
    CHECK(mean_of(points, is_side(1.0f)) == Approx(rho * pi * bright).epsilon(tolerance));
    CHECK(mean_of(points, is_side(-1.0f)) == Approx(rho * pi * dark).epsilon(tolerance));
  } else {
    CHECK(mean_of(points, is_side(1.0f)) > 0.5 * rho * pi * bright);
    CHECK(largest_of(points, is_side(-1.0f)) <= 1e-6);
  }
}

TEST_CASE("a box of one two-sided sheet is the box that faces inwards and the box that faces outwards") {
  const std::string method = GENERATE("fmm", "direct");
  CAPTURE(method);
  const auto scene = [&](const std::string& walls, const std::string& shapes, bool within, bool without) {
    return "version = 1\n[radiosity]\nmethod = \"" + method + "\"\ntolerance = 1e-5\n" + material("wall", 0.7, walls) +
           material("floor", 0.6, "") + shapes + quad({-3, -1.5, -3}, {0, 0, 6}, {6, 0, 0}, 0.3, "floor") +
           (within ? point_light({0.2, 0.1, -0.3}, 1.0) : "") + (without ? point_light({1.7, 0.4, 2.0}, 4.0) : "");
  };
  const auto inside = [](const LitPoint& p) { return p.position.y() > -1.4 && !faces_outwards(p); };
  const auto outside = [](const LitPoint& p) { return p.position.y() < -1.4 || faces_outwards(p); };
  const auto inwards = bake(scene("", box(true, "wall"), true, true));
  const auto outwards = bake(scene("", box(false, "wall"), true, true));
  const auto sheet = bake(scene(two_sided, box(true, "wall"), true, true));
  // Each point against the one in its place that faces its way: by rays of all pairs but for the residual of 1e-5. By
  // clusters, pairs of them that the V-map's epsilon lets pass are not the same ones where there are more points.
  const auto compare = [&](const std::vector<LitPoint>& one_sided, const std::function<bool(const LitPoint&)>& where) {
    const double mean = mean_of(one_sided, where), close = method == "direct" ? 2e-4 : 0.01;
    double compared = 0.0, squares = 0.0;
    for (const LitPoint& p : one_sided) {
      if (!where(p)) continue;
      for (const LitPoint& q : sheet)
        if ((q.position - p.position).norm() < 1e-5 && q.normal.dot(p.normal) > 0.99f) {
          squares += std::pow(double{q.radiosity[1]} - double{p.radiosity[1]}, 2.0);
          compared += 1.0;
        }
    }
    CHECK(compared >= 600.0);
    CHECK(std::sqrt(squares / compared) <= close * mean);
  };
  compare(inwards, inside);
  compare(outwards, outside);
}

TEST_CASE("a closed sheet keeps light out, and in, as well as a closed surface of one side does", "[long]") {
  const bool within = GENERATE(true, false);
  CAPTURE(within);
  const std::string scene = "version = 1\n" + material("wall", 0.7, two_sided) + material("floor", 0.6, "") +
                            "[[shape]]\ntype = \"sphere\"\ncentre = [0.0, 0.0, 0.0]\nradius = 1.0\ninward = "
                            "true\nspacing = 0.12\nmaterial = \"wall\"\n" +
                            quad({-3, -1.5, -3}, {0, 0, 6}, {6, 0, 0}, 0.1, "floor") +
                            point_light(within ? Vector3d(0.2, 0.1, -0.3) : Vector3d(1.7, 0.4, 2.0), 4.0);
  const auto inside = [](const LitPoint& p) { return p.position.norm() < 1.1 && !faces_outwards(p); };
  const auto dark = [&](const LitPoint& p) { return inside(p) != within; };
  const auto lit = [&](const LitPoint& p) { return inside(p) == within; };
  const auto direct = bake(scene, {"radiosity.method=none"});
  CHECK(mean_of(direct, lit) > 0.05);
  CHECK(largest_of(direct, dark) <= 1e-6);
  // From point to point, rays pass what is taken for the surface at their ends: where it bends over 20 discs' radii,
  // some pass it where they should not.
  const auto floor = [](const LitPoint& p) { return p.position.y() < -1.4; };
  for (const std::string method : {"fmm", "direct"}) {
    CAPTURE(method);
    const auto sheet = bake(scene, {"radiosity.method=" + method});
    CHECK(mean_of(sheet, dark) < 0.005 * mean_of(sheet, lit));
    if (!within) continue;
    const auto one_sided = bake(scene, {"radiosity.method=" + method, "material.wall.two_sided=false"});
    CHECK(mean_of(sheet, floor) <= mean_of(one_sided, floor));
  }
}

TEST_CASE("furnace in a two-sided sphere: pi L / (1 - rho) within, pi L outside, by radiosity and by the path tracer",
          "[long]") {
  const double rho = 0.5, radiance = 0.2;
  const auto scene = [&](const std::string& more) {
    return "version = 1\n[render]\nsize = [16, 16]\nspp = 64\n[camera]\nposition = [0.2, 0.1, 0.3]\nlook_at = [-0.5, "
           "0.0, -1.0]\nfov_deg = 80.0\n" +
           material("wall", rho, "emission = [0.2, 0.2, 0.2]\n" + more) +
           "[[shape]]\ntype = \"sphere\"\ncentre = [0.0, 0.0, 0.0]\nradius = 1.0\ninward = true\nspacing = "
           "0.08\nmaterial = \"wall\"\n[radiosity]\ntolerance = 1e-4\n";
  };
  for (const std::string mode : {"shadow_rays", "radiosity"}) {
    CAPTURE(mode);
    const auto points = bake(scene(two_sided), {"radiosity.direct_light=" + mode});
    const auto inside = [](const LitPoint& p) { return !faces_outwards(p); };
    // Areas of the samples 1 % (truths.md §1), each bounce repeats it, as of the sphere of one side (bake_test.cpp).
    CHECK(mean_of(points, inside) == Approx(pi * radiance / (1.0 - rho)).epsilon(0.02));
    CHECK(largest_of(points, faces_outwards) == Approx(pi * radiance).epsilon(1e-5)); // convex: it does not see itself
  }
  const auto picture = [&](const std::string& more, const char* integrator) {
    return render_text(scene(more), [&](RenderOptions& options) { options.integrator = integrator; });
  };
  const Picture by_paths = picture(two_sided, "path");
  CHECK(mean(by_paths, "G") == Approx(radiance / (1.0 - rho)).epsilon(0.02));         // 16,384 paths, and the areas
  CHECK(mean(by_paths, "G") == Approx(mean(picture("", "path"), "G")).epsilon(0.01)); // the sphere of one side
  CHECK(mean(picture(two_sided, "pointgi"), "G") == Approx(radiance / (1.0 - rho)).epsilon(0.02));
}

TEST_CASE("a two-sided lamp lights both sides alike, with twice the power of one side", "[long]") {
  const double radiance = 3.0;
  const std::string lamp = "emission = [3.0, 3.0, 3.0]\n";
  const std::string lamp_quad = quad({-0.25, 0, -0.25}, {0, 0, 0.5}, {0.5, 0, 0}, 0.05, "lamp");
  SECTION("irradiance below and above its middle") {
    // Of a square of half edge a at the distance h, on axis: H = 4 L a / s atan(a / s), s^2 = h^2 + a^2 (Lambert).
    const double a = 0.25, h = 0.5, s = std::sqrt(h * h + a * a), truth = 4.0 * radiance * a / s * std::atan(a / s);
    const std::string scene = "version = 1\n" + material("lamp", 0.0, lamp + two_sided) + material("wall", 1.0, "") +
                              lamp_quad + quad({-0.005, -h, -0.005}, {0, 0, 0.01}, {0.01, 0, 0}, 0.01, "wall") +
                              quad({-0.005, h, -0.005}, {0.01, 0, 0}, {0, 0, 0.01}, 0.01, "wall");
    const auto points = bake(scene, {"radiosity.light_samples=16384", "radiosity.method=none"});
    for (const double side : {-1.0, 1.0}) {
      const auto there = [&](const LitPoint& p) { return std::fabs(p.position.y() - side * h) < 1e-3; };
      CHECK(mean_of(points, there) == Approx(truth).epsilon(0.01)); // 16,384 samples, of which half face the point
    }
  }
  SECTION("power of the photons that leave it in a mirrored ball") {
    const auto emitted = [&](const std::string& more) {
      const TemporaryFolder folder;
      const std::string stats = folder.file("stats.json");
      render_text("version = 1\n[render]\nsize = [4, 4]\nspp = 1\n[caustics]\nphotons = 200000\n" +
                      material("lamp", 0.3, lamp + more) + lamp_quad +
                      "[[material]]\nname = \"silver\"\ntype = \"mirror\"\nreflectance = [0.5, 0.5, 0.5]\n"
                      "[[shape]]\ntype = \"sphere\"\ncentre = [0.0, 0.0, 0.0]\nradius = 1.0\ninward = true\nspacing = "
                      "0.05\nmaterial = \"silver\"\n",
                  [&](RenderOptions& options) { options.stats_file = stats; });
      const auto power = json_of(stats)["photons"]["power_w"];
      const double sent = power["emitted"][1];
      double ended = 0.0;
      for (const char* end : {"stored", "absorbed", "escaped", "cut"})
        ended += power[end][1].get<double>();
      CHECK(ended == Approx(sent).epsilon(1e-5)); // the ledger adds up
      return sent;
    };
    const double one_side = 0.25 * pi * radiance; // A pi L
    // 200,000 photons, some of which pass their leaf by: a few per thousand.
    CHECK(emitted("") == Approx(one_side).epsilon(0.01));
    CHECK(emitted(two_sided) == Approx(2.0 * one_side).epsilon(0.01));
  }
}

TEST_CASE("caustics fall on the side of a leaf that they come to", "[long]") {
  // A mirror below a leaf throws the light of a lamp between the two up to it; what is above the leaf stays dark.
  const std::string scene =
      "version = 1\n[caustics]\nphotons = 100000\nfeedback = true\n[radiosity]\nmethod = \"fmm\"\n" +
      material("leaf", 0.5, two_sided) + quad({-1, 0.5, -1}, {0, 0, 2}, {2, 0, 0}, 0.1, "leaf") +
      "[[material]]\nname = \"silver\"\ntype = \"mirror\"\n" + quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 0.1, "silver") +
      point_light({0.0, 0.2, 0.0}, 1.0) +
      "[render]\nsize = [32, 32]\nspp = 16\n[camera]\nposition = [0.0, 3.0, 0.1]\nlook_at = [0.0, "
      "0.5, 0.0]\nfov_deg = 20.0\n";
  const Picture above = render_text(scene);
  CHECK(largest(above, "Caustic.G") <= 1e-6);
  CHECK(largest(above, "G") <= 1e-6);
  const Picture below = render_text(scene, [](RenderOptions& options) {
    options.overrides = {"camera.position=[0.0, 0.25, 0.9]", "camera.look_at=[0.0, 0.5, 0.0]"};
  });
  // The lamp's image lies 0.7 below the leaf: I / 0.49 on the axis, less aside.
  CHECK(largest(below, "Caustic.G") == Approx(0.5 / pi / 0.49).epsilon(0.15)); // 50 photons an estimate
}

TEST_CASE("leaves over a floor: the picture of the path tracer, and no black backs", "[long]") {
  std::mt19937 g(7);
  std::uniform_real_distribution<double> place(-0.8, 0.8), height(0.3, 1.0);
  std::normal_distribution<double> any;
  std::string scene =
      "version = 1\n[render]\nsize = [48, 48]\nspp = 64\n[camera]\nposition = [0.0, 1.6, 3.0]\nlook_at = "
      "[0.0, 0.5, 0.0]\nfov_deg = 40.0\n[environment]\nradiance = [0.4, 0.5, 0.7]\n[[light]]\ntype = "
      "\"directional\"\ndirection = [0.3, -1.0, -0.4]\nirradiance = [2.0, 1.9, 1.6]\n" +
      material("leaf", 0.6, two_sided) + material("floor", 0.7, "") + point_light({0.2, 0.2, 0.5}, 0.3) +
      quad({-1.5, 0, -1.5}, {0, 0, 3}, {3, 0, 0}, 0.05, "floor");
  for (int leaf = 0; leaf < 30; ++leaf) {
    const Vector3d centre(place(g), height(g), place(g)), a = Vector3d(any(g), any(g), any(g)).normalized(),
                                                          b = a.cross(Vector3d(any(g), any(g), any(g))).normalized();
    scene += quad(centre - 0.12 * a - 0.08 * b, 0.24 * a, 0.16 * b, 0.02, "leaf");
  }
  const TemporaryFolder folder;
  const std::string stats = folder.file("stats.json");
  const Picture fast = render_text(scene, [&](RenderOptions& options) { options.stats_file = stats; });
  CHECK(json_of(stats)["render"]["back_face_share"] == 0.0);
  const Picture truth = render_text(scene, [](RenderOptions& options) {
    options.integrator = "path";
    options.spp = 512;
  });
  const LightTest test = test_of_light(fast, truth, 0.02); // V-map 1 %, samples of 64 rays 1 %
  CAPTURE(test.part, test.off);
  CHECK(test.p > significance);
  // Light between surfaces alone, a twenty-fifth of the picture: it is as coarse as the splats of floor and leaves, by
  // 5 % too where the leaves have one side.
  CHECK(mean(fast, "Diffuse.G") == Approx(mean(truth, "Diffuse.G")).epsilon(0.1));
}
