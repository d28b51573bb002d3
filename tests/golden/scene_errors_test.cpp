/// What a user reads when a scene file is wrong, word by word: scene_errors/NAME.toml against NAME.expected.
/// Cases that cannot lie in a folder (pipes, a million lights) are made here.
#include "host/error.h"
#include "host/scene/limits.h"
#include "host/scene/load_scene.h"
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

using namespace pointgi;
namespace fs = std::filesystem;

namespace {

const fs::path folder = fs::path(POINTGI_SOURCE_DIR) / "tests/golden/scene_errors";

std::string without(const std::string& prefix, std::string text) {
  for (auto at = text.find(prefix); at != std::string::npos; at = text.find(prefix))
    text.erase(at, prefix.size());
  return text;
}

std::string error_of(const fs::path& scene) {
  try {
    load_scene(scene.string());
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::input);
    return without(scene.parent_path().string() + "/", error.what());
  }
  return "(it loads)";
}

std::optional<std::string> contents(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in.is_open()) return std::nullopt;
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<fs::path> files_ending(const std::string& extension) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == extension) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

/// A folder for the scenes made here; it goes with them.
class Scratch {
public:
  Scratch() : path_(fs::temp_directory_path() / ("pointgi_scene_errors_" + std::to_string(::getpid()))) {
    fs::remove_all(path_);
    fs::create_directories(path_);
  }
  ~Scratch() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  fs::path file(const std::string& name) const { return path_ / name; }
  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(file(name), std::ios::binary) << text;
    return file(name);
  }

private:
  fs::path path_;
};

std::string repeated(const std::string& part, int count) {
  std::string text;
  for (int i = 0; i < count; ++i)
    text += part;
  return text;
}

const std::string one_shape =
    "version = 1\n[[material]]\nname = \"m\"\ntype = \"diffuse\"\n[[shape]]\ntype = \"disc\"\n"
    "centre = [0, 0, 0]\nnormal = [0, 1, 0]\nradius = 1\nspacing = 0.1\nmaterial = \"m\"\n";

} // namespace

TEST_CASE("every wrong scene gets its message", "[scene][golden]") {
  const std::vector<fs::path> scenes = files_ending(".toml");
  REQUIRE(scenes.size() > 60);
  for (const fs::path& scene : scenes) {
    INFO(scene.filename().string());
    const std::optional<std::string> expected = contents(fs::path(scene).replace_extension(".expected"));
    if (!expected) {
      FAIL_CHECK("there is no .expected file; the message is: " << error_of(scene));
      continue;
    }
    CHECK(error_of(scene) + "\n" == *expected);
  }
}

TEST_CASE("no message is kept for a scene that is gone", "[scene][golden]") {
  for (const fs::path& expected : files_ending(".expected")) {
    INFO(expected.filename().string());
    CHECK(fs::exists(fs::path(expected).replace_extension(".toml")));
  }
}

TEST_CASE("nesting a hundred thousand deep is refused with its line, and no stack overflows", "[scene][golden]") {
  const Scratch scratch;
  const int deep = 100000;
  const std::string tail = ": brackets nest deeper than 32; a scene needs 3 levels: check for brackets that are never "
                           "closed";
  const auto refused = [&](const std::string& text) { return error_of(scratch.write("deep.toml", text)); };
  CHECK(refused("version = 1\nx = " + repeated("[", deep) + repeated("]", deep)) == "deep.toml:2:37" + tail);
  CHECK(refused("version = 1\nx = " + repeated("{a=", deep) + "1" + repeated("}", deep)) == "deep.toml:2:101" + tail);
  CHECK(refused("version = 1\nx = [\n" + repeated("[\n", deep)) == "deep.toml:34:1" + tail);
  // Brackets in comments and texts are none; what hides behind odd quotes is found all the same.
  CHECK(refused(one_shape + "# " + repeated("[", deep)) == "(it loads)");
  CHECK(refused("version = 1\nx = [\"\"\"a\"\"\"\", " + repeated("[", deep)) == "deep.toml:2:47" + tail);

  const std::string keys = ": dotted keys nest deeper than 32; a scene needs 3 levels: check for brackets that are "
                           "never closed";
  CHECK(refused("version = 1\na" + repeated(".a", deep) + " = 1") == "deep.toml:2:66" + keys);
  CHECK(refused("version = 1\n[a" + repeated(".a", deep) + "]") == "deep.toml:2:67" + keys);
  CHECK(refused("version = 1\nx = {a" + repeated(".a", deep) + " = 1}") == "deep.toml:2:71" + keys);
}

TEST_CASE("what is no regular file is refused without being opened", "[scene][golden]") {
  const Scratch scratch;
  CHECK(error_of(scratch.file("none.toml")) ==
        "none.toml: no such file, expected a scene file; check the path, it is relative to the working directory");
  fs::create_directory(scratch.file("folder.toml"));
  CHECK(error_of(scratch.file("folder.toml")) == "folder.toml: is a folder, expected a scene file (TOML)");
  // Opening a FIFO that nobody writes to would wait for ever.
  REQUIRE(::mkfifo(scratch.file("pipe.toml").c_str(), 0600) == 0);
  CHECK(error_of(scratch.file("pipe.toml")) == "pipe.toml: is a pipe, socket or device, expected a regular scene "
                                               "file; save the scene to a file first");
  const std::string cloud = "version = 1\n[[material]]\nname = \"m\"\ntype = \"diffuse\"\n[[cloud]]\nmaterial = \"m\"\n"
                            "file = ";
  CHECK(error_of(scratch.write("scene.toml", cloud + "\"pipe.toml\"\n")) ==
        "scene.toml:7:8: cloud.0.file: expected a point cloud or mesh, found the scene file \"pipe.toml\"; a scene "
        "cannot include itself or another scene");
  REQUIRE(::mkfifo(scratch.file("pipe.ply").c_str(), 0600) == 0);
  CHECK(error_of(scratch.write("scene.toml", cloud + "\"pipe.ply\"\n")) ==
        "scene.toml:7:8: cloud.0.file: expected a regular file, but \"pipe.ply\" is a pipe, socket or device; save the "
        "cloud to a file first");
}

TEST_CASE("a scene that is its own cloud is refused under any name", "[scene][golden]") {
  const Scratch scratch;
  const std::string text = "version = 1\n[[material]]\nname = \"m\"\ntype = \"diffuse\"\n[[cloud]]\nmaterial = \"m\"\n"
                           "file = \"./self.ply\"\n";
  CHECK(error_of(scratch.write("self.ply", text)) ==
        "self.ply:7:8: cloud.0.file: expected a point cloud or mesh, found the scene file \"./self.ply\"; a scene "
        "cannot include itself or another scene");
}

TEST_CASE("a file too large for a scene is refused unread", "[scene][golden]") {
  const Scratch scratch;
  const fs::path file = scratch.write("large.toml", "version = 1\n");
  fs::resize_file(file, limits::scene_bytes + 1); // sparse: takes no disk
  CHECK(error_of(file) == "large.toml: has 268435457 bytes, expected a scene file of at most 268435456; points belong "
                          "into a PLY file that a [[cloud]] names");
}

TEST_CASE("a million lights load", "[scene][golden][long]") {
  const Scratch scratch;
  const int count = 1'000'000;
  std::string text = one_shape;
  text.reserve(static_cast<std::size_t>(count) * 80);
  for (int i = 0; i < count; ++i)
    text += "[[light]]\ntype = \"point\"\nposition = [" + std::to_string(i) + ", 2.5, 0]\npower_w = [1, 1, 1]\n";
  const Scene scene = load_scene(scratch.write("lights.toml", text).string());
  REQUIRE(scene.lights.size() == static_cast<std::size_t>(count));
  CHECK(scene.lights.back().vector.x() == count - 1);
  CHECK(scene.lights.back().place.line == 12u + 4u * (count - 1));
}
