/// Rays through the octree against Embree over the same splats, rays and threads, A B A B, medians of the pairs.
///   bench_traversal [--json FILE] [--splats N,…] [--pairs K] [--form step|wide] [CLOUD.ply …]
#include "host/app/default_view.h"
#include "host/app/prepare.h"
#include "host/passes/build_pools.h"
#include "host/passes/device_pools.h"
#include "host/passes/tuned.h"
#include "host/scene/lighting.h"
#include "tests/bench/embree_peer.h"
#include "tests/bench/synthetic_blob.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <spdlog/spdlog.h>

namespace {

using namespace pointgi;
using namespace pointgi::bench;

constexpr int image = 256; // pixels a side

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// 8x4 rays a pixel, a pixel's rays together, from the default camera.
std::vector<RayQuery> eye_rays(const Scene& scene, const Frame& frame) {
  const Camera camera = device_camera(scene, frame);
  std::vector<RayQuery> rays;
  for (int p = 0; p < image * image; ++p)
    for (int s = 0; s < 32; ++s) {
      const auto x = static_cast<float>(p % image + (s % 8 + 0.5) / 8.0),
                 y = static_cast<float>(p / image + (s / 8 + 0.5) / 4.0);
      Eigen::Vector3f d;
      for (int a = 0; a < 3; ++a)
        d[a] = camera.corner[a] + x * camera.step_x[a] + y * camera.step_y[a];
      d.normalize();
      RayQuery ray{};
      std::copy_n(camera.origin, 3, ray.origin);
      std::copy_n(d.data(), 3, ray.direction);
      ray.t_max = 1e6f;
      rays.push_back(ray);
    }
  return rays;
}

/// Cosine-distributed directions off random splats: what bounced light does to a traversal.
std::vector<RayQuery> bounced_rays(const std::vector<Splat>& splats, std::size_t count) {
  std::mt19937 g(7);
  std::normal_distribution<float> gauss;
  std::uniform_int_distribution<std::size_t> pick(0, splats.size() - 1);
  std::vector<RayQuery> rays(count);
  for (RayQuery& ray : rays) {
    const Splat& s = splats[pick(g)];
    const Eigen::Vector3f n(s.normal[0], s.normal[1], s.normal[2]);
    const Eigen::Vector3f d = (n + Eigen::Vector3f(gauss(g), gauss(g), gauss(g)).normalized() * 0.999f).normalized();
    for (int a = 0; a < 3; ++a) {
      ray.origin[a] = s.position[a] + 0.5f * s.radius * n[a];
      ray.direction[a] = d[a];
    }
    ray.t_min = s.radius;
    ray.t_max = 8.0f;
  }
  return rays;
}

struct Tracer {
  Session& session;
  DevicePools pools;
  TraversalVariant variant;

  double closest(const Buffer<RayQuery>& rays, const Buffer<RayAnswer>& answers) {
    cl::Kernel kernel = session.kernel("traverse/trace.cl", build_options(variant), "trace_closest_rays");
    return session.launch(kernel, LaunchShape::line(rays.size), pools.nodes, pools.leaves, pools.points, rays, answers,
                          static_cast<cl_uint>(rays.size), 0.0f);
  }
  /// Rays of one pixel together, where the form has packets.
  double coherent(const Buffer<RayQuery>& rays, const Buffer<RayAnswer>& answers) {
    if (variant.form != TraversalForm::wide) return closest(rays, answers);
    cl::Kernel kernel = session.kernel("traverse/trace.cl", build_options(variant), "trace_packets");
    const std::size_t packets = rays.size / 32;
    return session.launch(kernel, LaunchShape::line(packets, 16), pools.nodes, pools.leaves, pools.points, rays,
                          answers, static_cast<cl_uint>(packets));
  }
  double any(const Buffer<RayQuery>& rays, const Buffer<cl_uint>& blocked) {
    cl::Kernel kernel = session.kernel("traverse/trace.cl", build_options(variant), "trace_any_rays");
    return session.launch(kernel, LaunchShape::line(rays.size), pools.nodes, pools.leaves, pools.points, rays, blocked,
                          static_cast<cl_uint>(rays.size), 0.0f);
  }
};

nlohmann::json measure(Session& session, const std::string& name, const WorldSplats& world,
                       std::optional<TraversalForm> form, int pairs) {
  Scene scene;
  scene.traversal.form = form;
  scene.render.width = scene.render.height = image;
  choose_camera(scene, world);
  const Frame frame = frame_of(world.cloud);
  const std::vector<Splat> splats = place_in_cube(world, frame);
  const TraversalVariant variant = choose_variant(scene.traversal, scene.octree, session.info()).variant;
  std::vector<double> build, build_peer;
  for (int k = 0; k < pairs; ++k) {
    const auto start = std::chrono::steady_clock::now();
    build_pools(splats, variant);
    build.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    build_peer.push_back(EmbreePeer(splats).build_seconds());
  }
  const OctreePools pools = build_pools(splats, variant);
  Tracer tracer{session, upload_pools(session, pools, variant.storage), variant};
  const EmbreePeer peer(splats);
  const auto coherent = eye_rays(scene, frame), bounced = bounced_rays(splats, 1'000'000);
  const auto d_coherent = session.upload(coherent), d_bounced = session.upload(bounced);
  const auto d_answers = session.allocate<RayAnswer>(std::max(coherent.size(), bounced.size()));
  const auto d_blocked = session.allocate<cl_uint>(bounced.size());
  std::vector<RayAnswer> answers(coherent.size());
  tracer.coherent(d_coherent, d_answers); // warm
  std::vector<double> a[3], b[3];
  for (int k = 0; k < pairs; ++k) {
    a[0].push_back(tracer.coherent(d_coherent, d_answers));
    b[0].push_back(std::min(peer.closest_packet16(coherent, answers), peer.closest_single(coherent, answers)));
    a[1].push_back(tracer.closest(d_bounced, d_answers));
    b[1].push_back(peer.closest_single(bounced, answers));
    a[2].push_back(tracer.any(d_bounced, d_blocked));
    b[2].push_back(peer.any_single(bounced));
  }
  const OctreeSummary octree = summary_of(pools);
  nlohmann::json row{{"name", name},
                     {"splats", splats.size()},
                     {"form", octree.form},
                     {"bytes_per_splat", static_cast<double>(octree.bytes) / static_cast<double>(splats.size())}};
  std::printf("%s, %zu splats, form %s, %.0f bytes a splat\n", name.c_str(), splats.size(), octree.form,
              row["bytes_per_splat"].get<double>());
  const char* kinds[3] = {"coherent", "incoherent", "any-hit"};
  for (int i = 0; i < 3; ++i) {
    const auto rays = static_cast<double>(i == 0 ? coherent.size() : bounced.size());
    std::vector<double> ratios;
    for (int k = 0; k < pairs; ++k)
      ratios.push_back(b[i][static_cast<std::size_t>(k)] / a[i][static_cast<std::size_t>(k)]);
    const double ours = 1e-6 * rays / median(a[i]), theirs = 1e-6 * rays / median(b[i]);
    row[kinds[i]] = {{"mrays_per_s", ours}, {"embree_mrays_per_s", theirs}, {"ratio", median(ratios)}};
    std::printf("  %-10s %7.2f Mrays/s   Embree %7.2f   ratio %.2f\n", kinds[i], ours, theirs, median(ratios));
  }
  std::vector<double> ratios;
  for (int k = 0; k < pairs; ++k)
    ratios.push_back(build[static_cast<std::size_t>(k)] / build_peer[static_cast<std::size_t>(k)]);
  row["build"] = {{"seconds", median(build)}, {"embree_seconds", median(build_peer)}, {"ratio", median(ratios)}};
  std::printf("  %-10s %7.3f s         Embree %7.3f   ratio %.2f\n", "build", median(build), median(build_peer),
              median(ratios));
  return row;
}

} // namespace

int main(int argc, char** argv) {
  CLI::App app{"Rays through the octree against Embree"};
  std::string json_file, form_name = "auto";
  std::vector<std::size_t> sizes;
  std::vector<std::string> clouds;
  int pairs = 5;
  app.add_option("--json", json_file, "write the figures to this file");
  app.add_option("--splats", sizes, "sizes of the synthetic blob")->delimiter(',');
  app.add_option("--pairs", pairs, "measurements of each side")->check(CLI::Range(1, 1000));
  app.add_option("--form", form_name, "auto, step or wide")->check(CLI::IsMember({"auto", "step", "wide"}));
  app.add_option("CLOUD.ply", clouds, "scans to measure");
  CLI11_PARSE(app, argc, argv);
  if (sizes.empty() && clouds.empty()) sizes = {50'000, 500'000, 2'000'000};
  std::optional<TraversalForm> form;
  if (form_name != "auto") form = form_name == "step" ? TraversalForm::step : TraversalForm::wide;
  spdlog::set_level(spdlog::level::warn);
  try {
    Session session(choose_device(""));
    std::printf("device: %s (%s)\n", session.info().name.c_str(), session.info().platform.c_str());
    nlohmann::json rows = nlohmann::json::array();
    for (const std::size_t n : sizes) {
      WorldSplats world;
      world.cloud = synthetic_blob(n);
      world.material.assign(world.cloud.size(), 0);
      rows.push_back(measure(session, "blob", world, form, pairs));
    }
    for (const std::string& cloud : clouds)
      rows.push_back(measure(session, cloud, load_splats(load_bare_cloud(cloud)), form, pairs));
    if (!json_file.empty())
      std::ofstream(json_file)
          << nlohmann::json{{"device", session.info().name}, {"pairs", pairs}, {"rows", rows}}.dump(1) << "\n";
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
