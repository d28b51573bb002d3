/// How the V-map grows: a closed room with a bumpy body, of 25,000 to 200,000 points; links by kind, rays and seconds.
/// bench_vmap [SAMPLES [EPSILON [POINT_SAMPLES [POINTS...]]]]
#include "host/passes/build_pools.h"
#include "host/passes/visibility.h"
#include "host/tune/variant_list.h"
#include "octree/ref/link_quality.h"
#include "tests/support/rooms.h"
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

using namespace pointgi;

namespace {

struct Row {
  std::size_t points = 0, clusters = 0;
  LinkStatistics links;
  double cluster_seconds = 0.0, link_seconds = 0.0;
  LinkQuality quality;
};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

Row measure(Session& session, std::size_t points, const LinkOptions& options) {
  Row row;
  const auto splats = test::room_splats(points);
  const TraversalVariant variant = plain_variant(TraversalForm::wide);
  const DevicePools pools = upload_pools(session, build_pools(splats, variant), variant.storage);
  auto start = std::chrono::steady_clock::now();
  const ClusterTree tree = build_clusters(splats, {});
  row.cluster_seconds = seconds_since(start);
  DeviceVisibility oracle(session, pools, variant, tree.points);
  start = std::chrono::steady_clock::now();
  const VMap map = make_links(tree, oracle, options);
  row.link_seconds = seconds_since(start);
  row.points = splats.size();
  row.clusters = tree.nodes.size();
  row.links = map.statistics;
  std::vector<std::uint32_t> receivers;
  for (std::size_t k = 0; k < 300; ++k) // spread along the curve
    receivers.push_back(static_cast<std::uint32_t>((2 * k + 1) * tree.points.size() / 600));
  row.quality = link_quality(tree, map, oracle, test::room_radiosity(tree.points), receivers, 0.1);
  return row;
}

void print(const Row& r) {
  const double pairs = static_cast<double>(r.points) * static_cast<double>(r.points) / 2.0;
  std::printf("%8zu %8zu | %9llu %8llu %8llu %8llu | %9llu %7.4f%% of all pairs | %6.2f %7.2f s | %5.2f %% (%+.2f) "
              "hiding %.2f %% missing %.2f %%\n",
              r.points, r.clusters, static_cast<unsigned long long>(r.links.pairs_tested),
              static_cast<unsigned long long>(r.links.far), static_cast<unsigned long long>(r.links.mid),
              static_cast<unsigned long long>(r.links.near_), static_cast<unsigned long long>(r.links.rays),
              100.0 * static_cast<double>(r.links.rays) / pairs, r.cluster_seconds, r.link_seconds,
              100.0 * r.quality.error, 100.0 * r.quality.bias, 100.0 * r.quality.hiding, 100.0 * r.quality.missing);
  std::fflush(stdout);
}

double growth(const Row& first, const Row& last, double a, double b) {
  return std::log(b / a) / std::log(static_cast<double>(last.points) / static_cast<double>(first.points));
}

} // namespace

int main(int argc, char** argv) {
  LinkOptions options;
  if (argc > 1) options.samples = static_cast<unsigned>(std::strtoul(argv[1], nullptr, 10));
  if (argc > 2) options.epsilon = std::strtof(argv[2], nullptr);
  options.thesis = argc > 1 && std::string(argv[1]) == "thesis";
  if (options.thesis) options.samples = 1;
  if (argc > 3) options.point_samples = static_cast<unsigned>(std::strtoul(argv[3], nullptr, 10));
  std::vector<std::size_t> sizes;
  for (int k = 4; k < argc; ++k)
    sizes.push_back(std::strtoul(argv[k], nullptr, 10));
  if (sizes.empty()) sizes = {25'000, 50'000, 100'000, 200'000};
  Session session(choose_device(""));
  std::printf("K %u, epsilon %g, %u segments a point of a link partly visible\n  points clusters |     pairs      far  "
              "    mid     near |      rays | clusters, links "
              "| error of H (bias) at 300 points\n",
              options.samples, static_cast<double>(options.epsilon), options.point_samples);
  std::vector<Row> rows;
  for (const std::size_t size : sizes) {
    rows.push_back(measure(session, size, options));
    print(rows.back());
  }
  if (rows.size() < 2) return 0;
  const Row &first = rows.front(), &last = rows.back();
  const auto links = [](const Row& r) { return static_cast<double>(r.links.far + r.links.mid + r.links.near_); };
  std::printf("growth exponents: links %.2f, rays %.2f, seconds %.2f\n", growth(first, last, links(first), links(last)),
              growth(first, last, static_cast<double>(first.links.rays), static_cast<double>(last.links.rays)),
              growth(first, last, first.link_seconds, last.link_seconds));
  return 0;
}
