/// The moving-least-squares surface of scans against their meshes, beside blended discs.
#include "tests/support/mesh_picture.h"
#include "tests/support/render.h"
#include "tests/support/scans.h"
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

TEST_CASE("patches of scans: silhouettes of the mesh, normals nearer to it than those of blended discs, no holes") {
  const Model model = GENERATE(Model{"bunny.ply", {0.3, 0.2, 1.8}}, Model{"horse.ply", {1.5, 0.4, 1.0}},
                               Model{"dragon_res3.ply", {0.4, 0.3, 1.8}}, Model{"dragon.ply", {0.4, 0.3, 1.8}});
  if (!scan_path(model.file)) return;
  CAPTURE(model.file);
  Likeness discs, patches;
  compare(model, 640, discs, patches);
  WARN(model.file << ": silhouette " << 100 * patches.silhouette << " % (discs " << 100 * discs.silhouette
                  << "), normals " << patches.angle << " degrees (" << discs.angle << "), holes " << patches.holes << " ("
                  << discs.holes << ")");
  CHECK(patches.silhouette <= 0.01);
  CHECK(patches.angle < discs.angle);
  CHECK(patches.holes <= discs.holes);
}
