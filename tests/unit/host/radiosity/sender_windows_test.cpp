/// Windows of senders: every point in one, and what sends for them.
#include "host/radiosity/sender_windows.h"
#include "tests/support/exchange.h"
#include "tests/support/rooms.h"
#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>

using namespace pointgi;
using namespace pointgi::test;

namespace {

void check_each_once(const ClusterTree& tree, const SenderWindows& windows) {
  std::vector<std::uint32_t> members = windows.members;
  std::sort(members.begin(), members.end());
  REQUIRE(members.size() == tree.points.size());
  for (std::uint32_t i = 0; i < members.size(); ++i)
    CHECK(members[i] == i);
  std::uint32_t next = 0;
  for (const SenderWindow& w : windows.windows) {
    CHECK(w.first == next);
    CHECK(w.count > 0);
    next = w.first + w.count;
  }
  CHECK(next == members.size());
}

} // namespace

TEST_CASE("windows of senders hold every point once, at most so many, that face alike") {
  const ClusterTree tree = build_clusters(room_splats(3000), {});
  for (const unsigned most : {1u, 4u, 16u, 128u, 100000u}) {
    const SenderWindows windows = sender_windows(tree, most);
    CAPTURE(most);
    check_each_once(tree, windows);
    for (const SenderWindow& w : windows.windows) {
      CHECK(w.count <= most);
      const float* n = tree.points[windows.members[w.first]].normal;
      for (std::uint32_t k = w.first; k < w.first + w.count; ++k) {
        const float* m = tree.points[windows.members[k]].normal;
        CHECK(n[0] * m[0] + n[1] * m[1] + n[2] * m[2] > -0.51f); // both within 54.8 degrees of an axis
      }
    }
    // Windows are not much smaller than asked for: walls make up most of the room.
    if (most == 16) CHECK(windows.windows.size() < 3 * tree.points.size() / most);
    const Senders mean = mean_senders(tree, windows), middle = middle_senders(tree, windows);
    double area = 0.0, of_means = 0.0, of_middles = 0.0;
    for (const Splat& s : tree.points)
      area += double{s.area};
    for (std::size_t w = 0; w < windows.windows.size(); ++w) {
      of_means += mean.sends[w].area;
      of_middles += middle.sends[w].area;
      CHECK(mean.sends[w].n.norm() == Approx(1.0));
    }
    CHECK(of_means == Approx(area));
    CHECK(of_middles == Approx(area));
  }
  CHECK(sender_windows(build_clusters({}, {}), 4).windows.empty());
}

TEST_CASE("the mean radiosity of windows keeps the flux") {
  const ClusterTree tree = build_clusters(room_splats(1000), {});
  const auto b = varied_radiosity(tree.points);
  const SenderWindows windows = sender_windows(tree, 16);
  const auto mean = mean_radiosity(tree, windows, b);
  const Senders senders = mean_senders(tree, windows);
  double flux = 0.0, of_windows = 0.0;
  for (std::size_t i = 0; i < tree.points.size(); ++i)
    flux += b[3 * i] * double{tree.points[i].area};
  for (std::size_t w = 0; w < windows.windows.size(); ++w)
    of_windows += mean[3 * w] * senders.sends[w].area;
  CHECK(of_windows == Approx(flux));
}

TEST_CASE("a cut is refined where radiosity differs most, to so many clusters, and holds every point once") {
  const ClusterTree tree = build_clusters(room_splats(4000), {});
  std::vector<double> b(3 * tree.points.size(), 0.1);
  for (std::size_t i = 0; i < tree.points.size(); ++i)
    if (tree.points[i].position[0] > 0.5f) // all that differs lies on one side
      for (std::size_t c = 0; c < 3; ++c)
        b[3 * i + c] = 0.5 + 0.4 * std::sin(60.0 * double{tree.points[i].position[1]});
  ClusterCut cut{0};
  for (const std::size_t most : {10u, 40u, 160u}) {
    cut = refined_cut(tree, cut, b, most);
    CHECK(cut.size() >= most);
    CHECK(cut.size() < most + 8);
    check_each_once(tree, windows_of_cut(tree, cut));
  }
  std::size_t bright = 0, dark = 0;
  for (const std::uint32_t node : cut)
    ++(tree.nodes[node].centre[0] > 0.5f ? bright : dark);
  CHECK(bright > 4 * dark);
}
