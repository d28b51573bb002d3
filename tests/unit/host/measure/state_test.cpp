/// By what an earlier measurement is known to be of the same scene.
#include "host/measure/measure.h"
#include "tests/support/hdr_bytes.h"
#include "tests/support/run_program.h"
#include <catch2/catch.hpp>

using namespace pointgi;

TEST_CASE("a measurement is of another scene as soon as one of its files is another") {
  const test::TemporaryFolder folder;
  const auto sky = [](int width) {
    return test::hdr_header(width, 1) +
           test::hdr_row(std::vector<test::Rgbe>(static_cast<std::size_t>(width), {9, 9, 9, 128}), test::HdrCode::flat);
  };
  const std::string text = std::string(test::small_scene()) +
                           "[environment]\nmap = \"sky.hdr\"\n[[cloud]]\nfile = \"cube.obj\"\nmaterial = \"grey\"\n";
  MeasureOptions options;
  options.scene = folder.write("scene.toml", text);
  options.reference_file = folder.write("reference.exr", "");
  folder.write("cube.obj", "");
  folder.write("cube.mtl", "");
  folder.write("sky.hdr", sky(2));
  std::string before = state_of(options);
  CHECK(state_of(options) == before);
  const auto changes = [&](const std::string& name, const std::string& bytes) {
    INFO(name);
    folder.write(name, bytes);
    const std::string now = state_of(options);
    CHECK(now != before);
    before = now;
  };
  changes("scene.toml", text + "#");
  changes("cube.obj", "#");
  changes("cube.mtl", "#");
  changes("sky.hdr", sky(4));
  changes("reference.exr", "#");
  options.overrides = {"render.spp=2"};
  CHECK(state_of(options) != before);
}
