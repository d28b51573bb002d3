/// Real scans, where they lie beside the project: lit from the right side, closed where the scan is closed, as large as
/// their meshes.
#include "host/cloud/readers/ply.h"
#include "tests/support/render.h"
#include "tests/support/scans.h"
#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace pointgi;
using namespace pointgi::test;

namespace {

struct ScanPicture {
  Picture picture;
  nlohmann::json stats;
};

ScanPicture render_scan(const std::string& path, bool jitter = true) {
  const TemporaryFolder folder;
  RenderOptions options;
  options.input = path;
  options.output = folder.file("scan.exr");
  options.size = "640x480";
  options.quiet = true;
  options.ground = "none"; // what is covered is the cloud
  options.stats_file = folder.file("stats.json");
  // What is asked here is where the surface is and which side is lit.
  options.overrides = {"radiosity.method=none", "camera.backfaces=shade"};
  if (!jitter) options.overrides.push_back("render.jitter=false");
  if (run_render(options) != ExitCode::done) throw std::runtime_error("the picture was not finished");
  std::ifstream stats(options.stats_file);
  return {read_exr(options.output), nlohmann::json::parse(stats)};
}

/// Background pixels whose eight neighbours all lie on the object, as a share of the pixels on the object.
double pinhole_share(const Picture& picture) {
  const auto& a = picture.channels.at("A");
  const auto covered = [&](int x, int y) { return a[static_cast<std::size_t>(y) * picture.width + x] >= 0.5f; };
  int holes = 0, object = 0;
  for (int y = 1; y + 1 < picture.height; ++y)
    for (int x = 1; x + 1 < picture.width; ++x) {
      object += covered(x, y);
      int around = 0;
      for (int k = 0; k < 9; ++k)
        around += k != 4 && covered(x + k % 3 - 1, y + k / 3 - 1);
      holes += !covered(x, y) && around == 8;
    }
  return static_cast<double>(holes) / std::max(object, 1);
}

/// Mean of R over the pixels that the object fills.
double mean_on_object(const Picture& picture) {
  double sum = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < picture.channels.at("A").size(); ++i)
    if (picture.channels.at("A")[i] == 1.0f) {
      sum += picture.channels.at("R")[i];
      ++count;
    }
  return sum / std::max(count, 1);
}

/// Share of the image that the mesh covers, by casting the picture's own 8x4 rays a pixel (centres of the strata)
/// against all its triangles, which in the image plane is a test of a point against projected triangles.
double mesh_coverage(const PointCloud& mesh, const Picture& picture) {
  const int columns = 8 * picture.width, rows = 4 * picture.height;
  std::vector<bool> hit(static_cast<std::size_t>(columns) * rows, false);
  const auto& m = picture.attributes.world_to_ndc;
  struct Point {
    double x, y;
  };
  std::vector<Point> image(mesh.size());
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    double out[4];
    for (int c = 0; c < 4; ++c)
      out[c] =
          m[c] * mesh.position[i].x() + m[4 + c] * mesh.position[i].y() + m[8 + c] * mesh.position[i].z() + m[12 + c];
    // NDC runs upwards, rows run downwards; samples sit at half steps.
    image[i] = {out[0] / out[3] * columns - 0.5, (1.0 - out[1] / out[3]) * rows - 0.5};
  }
  for (const auto& t : mesh.triangle) {
    const Point &a = image[t[0]], &b = image[t[1]], &c = image[t[2]];
    const auto side = [](const Point& p, const Point& q, double x, double y) {
      return (q.x - p.x) * (y - p.y) - (q.y - p.y) * (x - p.x);
    };
    const int x0 = std::max(0, static_cast<int>(std::ceil(std::min({a.x, b.x, c.x}))));
    const int x1 = std::min(columns - 1, static_cast<int>(std::floor(std::max({a.x, b.x, c.x}))));
    const int y0 = std::max(0, static_cast<int>(std::ceil(std::min({a.y, b.y, c.y}))));
    const int y1 = std::min(rows - 1, static_cast<int>(std::floor(std::max({a.y, b.y, c.y}))));
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) {
        const double s0 = side(a, b, x, y), s1 = side(b, c, x, y), s2 = side(c, a, x, y);
        if ((s0 >= 0 && s1 >= 0 && s2 >= 0) || (s0 <= 0 && s1 <= 0 && s2 <= 0))
          hit[static_cast<std::size_t>(y) * columns + x] = true;
      }
  }
  return static_cast<double>(std::count(hit.begin(), hit.end(), true)) / static_cast<double>(hit.size());
}

} // namespace

TEST_CASE("scans: the right side lit, no pinholes", "[long]") {
  for (const char* name :
       {"bunny.ply", "dragon.ply", "horse.ply", "lion_takanawa.ply", "kinect_region_growing_rgb.ply", "pond.ply"}) {
    const auto path = scan_path(name);
    if (!path) {
      WARN(name << " is not there: skipped");
      continue;
    }
    CAPTURE(name);
    const auto [picture, stats] = render_scan(*path);
    // Seen from its front: backs are leaves and strays (lion, pond), and what shows through holes.
    // The pond is islands of uneven, noisy points, seen from 35 degrees above: 0.30 of backs and 3.7e-4 of pinholes
    // measured there: each island ends where its points do.
    const bool islands = std::string(name) == "pond.ply";
    CHECK(stats["render"]["back_face_share"] < (islands ? 0.35 : 0.1));
    CHECK(stats["memory"]["host_peak_bytes"] < 1.5e9);
    CHECK(pinhole_share(picture) <= (islands ? 6e-4 : 1e-4));
    CHECK(mean(picture, "A") > 0.05); // the camera looks at it
    // A grey object of albedo 0.75 under the default lights reads about 0.5, coloured scans a quarter of that; seen
    // from its back it would read 0.
    CHECK(mean_on_object(picture) >
          (std::string(name) == "bunny.ply" || std::string(name) == "dragon.ply" || std::string(name) == "horse.ply"
               ? 0.3
               : 0.05));
  }
}

TEST_CASE("scans: coverage equals the triangle mesh's within 1 %", "[long]") {
  for (const char* name : {"bunny.ply", "dragon.ply"}) {
    const auto path = scan_path(name);
    if (!path) {
      WARN(name << " is not there: skipped");
      continue;
    }
    CAPTURE(name);
    CloudReport report;
    const PointCloud mesh = read_ply(*path, {}, report);
    const Picture picture = render_scan(*path, false).picture;
    const double truth = mesh_coverage(mesh, picture);
    CHECK(truth > 0.05);
    CHECK(mean(picture, "A") == Approx(truth).epsilon(0.01));
    CHECK(pinhole_share(picture) <= 1e-4);
    WARN(name << ": coverage of the splats over the mesh's " << mean(picture, "A") / truth << ", pinholes "
              << pinhole_share(picture));
  }
}
