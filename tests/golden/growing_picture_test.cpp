/// Pictures that get better, as the command line writes them.
#include "host/available_memory.h"
#include "host/image/picture_writer.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>
#include <filesystem>

using namespace pointgi;
using namespace pointgi::test;
using Catch::Contains;

TEST_CASE("a growing picture is whole whenever it is interrupted", "[long]") {
  const TemporaryFolder folder;
  const std::string lit = std::string(small_scene()) + "[environment]\nradiance = [1.0, 1.0, 1.0]\n";
  const std::string scene = folder.write("ball.toml", lit), out = folder.file("x.exr");
  const std::string slow = "render " + scene + " --progressive --size 600x800 --spp 65536 -o " + out;
  REQUIRE(run_program("render " + scene + " -o " + out).code == 0); // builds the kernels
  std::filesystem::remove(out);
  for (const char* seconds : {"4", "16", "64"}) { // until the first picture is there, on any machine
    const Run run = run_program(slow, std::string("timeout --foreground --preserve-status -s INT ") + seconds);
    CHECK(run.code == 130);
    CHECK_THAT(run.err, Contains("interrupted"));
    if (std::filesystem::exists(out)) break;
  }
  const Picture picture = read_exr(out);
  CHECK(picture.width == 600);
  REQUIRE(picture.height == 800);
  // The environment is everywhere: no row is black.
  const std::vector<float>& red = picture.channels.at("R");
  for (std::size_t y = 0; y < 800; ++y)
    CHECK(red[y * 600] > 0.0f);
}

TEST_CASE("samples and what they follow from are not both given") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("ball.toml", small_scene());
  const Run run = run_program("render " + scene + " --spp 8 --time 10 -o " + folder.file("x.exr"));
  CHECK(run.code == 2);
  CHECK_THAT(run.err, Contains("error: --spp: the samples follow from --time; leave one of the two out"));
}

TEST_CASE("who waits for a picture is told how long and how accurate it will be, once") {
  const TemporaryFolder folder;
  const std::string lit = std::string(small_scene()) + "[environment]\nradiance = [1.0, 1.0, 1.0]\n";
  const std::string scene = folder.write("ball.toml", lit);
  const Run waited = run_program("render " + scene + " --progressive -o " + folder.file("a.exr"));
  REQUIRE(waited.code == 0);
  const std::size_t told = waited.err.find("expected: ");
  REQUIRE(told != std::string::npos);
  CHECK_THAT(waited.err.substr(told, waited.err.find('\n', told) - told),
             Catch::Matches("expected: .* s from here; relMSE .*"));
  CHECK(waited.err.find("expected: ", told + 1) == std::string::npos);
  // The estimate leaves no trace in the picture.
  REQUIRE(run_program("render " + scene + " --progressive --quiet -o " + folder.file("b.exr")).code == 0);
  CHECK(read_exr(folder.file("a.exr")).channels == read_exr(folder.file("b.exr")).channels);
}

TEST_CASE("a growing picture whose film the machine cannot hold is refused, and the older one stays") {
  if (available_memory().value_or(std::uint64_t(1) << 50) >= std::uint64_t(376821) << 20) return; // it can
  const TemporaryFolder folder;
  const std::string scene = folder.write("ball.toml", small_scene()), out = folder.write("x.exr", "older");
  const Run run = run_program("render " + scene + " --time 5 --size 65536x32767 -o " + out);
  CHECK(run.code == 6);
  CHECK_THAT(run.err, Contains("keeps a film of 376821 MiB") && Contains("a smaller --size"));
  CHECK(contents(out) == "older");
}
