/// Shapes against their true geometry: rays meet them where the quads and boxes are that they stand for, no farther
/// out, and nothing gets through where they meet.
#include "host/passes/ray_packets.h"
#include "tests/support/number.h"
#include "tests/support/photon_scene.h"
#include "tests/support/rays.h"
#include "tests/support/render.h"
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace pointgi;
using namespace pointgi::test;

namespace {

const std::string head = "version = 1\n[radiosity]\nmethod = \"none\"\n[[material]]\nname = \"white\"\ntype = "
                         "\"diffuse\"\nalbedo = [0.75, 0.75, 0.75]\n[camera]\nposition = [0.0, 0.0, 5.0]\nlook_at = "
                         "[0.0, 0.0, 0.0]\n[environment]\nradiance = [1.0, 1.0, 1.0]\n";

std::string box(double spacing, bool inward) {
  return head + "[[shape]]\ntype = \"box\"\nmin = [-1.0, -0.5, -0.7]\nmax = [1.0, 0.5, 0.7]\nmaterial = \"white\"\n" +
         "inward = " + (inward ? "true" : "false") + "\nspacing = " + std::to_string(spacing) + "\n";
}

/// A scene's splats with their borders on the device.
struct Borders {
  Scene scene;
  PlacedSplats placed;
  TraversalVariant variant;
  DevicePools pools;

  Borders(const std::string& toml, TraversalForm form)
      : scene(read(toml)), placed(load_and_place(scene, false)), variant(plain_variant(form)),
        pools(upload_pools(session(), build_pools(placed.splats, variant, placed.clips), variant.storage)) {
    variant.clips = !placed.clips.empty();
  }

  std::vector<RayAnswer> trace(const std::vector<RayQuery>& rays) const {
    Session& device = session();
    const Program program = trace_program(variant);
    const auto answers = device.allocate<RayAnswer>(rays.size());
    cl::Kernel kernel = device.kernel(program.file, program.options, "trace_closest_rays");
    device.launch(kernel, LaunchShape::line(rays.size(), variant.group.size()), pools.nodes, pools.leaves, pools.points,
                  device.upload(rays), answers, static_cast<cl_uint>(rays.size()), 0.0f);
    return device.download(answers, rays.size());
  }

  RayQuery ray(const Vector3d& from, const Vector3d& to) const {
    const Eigen::Vector3f origin = placed.frame.to_cube(from), direction = (to - from).normalized().cast<float>();
    return make_ray(origin.data(), direction.data());
  }

private:
  static Scene read(const std::string& toml) {
    const TemporaryFolder folder;
    std::ofstream(folder.file("scene.toml")) << toml;
    return load_scene(folder.file("scene.toml"));
  }
};

const Vector3d low(-1.0, -0.5, -0.7), high(1.0, 0.5, 0.7);

/// How long a line runs inside the box, widened by `more`: negative where it passes by. `enters`: how far off.
double inside_box(const Vector3d& from, const Vector3d& to, double more, double* enters = nullptr) {
  const Vector3d d = (to - from).normalized();
  double t0 = -1e9, t1 = 1e9;
  for (int a = 0; a < 3; ++a) {
    const double x = (low[a] - more - from[a]) / d[a], y = (high[a] + more - from[a]) / d[a];
    t0 = std::max(t0, std::min(x, y));
    t1 = std::min(t1, std::max(x, y));
  }
  if (enters != nullptr) *enters = t0;
  return t1 - t0;
}

/// On an edge of the box, up to `off` beside it.
Vector3d near_edge(std::mt19937& g, double off) {
  std::uniform_real_distribution<double> share(0.0, 1.0), beside(-off, off);
  std::uniform_int_distribution<int> axis(0, 2), side(0, 1);
  const int along = axis(g);
  Vector3d p;
  for (int a = 0; a < 3; ++a)
    p[a] = a == along ? low[a] + share(g) * (high[a] - low[a]) : (side(g) != 0 ? high[a] : low[a]) + beside(g);
  return p;
}

} // namespace

TEST_CASE("rays meet a box of splats where the box is, up to its edges") {
  const auto form = GENERATE(TraversalForm::wide, TraversalForm::step);
  const double spacing = GENERATE(0.3, 0.07);
  const Borders borders(box(spacing, false), form);
  std::mt19937 g(5);
  std::normal_distribution<double> gauss;
  std::vector<RayQuery> rays;
  std::vector<Vector3d> from, to;
  for (int i = 0; i < 200'000; ++i) {
    from.push_back(4.0 * Vector3d(gauss(g), gauss(g), gauss(g)).normalized());
    to.push_back(near_edge(g, i % 2 == 0 ? 0.3 * spacing : 1e-3));
    rays.push_back(borders.ray(from.back(), to.back()));
  }
  const std::vector<RayAnswer> found = borders.trace(rays);
  // Of what borders reach past each other (CLIP_MARGIN, 4e-6 of the cube at most) and a ray's direction is rounded by.
  const double slack = 6e-5;
  std::size_t missed = 0, past = 0, between = 0, met = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const bool hit = found[i].splat != NO_SPLAT;
    missed += !hit && inside_box(from[i], to[i], -slack) > 0.0;
    past += hit && inside_box(from[i], to[i], slack) < 0.0;
    double enters;
    const double length = inside_box(from[i], to[i], -slack, &enters); // through an edge it would meet the far side
    between += hit && length > 0.01 && found[i].t * borders.placed.frame.side > enters + 0.5 * length;
    met += hit;
  }
  CHECK(missed == 0);
  CHECK(past == 0);
  CHECK(between == 0);
  CHECK(met > rays.size() / 3);
}

TEST_CASE("no ray gets out of a closed room whose walls end where they meet") {
  const auto form = GENERATE(TraversalForm::wide, TraversalForm::step);
  const double spacing = GENERATE(0.3, 0.07);
  const Borders borders(box(spacing, true), form);
  std::mt19937 g(7);
  std::uniform_real_distribution<double> share(0.02, 0.98);
  std::vector<RayQuery> rays;
  for (int i = 0; i < 400'000; ++i) { // at edges, a hair beside them, and at corners
    const Vector3d from = low + Vector3d(share(g), share(g), share(g)).cwiseProduct(high - low);
    const Vector3d corner(i & 1 ? low[0] : high[0], i & 2 ? low[1] : high[1], i & 4 ? low[2] : high[2]);
    rays.push_back(borders.ray(from, i % 5 == 0 ? corner : near_edge(g, i % 3 == 0 ? 0.0 : i % 3 == 1 ? 1e-6 : 1e-4)));
  }
  std::size_t escaped = 0;
  for (const RayAnswer& answer : borders.trace(rays))
    escaped += answer.splat == NO_SPLAT;
  CHECK(escaped == 0);
}

TEST_CASE("the edge of a shadow is where the card's edge throws it, at any spacing") {
  // Parallel light 45 degrees off the vertical, so the shadow of the card, .5 up, is the card moved by .5.
  for (const double spacing : {0.2, 0.05}) {
    CAPTURE(spacing);
    const std::string scene =
        "version = 1\n[render]\nsize = [400, 20]\nspp = 32\n[camera]\nposition = [0.0, 40.0, 0.0]\nlook_at = [0.0, "
        "0.0, 0.0]\nup = [0.0, 0.0, -1.0]\nfov_deg = 0.2\n[radiosity]\nmethod = \"none\"\n[[material]]\nname = "
        "\"white\"\ntype = \"diffuse\"\nalbedo = [0.5, 0.5, 0.5]\n[[material]]\nname = \"black\"\ntype = "
        "\"diffuse\"\nalbedo = [0.0, 0.0, 0.0]\n"
        "[[light]]\ntype = \"directional\"\ndirection = "
        "[1.0, -1.0, 0.0]\nirradiance = [4.0, 4.0, 4.0]\n"
        "[[shape]]\ntype = \"quad\"\ncorner = [-3.0, 0.0, -3.0]\nedge_u = [0.0, 0.0, 6.0]\nedge_v = [6.0, 0.0, "
        "0.0]\nmaterial = \"white\"\nspacing = 0.2\n"
        "[[shape]]\ntype = \"quad\"\ncorner = [-2.83, 0.5, -0.7]\nedge_u = [0.0, 0.0, 1.4]\nedge_v = [2.33, 0.0, "
        "0.0]\nmaterial = \"black\"\nspacing = " +
        std::to_string(spacing) + "\n";
    const Picture picture = render_text(scene); // its middle is x = 0, where the shadow ends
    const std::vector<float>& r = picture.channels.at("R");
    const double lit = 0.5 * 4.0 / std::sqrt(2.0) / 3.14159265358979323846;
    double sum = 0.0;
    for (const float value : r)
      sum += value;
    const double width = 2.0 * 40.0 * std::tan(0.1 * 3.14159265358979323846 / 180.0) * 20.0; // of the picture, world
    // Lit from the edge, at x = 0, to the right: half of the picture.
    const double edge = (0.5 - sum / lit / static_cast<double>(r.size())) * width;
    INFO("the edge lies " << edge / spacing << " spacings past the card's");
    CHECK(std::abs(edge) < 0.03 * spacing);
  }
}

TEST_CASE("the light of a lamp is that of its true area, at any spacing") {
  // Far below a lamp of .3 x .2: E = L A / d^2, to 4e-5 at d = 40.
  for (const char* spacing : {"0.3", "0.09", "0.03"}) {
    CAPTURE(spacing);
    const std::string scene =
        "version = 1\n[render]\nsize = [16, 12]\nspp = 1024\n[camera]\nposition = [0.5, 3.0, 0.0]\nlook_at = [0.0, "
        "0.0, "
        "0.0]\nfov_deg = 5.0\n[radiosity]\nmethod = \"none\"\n[[material]]\nname = \"white\"\ntype = "
        "\"diffuse\"\nalbedo = [0.5, 0.5, 0.5]\n[[material]]\nname = \"lamp\"\ntype = \"diffuse\"\nalbedo = [0.0, 0.0, "
        "0.0]\nemission = [100.0, 100.0, 100.0]\n[[shape]]\ntype = \"quad\"\ncorner = [-1.0, 0.0, -1.0]\nedge_u = "
        "[0.0, 0.0, 2.0]\nedge_v = [2.0, 0.0, 0.0]\nmaterial = \"white\"\nspacing = 0.1\n[[shape]]\ntype = "
        "\"quad\"\ncorner = [-0.15, 40.0, -0.1]\nedge_u = [0.3, 0.0, 0.0]\nedge_v = [0.0, 0.0, 0.2]\nmaterial = "
        "\"lamp\"\nspacing = " +
        std::string(spacing) + "\n";
    const Picture picture = render_text(scene);
    double sum = 0.0;
    for (const float value : picture.channels.at("R"))
      sum += value;
    const double mean = sum / static_cast<double>(picture.channels.at("R").size());
    CHECK(mean == Approx(0.5 / 3.14159265358979323846 * 100.0 * 0.06 / 1600.0).epsilon(1e-3));
  }
}
