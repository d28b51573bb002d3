#include "host/error.h"
#include "host/render/light_paths.h"
#include <catch2/catch.hpp>
#include <string>
#include <vector>

using namespace pointgi;
using Catch::Contains;

namespace {

/// Which of these count, as a string of 0 and 1.
std::string counted(const std::string& list, const std::vector<std::string>& surfaces) {
  const LightPaths paths = light_paths(list, {});
  std::string bits;
  for (const std::string& of : surfaces)
    bits += paths.counts(of) ? '1' : '0';
  return bits;
}

} // namespace

TEST_CASE("classes of light paths count their paths, the longest bounds the bounces") {
  const std::string long_path(100, 'D');
  const std::vector<std::string> diffuse = {"", "D", "DD", "DDD", "DDDD", long_path};
  CHECK(light_paths("", {}).all);
  CHECK(counted("", diffuse) == "111111");
  CHECK(counted("LE", diffuse) == "100000");
  CHECK(counted("LDE,LDDE,LDDDE", diffuse) == "011100");
  CHECK(counted("LDDE,LE", diffuse) == "101000");
  CHECK(counted("LD+E", diffuse) == "011111");
  CHECK(counted("LE,LD+E", diffuse) == "111111");
  CHECK(counted("LDD+E", diffuse) == "001111");
  CHECK(counted("LD+DE", diffuse) == "001111");
  CHECK(counted("LD+D+DE", diffuse) == "000111");
  CHECK(light_paths("", {}).most_bounces == NO_BOUNCE_LIMIT);
  CHECK(light_paths("LE", {}).most_bounces == 0u);
  CHECK(light_paths("LDE,LDDE,LDDDE", {}).most_bounces == 3u);
  CHECK(light_paths("LDD+E", {}).most_bounces == NO_BOUNCE_LIMIT);
  CHECK(light_paths("L" + std::string(30, 'D') + "E", {}).most_bounces == 30u);
  CHECK(light_paths("LD+E", 5).most_bounces == 5u);
  CHECK(light_paths("LDE", 5).most_bounces == 1u);
  CHECK(light_paths("", 0).most_bounces == 0u);
}

TEST_CASE("classes that a scene has no path of are told from those that it has, with what is missing") {
  PathSupply lit, shone, mirror, phong;
  lit.diffuse = lit.light_sources = true;
  shone.diffuse = shone.area_lights = true;
  mirror = lit;
  mirror.specular = true;
  phong = mirror;
  phong.lobes = true;
  const auto why = [](const std::string& list, const PathSupply& scene, std::optional<int> max_depth = {}) {
    return why_no_path(list, max_depth, scene);
  };
  for (const char* list : {"", "LDE", "LDDDE", "LD*S*E", "LSE,LDE"})
    CHECK(why(list, lit).empty());
  CHECK(why("LE", shone).empty());
  CHECK_THAT(why("LE", lit), Contains("are not seen"));
  for (const char* list : {"LSE", "LS+DE", "LDDSE", "LDSDE,LSE"})
    CHECK_THAT(why(list, shone), Contains("no surface of it is specular"));
  CHECK(why("LDSE", mirror).empty());
  CHECK_THAT(why("LS+DE", mirror), Contains("by way of mirrors"));
  CHECK(why("LS+DE", phong).empty());
  CHECK(why("LDDDE", lit, 3).empty());
  CHECK_THAT(why("LDDDE", lit, 2), Contains("render.max_depth = 2"));
  CHECK_THAT(why("", lit, 0), Contains("render.max_depth = 0"));
  CHECK(why("", shone, 0).empty());
  PathSupply black = shone;
  black.diffuse = false;
  CHECK_THAT(why("LD+E", black), Contains("an albedo above 0"));
  CHECK(why("LSE,LD+E", PathSupply{}).empty()); // no light at all: the scene is told of that elsewhere
  CHECK(why("L" + std::string(30, 'D') + "E", lit).empty());
  PathSupply nothing;
  nothing.light_sources = true;
  CHECK_THAT(why("LDSE", nothing), Contains("name other classes"));
}

TEST_CASE("classes with specular surfaces tell caustics from reflections") {
  const std::vector<std::string> surfaces = {"", "D", "S", "DS", "SD", "SSD", "DDSS", "DSD", "SDS", "SDDS"};
  CHECK(counted("LE", surfaces) == "1000000000");
  CHECK(counted("LDE", surfaces) == "0100000000");
  CHECK(counted("LD*S*E", surfaces) == "1111001000");
  CHECK(counted("LD+S*E", surfaces) == "0101001000");
  CHECK(counted("LS*E", surfaces) == "1010000000");
  CHECK(counted("LS+DE", surfaces) == "0000110000");
  CHECK(counted("LS+DS*E", surfaces) == "0000110010");
  CHECK(counted("LS+DE,LSE,LDS+E", surfaces) == "0011110000");
  CHECK(counted("LD*SD*SE", surfaces) == "0000001011"); // in DSD an S is missing
  CHECK_FALSE(light_paths("LE,LD+E", {}).all);
  CHECK(light_paths("LS*DE", 4).most_bounces == 4u);
  CHECK(light_paths("LSDSE", {}).most_bounces == 3u);
  // What begins like no path that counts is given up.
  const LightPaths caustics = light_paths("LS+DE", {});
  CHECK((caustics.states[0] & PATH_GOES_ON) != 0u);
  CHECK((caustics.states[PATH_AFTER_S(caustics.states[0])] & (PATH_GOES_ON | PATH_COUNTS)) == 0u);
}

TEST_CASE("the automaton of a class says what its letters say, for all short paths") {
  // LD+S*E by hand: at least one D, and no D behind an S.
  const LightPaths paths = light_paths("LD+S*E", {});
  for (unsigned length = 0; length <= 10; ++length)
    for (unsigned bits = 0; bits < (1u << length); ++bits) {
      std::string surfaces;
      for (unsigned k = 0; k < length; ++k)
        surfaces += (bits >> k) & 1u ? 'S' : 'D';
      const bool truth = surfaces.find('D') != std::string::npos && surfaces.find("SD") == std::string::npos;
      REQUIRE(paths.counts(surfaces) == truth);
    }
}

TEST_CASE("what is no class of light paths is refused with the word and what is expected") {
  const auto says = [](const std::string& list) {
    try {
      light_paths(list, {});
    } catch (const Error& error) {
      CHECK(error.kind() == ErrorKind::usage);
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  for (const char* wrong : {"L", "E", "D", "DE", "LD", "EDL", "lde", "LDE,", ",LDE", "LDE,,LE", " LDE"})
    CHECK_THAT(says(wrong), Contains("from L to E"));
  for (const char* wrong : {"L+E", "LD++E", "L+DE", "L*DE", "LD*+E", "LXE", "LDE LE", "LDLE", "LD(D)E", "LdE"})
    CHECK_THAT(says(wrong), Contains("expected D or S, each with + or *"));
  CHECK_THAT(says("LDE,LSX+DE"), Contains("\"LSX+DE\"") && Contains("found \"X\""));
  std::string many;
  for (const char* word :
       {"LDSDSDSDSDSDSDSDSDSDSDSDSDSDSE", "LDDSDDSDDSDDSDDSDDSDDSDDSDDSE", "LSSDSSDSSDSSDSSDSSDSSDSSDSSDE",
        "LDDDSSSDDDSSSDDDSSSDDDSSSDDDE", "LSDDSSSDDDDSSSSSDDDDDDSSSSSDE", "LSSSSDDSSSSDDSSSSDDSSSSDDSSDE"})
    many += std::string(many.empty() ? "" : ",") + word;
  CHECK_THAT(says(many), Contains("too many classes"));
  CHECK_THAT(says("L" + std::string(31, 'D') + "E"), Contains("at most 30 D and S, found 31"));
}
