/// Sizes at which 32 bits do not count what the exchange of light and the agreement of normals number.
#include "fmm/operators/grids.h"
#include "host/cloud/spanning_forest.h"
#include "host/error.h"
#include "host/radiosity/point_planes.h"
#include <catch2/catch.hpp>
#include <fstream>
#include <random>
#include <regex>

using namespace pointgi;

TEST_CASE("planes of a large scene begin where they should: nine of more than 477 million numbers") {
  const pg_uint stride = 600'000'008u;
  CHECK(FMM_PLANE(8, stride) == std::uint64_t{4'800'000'064});
  CHECK(FMM_PLANE(8, stride) > std::uint64_t{1} << 32);
  CHECK(plane_stride(600'000'000) == stride);
  CHECK(plane_stride(0xffffffe0u) == 0xffffffe8u);
  for (const std::uint64_t points : {std::uint64_t{0xfffffff1u}, std::uint64_t{1} << 32, std::uint64_t{1} << 33})
    CHECK_THROWS_AS(plane_stride(points), Error);
  CHECK(node_behind(4'000'000'000u, 27) == 4'000'000'032u);
  CHECK_THROWS_AS(node_behind(0xfffffff0u, 9), std::length_error);
  CHECK_THROWS_AS(node_behind(0xfffffff0u, 0xffffffffu), std::length_error);
}

TEST_CASE("no kernel of radiosity finds a plane by 32 bits") {
  // A product with a plane's length, or the length in a sum that is an index, in anything but FMM_PLANE.
  const std::regex product("(\\*|\\[) ?(stride|nodes|point_count)\\b *[^\\]]|\\b(stride|nodes|point_count) \\*");
  std::size_t planes = 0;
  for (const char* file :
       {"fmm/exchange.cl", "fmm/expand.cl", "fmm/m2l.cl", "fmm/near.cl", "direct/receive_from_all.cl",
        "gather/receive_from_senders.cl", "gather/receive_picked.cl"}) {
    std::ifstream in(std::string(POINTGI_SOURCE_DIR "/kernels/radiosity/") + file);
    std::size_t number = 0;
    bool comment = false;
    for (std::string line; std::getline(in, line);) {
      ++number;
      comment = comment || line.find("/*") == 0;
      const bool skip = comment;
      if (line.find("*/") != std::string::npos) comment = false;
      if (skip) continue;
      CAPTURE(file, number, line);
      CHECK_FALSE(std::regex_search(line, product));
      planes += line.find("FMM_PLANE(") != std::string::npos;
    }
    CHECK(number > 20);
  }
  CHECK(planes > 30);
}

TEST_CASE("normals agree the same whether 32 or 64 bits number the edges") {
  std::vector<Eigen::Vector3d> positions;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> inside(-1.0, 1.0);
  while (positions.size() < 3000) {
    const Eigen::Vector3d p(inside(random), inside(random), inside(random));
    if (p.norm() > 1.0 || p.norm() < 0.1) continue;
    positions.push_back(p.normalized());
  }
  const Sites sites(positions);
  std::vector<Eigen::Vector3f> narrow, wide;
  for (std::uint32_t s = 0; s < sites.size(); ++s)
    narrow.push_back(sites.position(s).normalized().cast<float>() * (s % 3 == 0 ? -1.0f : 1.0f));
  wide = narrow;
  const SpanningForest a = agree_normals(sites, narrow), b = agree_normals(sites, wide, 0);
  CHECK(a.trees == b.trees);
  CHECK(a.tree == b.tree);
  std::size_t outwards = 0;
  for (std::size_t s = 0; s < narrow.size(); ++s) {
    REQUIRE(narrow[s] == wide[s]);
    outwards += narrow[s].cast<double>().dot(sites.position(static_cast<std::uint32_t>(s))) > 0.0;
  }
  CHECK((outwards == 0 || outwards == narrow.size()));
}
