/// Nearest photons by the kernel against FLANN's single index on all its threads: same photons, places and k, A B A B,
/// answers compared; ends with 1 where they differ.
///   bench_gather [PHOTONS [PAIRS [K...]]]
#include "host/passes/variant.h"
#include "host/photon/device_photon_map.h"
#include "host/repeats.h"
#include "octree/build/cell_key.h"
#include "tests/support/photons.h"
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <flann/algorithms/dist.h>
#include <flann/algorithms/kdtree_single_index.h>
#include <omp.h>

using namespace pointgi;

namespace {

constexpr std::size_t place_count = 1'000'000;

template <typename Work>
double seconds_of(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Places on the surface that the photons lie on, in the order of a curve, and more of them than photons: as the
/// samples of a picture are.
std::vector<cl_float4> sorted_places(const std::vector<Photon>& photons) {
  std::vector<std::pair<std::uint64_t, cl_float4>> keyed;
  for (const Photon& p : photons) {
    CellCoordinates cell;
    for (int a = 0; a < 3; ++a)
      cell[a] = static_cast<std::uint32_t>(p.position[a] * static_cast<float>(1 << MAX_AXIS_BITS));
    keyed.push_back({morton_key(cell), {{p.position[0], p.position[1], p.position[2], 0.0f}}});
  }
  std::sort(keyed.begin(), keyed.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<cl_float4> places;
  for (const auto& [key, place] : keyed)
    places.push_back(place);
  return places;
}

/// Returns how many distances differ.
std::size_t measure(Session& session, std::size_t count, unsigned k, int pairs) {
  const std::vector<Photon> photons = test::caustic_photons(count, 1);
  const std::vector<cl_float4> places = sorted_places(test::caustic_photons(place_count, 2));
  PhotonMap map;
  const double our_build = seconds_of([&] { map = build_photon_map(photons); });
  const DevicePhotonMap on_device = upload_photon_map(session, map, k, INFINITY);
  const auto device_places = session.upload(places);
  const auto distance2 = session.allocate<float>(places.size() * k);
  const auto photon = session.allocate<cl_uint>(places.size() * k), found = session.allocate<cl_uint>(places.size());
  const Program program = nearest_photons_program(k);
  cl::Kernel kernel = session.kernel(program.file, program.options, "nearest_of_places");
  const auto ours = [&] {
    session.launch(kernel, LaunchShape::line((places.size() + PHOTON_PLACES_AT_ONCE - 1) / PHOTON_PLACES_AT_ONCE),
                   on_device.nodes, on_device.buckets, on_device.params, device_places, distance2, photon, found,
                   static_cast<cl_uint>(places.size()));
  };

  std::vector<float> rows, asked;
  for (const Photon& p : photons)
    rows.insert(rows.end(), p.position, p.position + 3);
  for (const cl_float4& p : places)
    asked.insert(asked.end(), p.s, p.s + 3);
  flann::KDTreeSingleIndex<flann::L2_3D<float>> index(flann::Matrix<float>(rows.data(), photons.size(), 3),
                                                      flann::KDTreeSingleIndexParams(12));
  const double their_build = seconds_of([&] { index.buildIndex(); });
  std::vector<std::size_t> indices(places.size() * k);
  std::vector<float> distances(places.size() * k);
  flann::Matrix<std::size_t> index_matrix(indices.data(), places.size(), k);
  flann::Matrix<float> distance_matrix(distances.data(), places.size(), k);
  flann::SearchParams search(-1, 0.0f, false);
  search.cores = omp_get_max_threads();
  const auto theirs = [&] {
    index.knnSearch(flann::Matrix<float>(asked.data(), places.size(), 3), index_matrix, distance_matrix, k, search);
  };

  ours();
  theirs();
  std::vector<double> our_seconds, their_seconds, ratios;
  for (int pair = 0; pair < pairs; ++pair) {
    our_seconds.push_back(seconds_of(ours));
    their_seconds.push_back(seconds_of(theirs));
    ratios.push_back(their_seconds.back() / our_seconds.back());
  }
  const std::vector<float> found_distances = session.download(distance2, places.size() * k);
  std::size_t different = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto begin = static_cast<std::ptrdiff_t>(i * k), end = static_cast<std::ptrdiff_t>((i + 1) * k);
    std::vector<float> a(found_distances.begin() + begin, found_distances.begin() + end),
        b(distances.begin() + begin, distances.begin() + end);
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    for (unsigned j = 0; j < k; ++j)
      different += std::fabs(a[j] - b[j]) > 1e-5f * b[j] + 1e-14f;
  }
  const auto rate = [&](const std::vector<double>& s) {
    return 1e-6 * static_cast<double>(places.size()) / median_of_repeats(s);
  };
  std::printf("%8zu photons, k %4u: %7.3f M places/s   FLANN %7.3f   ratio %.2f   build %.3f s, FLANN %.3f   %zu "
              "distances differ\n",
              count, k, rate(our_seconds), rate(their_seconds), median_of_repeats(ratios), our_build, their_build,
              different);
  std::fflush(stdout);
  return different;
}

} // namespace

int main(int argc, char** argv) {
  const std::size_t photons = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 200'000;
  const int pairs = argc > 2 ? std::max(1, std::atoi(argv[2])) : 5;
  std::vector<unsigned> ks;
  for (int i = 3; i < argc; ++i)
    ks.push_back(static_cast<unsigned>(std::strtoul(argv[i], nullptr, 10)));
  if (ks.empty()) ks = {1, 50, 500};
  try {
    Session session(choose_device(""));
    std::printf("device: %s, %d threads of FLANN\n", session.info().name.c_str(), omp_get_max_threads());
    std::size_t different = 0;
    for (const unsigned k : ks)
      different += measure(session, photons, k, pairs);
    if (different > 0) {
      std::fprintf(stderr, "error: %zu distances are not FLANN's\n", different);
      return 1;
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
