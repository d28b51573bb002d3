/// The moving-least-squares surface of scans against their meshes, beside blended discs.
#include "tests/support/mesh_picture.h"
#include "tests/support/render.h"
#include "tests/support/scans.h"
#include "tests/support/scene_parts.h"
#include "tests/support/stats_file.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;
using Eigen::Vector3d;

namespace {

/// A picture of splats beside that of their mesh.
struct Likeness {
  double silhouette = 0.0; ///< pixels that only one of them covers, over those of the mesh
  double angle = 0.0;      ///< mean between their normals where both cover, degrees
  std::size_t holes = 0;   ///< pixels of the mesh, all of whose neighbours it covers too, that the splats do not
};

Likeness likeness(const Picture& picture, const MeshPicture& mesh, int side) {
  const auto& alpha = picture.channels.at("A");
  Likeness l;
  std::size_t covered = 0, differ = 0, both = 0;
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      const auto at = [&](int r, int c) { return static_cast<std::size_t>(r * side + c); };
      const std::size_t pixel = at(row, column);
      const bool seen = alpha[pixel] > 0.5f;
      covered += mesh.covers(pixel);
      differ += mesh.covers(pixel) != seen;
      if (!mesh.covers(pixel)) continue;
      if (!seen) {
        bool inside = true;
        for (int r = std::max(row - 2, 0); r <= std::min(row + 2, side - 1); ++r)
          for (int c = std::max(column - 2, 0); c <= std::min(column + 2, side - 1); ++c)
            inside = inside && mesh.covers(at(r, c));
        l.holes += inside;
        continue;
      }
      const Vector3d n = Vector3d(picture.channels.at("N.X")[pixel], picture.channels.at("N.Y")[pixel],
                                  picture.channels.at("N.Z")[pixel])
                             .normalized();
      l.angle += std::acos(std::clamp(std::abs(n.dot(mesh.normal[pixel])), 0.0, 1.0)) * 180.0 / 3.14159265358979;
      ++both;
    }
  l.silhouette = static_cast<double>(differ) / static_cast<double>(covered);
  l.angle /= static_cast<double>(both);
  return l;
}

struct Model {
  const char* file;
  Vector3d from; ///< of the middle, in the model's largest extent
};

/// The model as discs, then as patches, in pictures of `side` pixels.
void compare(const Model& model, int side, Likeness& discs, Likeness& patches) {
  CloudReport report;
  const PointCloud mesh = read_cloud(*scan_path(model.file), {}, report);
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : mesh.position)
    box.extend(p);
  const double extent = box.sizes().maxCoeff();
  const SquareCamera camera{box.center() + extent * model.from, box.center(), 35.0, side};
  const MeshPicture truth = picture_of_mesh(mesh, camera);
  const std::string scene = "version = 1\n[render]\nsize = [" + std::to_string(side) + ", " + std::to_string(side) +
                            "]\nspp = 1\njitter = false\n" + camera.text() +
                            "[radiosity]\nmethod = \"none\"\n[environment]\nradiance = [1, 1, 1]\n[[material]]\n"
                            "name = \"m\"\ntype = \"diffuse\"\n[[cloud]]\nfile = \"" +
                            *scan_path(model.file) + "\"\nmaterial = \"m\"\n";
  discs = likeness(render_text(scene), truth, side);
  patches = likeness(render_text(scene + "[traversal]\nsurface = \"mls\"\n"), truth, side);
}

} // namespace

TEST_CASE("patches of scans: silhouettes of the mesh, normals nearer to it than those of blended discs, no holes",
          "[long]") {
  const Model model = GENERATE(Model{"bunny.ply", {0.3, 0.2, 1.8}}, Model{"horse.ply", {1.5, 0.4, 1.0}},
                               Model{"dragon.ply", {0.4, 0.3, 1.8}});
  if (!scan_path(model.file)) return;
  CAPTURE(model.file);
  Likeness discs, patches;
  compare(model, 480, discs, patches);
  INFO("silhouette " << patches.silhouette << " (discs " << discs.silhouette << "), normals " << patches.angle << " ("
                     << discs.angle << ") degrees, holes " << patches.holes << " (" << discs.holes << ")");
  // Measured: 0.1 % of bunny and dragon, 0.8 % of the horse, whose discs are as far off: its thin parts.
  CHECK(patches.silhouette <= 0.01);
  CHECK(patches.angle < 0.85 * discs.angle); // 0.66 to 0.78 measured
  CHECK(patches.holes <= discs.holes);
}

namespace {

const std::string as_patches = "[traversal]\nsurface = \"mls\"\n";

}

TEST_CASE("photons find a ball of few patches under its own solid angle", "[long]") {
  const TemporaryFolder folder;
  const std::string scene = head("0.0, 2.5, 5.0", "0.0, 0.6, 0.0", 40.0, 1) +
                            "[caustics]\nphotons = 100000\n[radiosity]\nmethod = \"none\"\n[[light]]\n"
                            "type = \"point\"\nposition = [0.5, 5.0, 1.0]\npower_w = [100, 100, 100]\n" +
                            material("m", "diffuse") + material("s", "glass") +
                            sphere("0.0, 0.8, 0.0", 0.7, "s", 0.15) +
                            quad("-4.0, 0.0, -4.0", "0.0, 0.0, 8.0", "8.0, 0.0, 0.0", "m", 0.5) + as_patches;
  render_text(scene, [&](RenderOptions& options) { options.stats_file = folder.file("stats.json"); });
  const double sine2 = 0.7 * 0.7 / (0.5 * 0.5 + 4.2 * 4.2 + 1.0), share = 0.5 * (1.0 - std::sqrt(1.0 - sine2));
  const nlohmann::json photons = json_of(folder.file("stats.json"))["photons"];
  // Of the share 0.4 % is noise, four standard deviations of 110,000 photons, those that miss among them; discs of this
  // spacing are 3 % too large.
  CHECK(photons["power_w"]["emitted"][1].get<double>() == Approx(100.0 * share).epsilon(0.005));
  CHECK(photons["absorbed"].get<int>() == 0);
}

TEST_CASE("mirrors and glass of patches vanish in a uniform environment, through either form", "[long]") {
  const bool glass = GENERATE(false, true);
  const std::string type = glass ? "glass" : "mirror", form = glass ? "step" : "wide";
  CAPTURE(type, form);
  const std::string scene = head("0.0, 0.0, 4.0", "0.0, 0.0, 0.0", 36.0, 32, "[48, 48]") + environment(1.0) +
                            material("m", type) + sphere("0.0, 0.0, 0.0", 1.0, "m", 0.1) + as_patches + "form = \"" +
                            form + "\"\n";
  for (const Picture& picture : {render_text(scene), trace(scene)}) {
    // As of discs (tests/analytic/specular_test.cpp).
    CHECK(mean(picture, "G") == Approx(1.0).epsilon(0.005));
    CHECK(smallest(picture, "G") > 0.95);
    CHECK(largest(picture, "G") < 1.05);
    CHECK(mean(picture, "Specular.G") > 0.3); // the sphere covers half of the picture
  }
}

TEST_CASE("a ball of few patches casts a round shadow, has no dark seams, and hides what a ball hides", "[long]") {
  const std::string form = GENERATE("wide", "step");
  const std::string scene = head("0.0, 4.0, 9.0", "0.0, 0.5, 0.0", 40.0, 1, "[160, 160]\njitter = false") +
                            "[radiosity]\nmethod = \"none\"\n[[light]]\n"
                            "type = \"directional\"\ndirection = [0, -1, 0]\nirradiance = [1, 1, 1]\n" +
                            material("m", "diffuse") + sphere("0.0, 2.0, 0.0", 1.0, "m", 0.25) +
                            quad("-4.0, 0.0, -4.0", "0.0, 0.0, 8.0", "8.0, 0.0, 0.0", "m", 0.5) + as_patches +
                            "form = \"" + form + "\"\n";
  const Picture picture = render_text(scene);
  const auto channel = [&](const char* name) -> const std::vector<float>& { return picture.channels.at(name); };
  std::size_t floor = 0, wrong = 0, ball = 0, unlike = 0;
  for (std::size_t i = 0; i < channel("A").size(); ++i) {
    if (channel("A")[i] == 0.0f) continue;
    const Vector3d p(channel("P.X")[i], channel("P.Y")[i], channel("P.Z")[i]),
        n(channel("N.X")[i], channel("N.Y")[i], channel("N.Z")[i]);
    const bool lit = channel("Direct.G")[i] > 0.0f;
    if (p.y() > 0.9) { // the ball: lit where it faces the light
      const Vector3d off = p - Vector3d(0.0, 2.0, 0.0);
      ++ball;
      // h is an eighth of the diameter: a quadratic leaves 1e-3 of the radius, and 1 degree.
      unlike += std::abs(off.norm() - 1.0) > 2e-3 || n.normalized().dot(off.normalized()) < 0.9995;
      if (std::abs(off.y()) > 0.05) unlike += lit != (off.y() > 0.0);
      continue;
    }
    const double from_axis = std::hypot(p.x(), p.z());
    if (std::abs(from_axis - 1.0) < 0.01) continue; // a pixel is 0.04 wide
    ++floor;
    wrong += lit != (from_axis > 1.0);
  }
  CHECK(floor > 5000);
  CHECK(wrong == 0);
  CHECK(ball > 1500);
  CHECK(unlike == 0);
}

TEST_CASE("patches of an open, bent sheet end where its discs do", "[long]") {
  // A quarter of a cylinder of radius 1 from z = -1 to 1, seen from where its border is the silhouette.
  const TemporaryFolder folder;
  std::ofstream ply(folder.file("sheet.ply"));
  constexpr int along = 25, around = 20;
  constexpr double step = 1.0 / (along - 1);
  ply << "ply\nformat ascii 1.0\nelement vertex " << along * around
      << "\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\n"
         "property float nz\nend_header\n";
  for (int i = 0; i < along; ++i)
    for (int k = 0; k < around; ++k) {
      const double turn = 0.785398 + 1.570796 * k / (around - 1);
      ply << std::cos(turn) << " " << std::sin(turn) << " " << 2.0 * step * i - 1.0 << " " << std::cos(turn) << " "
          << std::sin(turn) << " 0\n";
    }
  ply.close();
  const std::string scene = head("0.0, 6.0, 0.001", "0.0, 0.0, 0.0", 30.0, 4, "[256, 256]") + environment(1.0) +
                            material("m", "diffuse") + "[[cloud]]\nfile = \"" + folder.file("sheet.ply") +
                            "\"\nmaterial = \"m\"\n";
  const double discs = mean(render_text(scene), "A"), patches = mean(render_text(scene + as_patches), "A");
  INFO("discs " << discs << " patches " << patches);
  // Half a spacing around a sheet of 36 spacings by 26: 6 %. A bulge, or a border that is lost, would be as much.
  CHECK(patches == Approx(discs).epsilon(0.01));
}
