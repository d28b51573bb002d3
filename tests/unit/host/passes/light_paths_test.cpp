#include "host/error.h"
#include "host/passes/light_paths.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using Catch::Contains;

TEST_CASE("classes of light paths become bits, the longest bounds the bounces") {
  CHECK(light_paths("", {}).classes == ALL_PATH_CLASSES);
  CHECK(light_paths("", {}).most_bounces == NO_BOUNCE_LIMIT);
  CHECK(light_paths("LE", {}).classes == 1u);
  CHECK(light_paths("LE", {}).most_bounces == 0u);
  CHECK(light_paths("LDE,LDDE,LDDDE", {}).classes == 0b1110u);
  CHECK(light_paths("LDE,LDDE,LDDDE", {}).most_bounces == 3u);
  CHECK(light_paths("LDDE,LE", {}).classes == 0b101u);
  CHECK(light_paths("LD+E", {}).classes == ~1u);
  CHECK(light_paths("LE,LD+E", {}).classes == ALL_PATH_CLASSES);
  CHECK(light_paths("LDD+E", {}).classes == ~0b11u);
  CHECK(light_paths("LD+DE", {}).classes == ~0b11u);
  CHECK(light_paths("LD+D+DE", {}).classes == ~0b111u);
  CHECK(light_paths("LDD+E", {}).most_bounces == NO_BOUNCE_LIMIT);
  CHECK(light_paths("L" + std::string(30, 'D') + "E", {}).most_bounces == 30u);
  CHECK(light_paths("LD+E", 5).most_bounces == 5u);
  CHECK(light_paths("LDE", 5).most_bounces == 1u);
  CHECK(light_paths("", 0).most_bounces == 0u);
}

TEST_CASE("what is no class of light paths is refused with the word and what is expected") {
  const auto says = [](const std::string& list) {
    try {
      light_paths(list, {});
    } catch (const Error& error) {
      CHECK(error.code() == ExitCode::usage);
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  for (const char* wrong : {"L", "E", "D", "DE", "LD", "EDL", "lde", "LDE,", ",LDE", "LDE,,LE", " LDE"})
    CHECK_THAT(says(wrong), Contains("from L to E"));
  for (const char* wrong : {"L+E", "LD++E", "L+DE", "LXE", "LDE LE", "LD*E", "LDLE", "LD(D)E"})
    CHECK_THAT(says(wrong), Contains("expected D or D+"));
  CHECK_THAT(says("LDE,LS+DE"), Contains("\"LS+DE\"") && Contains("specular"));
  CHECK_THAT(says("L" + std::string(31, 'D') + "E"), Contains("at most 30 D, found 31"));
}
