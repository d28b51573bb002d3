#include "host/cloud/site_spacing.h"
#include <catch2/catch.hpp>
#include <random>

using namespace pointgi;
using Eigen::Vector3d;
using Eigen::Vector3f;

namespace {

std::vector<Vector3d> grid(int columns, int rows) {
  std::vector<Vector3d> places;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x)
      places.emplace_back(x, y, 0);
  return places;
}

} // namespace

TEST_CASE("spacings are the same whether neighbours are kept or not", "[cloud]") {
  std::mt19937_64 random(3);
  std::vector<Vector3d> places;
  const int count = GENERATE(1, 2, 15, 3000); // of 20 and fewer none are kept
  for (int i = 0; i < count; ++i)
    places.emplace_back(1e-3 * static_cast<double>(random() % 1000), 1e-3 * static_cast<double>(random() % 1000), 0.0);
  Sites sites(places);
  const std::vector<float> spacing = spacings_of(sites);
  CHECK(keep_neighbours_and_spacings(sites, 20) == spacing);
  CHECK(spacings_of(sites) == spacing);
}

TEST_CASE("an isolated site gets its neighbours' spacing, others keep their own", "[cloud]") {
  std::vector<Vector3d> places = grid(30, 30);
  places.emplace_back(100, 0, 0);
  const Sites sites(places);
  const std::vector<float> own = spacings_of(sites);
  std::vector<float> spacing = own;
  rein_in_isolated(sites, spacing);
  for (std::uint32_t s = 0; s < sites.size(); ++s) {
    const bool is_isolated = *sites.points(s).begin() == 900;
    CHECK((spacing[s] < 0.1f * own[s]) == is_isolated);
    if (!is_isolated) CHECK(spacing[s] == own[s]);
  }
}

TEST_CASE("the share of opposed neighbours is right for a sample of many sites, too", "[cloud]") {
  const auto places = GENERATE(grid(300, 300), grid(1200, 1000));
  std::mt19937_64 random(4);
  std::vector<Vector3f> normals(places.size());
  for (Vector3f& normal : normals)
    normal = random() % 10 == 0 ? Vector3f(0, 0, -1) : Vector3f(0, 0, 1);
  const Sites sites(places);
  // A tenth is turned round: 2 * 0.1 * 0.9 of the pairs. Of 90,000 sites, each in twelve pairs of which half are its
  // own, the share's standard deviation is below 0.0014 even if all of a site's pairs were one.
  CHECK(with_normals(sites, normals, spacings_of(sites)).opposite == Approx(0.18).margin(0.007));
}
