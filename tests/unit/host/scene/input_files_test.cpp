/// The files that a scene is made of.
#include "host/scene/input_files.h"
#include "tests/support/hdr_bytes.h"
#include "tests/unit/host/scene/scene_files.h"
#include <catch2/catch.hpp>

using namespace pointgi;

TEST_CASE("a scene names its clouds, what lies beside a mesh, and its environment's map") {
  const test::SceneFolder folder;
  for (const char* name : {"scan.ply", "chair.obj", "chair.mtl", "wood.MTL", "chair.bin", "table.gltf"})
    folder.write(name, "");
  folder.write("sky.hdr",
               test::hdr_header(2, 1) + test::hdr_row({{1, 2, 3, 128}, {4, 5, 6, 128}}, test::HdrCode::flat));
  std::string text = "version = 1\n[environment]\nmap = \"sky.hdr\"\n"
                     "[[material]]\nname = \"grey\"\ntype = \"diffuse\"\nalbedo = [0.5, 0.5, 0.5]\n";
  for (const char* name : {"scan.ply", "chair.obj", "table.gltf"})
    text += std::string("[[cloud]]\nmaterial = \"grey\"\nfile = \"") + name + "\"\n";
  std::string names;
  for (const std::string& file : input_files(folder.load(text)))
    names += folder.without_folder(file) + " ";
  CHECK(names == "scan.ply chair.obj chair.mtl wood.MTL table.gltf chair.bin sky.hdr ");
}
