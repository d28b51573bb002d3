/// Rays through the octree against Embree over the same splats, rays and threads, A B A B, medians of the pairs.
///   bench_traversal [--json FILE] [--markdown FILE] [--splats N,…] [--pairs K] [--form step|wide] [--clock wall|cpu]
///                   [CLOUD.ply …]
#include "host/passes/build_pools.h"
#include "host/passes/device_pools.h"
#include "host/passes/ray_packets.h"
#include "host/repeats.h"
#include "host/scene/lighting.h"
#include "host/stages/prepare.h"
#include "host/tune/profile.h"
#include "host/tune/profile_rays.h"
#include "host/tune/tuned.h"
#include "host/view/default_view.h"
#include "tests/bench/embree_peer.h"
#include "tests/bench/synthetic_blob.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>
#include <random>
#include <spdlog/spdlog.h>
#include <stdexcept>

namespace {

using namespace pointgi;
using namespace pointgi::bench;

constexpr int image = 256; // pixels a side

/// What a measurement counts: the wall's seconds, or those that the process computed on all its threads, which other
/// programs on the machine disturb less.
clockid_t clock_id = CLOCK_MONOTONIC;

template <typename Work>
double seconds_of(const Work& work) {
  timespec start, end;
  clock_gettime(clock_id, &start);
  work();
  clock_gettime(clock_id, &end);
  return static_cast<double>(end.tv_sec - start.tv_sec) + 1e-9 * static_cast<double>(end.tv_nsec - start.tv_nsec);
}

/// The better of two runs in a row: the first finds the caches full of what the other side left there.
template <typename Work>
double warm_seconds_of(const Work& work) {
  const double first = seconds_of(work);
  return std::min(first, seconds_of(work));
}

struct Tracer {
  Session& session;
  DevicePools pools;
  TraversalVariant variant;

  cl::Kernel kernel(const char* name) {
    const Program program = trace_program(variant);
    return session.kernel(program.file, program.options, name);
  }
  void closest(const Buffer<RayQuery>& rays, const Buffer<RayAnswer>& answers) {
    cl::Kernel traced = kernel("trace_closest_rays");
    session.launch(traced, LaunchShape::line(rays.size, variant.group.size()), pools.nodes, pools.leaves, pools.points,
                   rays, answers, static_cast<cl_uint>(rays.size), 0.0f);
  }
  std::vector<RayAnswer> nearest(const std::vector<RayQuery>& rays) {
    const auto answers = session.allocate<RayAnswer>(rays.size());
    closest(session.upload(rays), answers);
    return session.download(answers, rays.size());
  }
  /// Rays of one pixel together.
  void packets(const Buffer<RayPacketQuery>& rays, const Buffer<RayPacketAnswer>& answers) {
    cl::Kernel traced = kernel("trace_packets");
    session.launch(traced, LaunchShape::line(rays.size, variant.group.size()), pools.nodes, pools.leaves, pools.points,
                   rays, answers, static_cast<cl_uint>(rays.size));
  }
  void any(const Buffer<RayQuery>& rays, const Buffer<cl_uint>& blocked) {
    cl::Kernel traced = kernel("trace_any_rays");
    session.launch(traced, LaunchShape::line(rays.size, variant.group.size()), pools.nodes, pools.leaves, pools.points,
                   rays, blocked, static_cast<cl_uint>(rays.size), 0.0f);
  }
};

/// Seconds of both sides, pair after pair.
struct Pairs {
  std::vector<double> ours, theirs;

  double ratio() const {
    std::vector<double> ratios;
    for (std::size_t k = 0; k < ours.size(); ++k)
      ratios.push_back(theirs[k] / ours[k]);
    return median_of_repeats(ratios);
  }
};

nlohmann::json report_rays(const char* kind, const Pairs& pairs, std::size_t rays) {
  const double ours = 1e-6 * static_cast<double>(rays) / median_of_repeats(pairs.ours),
               theirs = 1e-6 * static_cast<double>(rays) / median_of_repeats(pairs.theirs);
  std::printf("  %-10s %7.2f Mrays/s   Embree %7.2f   ratio %.2f\n", kind, ours, theirs, pairs.ratio());
  return {{"mrays_per_s", ours}, {"embree_mrays_per_s", theirs}, {"ratio", pairs.ratio()}};
}

Pairs measure_build(const std::vector<Splat>& splats, const TraversalVariant& variant, int pairs) {
  Pairs result;
  for (int k = 0; k < pairs; ++k) {
    result.ours.push_back(seconds_of([&] { build_pools(splats, variant); }));
    result.theirs.push_back(seconds_of([&] { EmbreePeer peer(splats); }));
  }
  return result;
}

/// Hits of all rays, in packets where the form has them; Embree's best of its three ways to ask.
Pairs measure_coherent(Tracer& tracer, const EmbreePeer& peer, const std::vector<RayQuery>& rays, int pairs,
                       double& hit_share) {
  std::vector<RayAnswer> answers(rays.size());
  const bool packets = tracer.variant.grouping == RayGrouping::packet;
  const auto on_device = tracer.session.upload(rays);
  const auto device_answers = tracer.session.allocate<RayAnswer>(rays.size());
  const std::vector<RayPacketQuery> as_packets = packets_of(rays);
  std::vector<RayPacketAnswer> peer_packet_answers(as_packets.size());
  const auto packets_on_device = tracer.session.upload(as_packets);
  const auto packet_answers = tracer.session.allocate<RayPacketAnswer>(as_packets.size());
  const auto ours = [&] {
    if (packets)
      tracer.packets(packets_on_device, packet_answers);
    else
      tracer.closest(on_device, device_answers);
  };
  ours(); // warm
  Pairs result;
  for (int k = 0; k < pairs; ++k) {
    result.ours.push_back(warm_seconds_of(ours));
    result.theirs.push_back(std::min({warm_seconds_of([&] { peer.closest_packet16(as_packets, peer_packet_answers); }),
                                      warm_seconds_of([&] { peer.closest_stream32(rays, answers); }),
                                      warm_seconds_of([&] { peer.closest_single(rays, answers); })}));
  }
  const auto hits = std::count_if(answers.begin(), answers.end(), [](const auto& a) { return a.splat != NO_SPLAT; });
  hit_share = static_cast<double>(hits) / static_cast<double>(rays.size());
  return result;
}

/// Bounced rays: nearest hit, then any hit.
std::array<Pairs, 2> measure_incoherent(Tracer& tracer, const EmbreePeer& peer, const std::vector<RayQuery>& rays,
                                        int pairs) {
  const auto on_device = tracer.session.upload(rays);
  const auto device_answers = tracer.session.allocate<RayAnswer>(rays.size());
  const auto blocked = tracer.session.allocate<cl_uint>(rays.size());
  std::vector<RayAnswer> answers(rays.size());
  std::array<Pairs, 2> result;
  for (int k = 0; k < pairs; ++k) {
    result[0].ours.push_back(warm_seconds_of([&] { tracer.closest(on_device, device_answers); }));
    result[0].theirs.push_back(warm_seconds_of([&] { peer.closest_single(rays, answers); }));
    result[1].ours.push_back(warm_seconds_of([&] { tracer.any(on_device, blocked); }));
    result[1].theirs.push_back(warm_seconds_of([&] { peer.any_single(rays); }));
  }
  return result;
}

/// A lamp that lights the splats from +z and a little from the side: centre, unit vectors of its plane, and radius,
/// root cube units.
struct Lamp {
  Eigen::Vector3f centre, u, v;
  float radius;
};

Lamp lamp_over(const std::vector<Splat>& splats) {
  Eigen::Vector3f low = Eigen::Vector3f::Constant(1.0f), high = Eigen::Vector3f::Zero();
  for (const Splat& s : splats)
    for (int a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], s.position[a]);
      high[a] = std::max(high[a], s.position[a]);
    }
  const Eigen::Vector3f away = Eigen::Vector3f(0.4f, -0.3f, 0.87f).normalized();
  const float size = (high - low).norm();
  Lamp lamp;
  lamp.centre = 0.5f * (low + high) + 0.6f * size * away;
  lamp.u = away.unitOrthogonal();
  lamp.v = away.cross(lamp.u);
  lamp.radius = 0.06f * size;
  return lamp;
}

/// Shadow rays of the eye rays that hit: each from a little before its hit to a stratum of its own of the lamp, 32 a
/// pixel, which of them by chance as a renderer draws it; 128 a packet of 2 x 2 pixels, of which those are taken in
/// which all rays hit and the surface faces the lamp. `points`: of the pool, whose indices the answers are.
std::vector<RayQuery> shadow_rays(const std::vector<RayQuery>& eye, const std::vector<RayAnswer>& answers,
                                  View<Splat> points, const Lamp& lamp) {
  std::vector<RayQuery> rays;
  std::mt19937 random(11);
  std::array<std::uint32_t, GRID_RAYS> strata;
  std::iota(strata.begin(), strata.end(), 0u);
  for (std::size_t first = 0; first + PACKET_RAYS <= eye.size(); first += PACKET_RAYS) {
    std::vector<RayQuery> packet;
    for (std::size_t k = first; k < first + PACKET_RAYS && answers[k].splat != NO_SPLAT; ++k) {
      if (k % GRID_RAYS == 0)
        for (std::size_t i = GRID_RAYS - 1; i > 0; --i)
          std::swap(strata[i], strata[random() % (i + 1)]);
      const Splat& s = points[answers[k].splat];
      const std::uint32_t stratum = strata[k % GRID_RAYS];
      const float column = (static_cast<float>(stratum % GRID_X) + 0.5f) / GRID_X,
                  row = (static_cast<float>(stratum / GRID_X) + 0.5f) / GRID_Y;
      const float r = lamp.radius * std::sqrt(row), angle = 6.2831853f * column;
      const Eigen::Vector3f normal(s.normal[0], s.normal[1], s.normal[2]);
      const Eigen::Vector3f target = lamp.centre + r * (std::cos(angle) * lamp.u + std::sin(angle) * lamp.v);
      RayQuery ray{};
      Eigen::Vector3f origin;
      for (int a = 0; a < 3; ++a)
        origin[a] = eye[k].origin[a] + answers[k].t * eye[k].direction[a] + 0.5f * s.radius * normal[a];
      const Eigen::Vector3f way = target - origin;
      if (way.dot(normal) <= 0.0f) break;
      const Eigen::Vector3f d = way.normalized();
      std::copy_n(origin.data(), 3, ray.origin);
      std::copy_n(d.data(), 3, ray.direction);
      ray.t_min = s.radius; // past the splat's own surface
      ray.t_max = way.norm();
      packet.push_back(ray);
    }
    if (packet.size() == PACKET_RAYS) rays.insert(rays.end(), packet.begin(), packet.end());
  }
  return rays;
}

struct ShadowPairs {
  Pairs pairs;
  const char* peer = ""; ///< Embree's way that is the fastest by its median
  double blocked_share = 0.0;
};

/// Whether anything is hit, ours one ray at a time; Embree's best of its three ways. Throws std::runtime_error where
/// their answers differ by more than rounding.
ShadowPairs measure_shadow(Tracer& tracer, const EmbreePeer& peer, const std::vector<RayQuery>& rays, int pairs) {
  struct Way {
    const char* name;
    std::size_t (EmbreePeer::*any)(const std::vector<RayQuery>&) const;
    std::vector<double> seconds;
  };
  std::array<Way, 3> ways{Way{"packets of 16", &EmbreePeer::any_packet16, {}},
                          Way{"streams of 32", &EmbreePeer::any_stream32, {}},
                          Way{"single rays", &EmbreePeer::any_single, {}}};
  const auto on_device = tracer.session.upload(rays);
  const auto blocked = tracer.session.allocate<cl_uint>(rays.size());
  tracer.any(on_device, blocked);
  const auto answers = tracer.session.download(blocked, rays.size());
  const auto ours = static_cast<std::size_t>(std::count(answers.begin(), answers.end(), 1u));
  for (const Way& way : ways) {
    const std::size_t theirs = (peer.*way.any)(rays);
    // Edges of discs are known to rounding.
    if (std::max(ours, theirs) - std::min(ours, theirs) > rays.size() / 10'000)
      throw std::runtime_error(std::to_string(ours) + " of " + std::to_string(rays.size()) +
                               " shadow rays are blocked, by Embree's " + way.name + " " + std::to_string(theirs));
  }
  ShadowPairs result;
  for (int k = 0; k < pairs; ++k) {
    result.pairs.ours.push_back(warm_seconds_of([&] { tracer.any(on_device, blocked); }));
    for (Way& way : ways)
      way.seconds.push_back(warm_seconds_of([&] { (peer.*way.any)(rays); }));
  }
  const Way& best = *std::min_element(ways.begin(), ways.end(), [](const Way& a, const Way& b) {
    return median_of_repeats(a.seconds) < median_of_repeats(b.seconds);
  });
  result.pairs.theirs = best.seconds;
  result.peer = best.name;
  result.blocked_share = static_cast<double>(ours) / static_cast<double>(rays.size());
  return result;
}

/// What borders cost: the same rays against discs that end and against whole ones, eye rays and bounced ones.
nlohmann::json measure_borders(Tracer& ending, Tracer& whole, const std::vector<RayQuery>& coherent,
                               const std::vector<RayQuery>& bounced, int pairs) {
  const std::vector<RayPacketQuery> as_packets = packets_of(coherent);
  const auto packets = ending.session.upload(as_packets);
  const auto packet_answers = ending.session.allocate<RayPacketAnswer>(as_packets.size());
  const auto rays = ending.session.upload(coherent), others = ending.session.upload(bounced);
  const auto answers = ending.session.allocate<RayAnswer>(std::max(coherent.size(), bounced.size()));
  const auto trace = [&](Tracer& tracer, bool eye) {
    if (!eye)
      tracer.closest(others, answers);
    else if (tracer.variant.grouping == RayGrouping::packet)
      tracer.packets(packets, packet_answers);
    else
      tracer.closest(rays, answers);
  };
  nlohmann::json row;
  for (const bool eye : {true, false}) {
    trace(ending, eye); // warm
    trace(whole, eye);
    std::vector<double> ratios;
    for (int k = 0; k < pairs; ++k) {
      const double with = warm_seconds_of([&] { trace(ending, eye); });
      ratios.push_back(with / warm_seconds_of([&] { trace(whole, eye); }));
    }
    std::printf("  borders    %s rays take %.3f of the time that whole discs take\n", eye ? "eye" : "bounced",
                median_of_repeats(ratios));
    row[eye ? "coherent" : "incoherent"] = median_of_repeats(ratios);
  }
  return row;
}

nlohmann::json measure(Session& session, const std::string& name, const WorldSplats& world, Scene scene, int pairs) {
  scene.render.width = scene.render.height = image;
  if (!scene.camera.chosen) choose_camera(scene, world);
  const Frame frame = frame_of(world.cloud);
  const std::vector<Splat> splats = place_in_cube(world, frame);
  std::vector<std::uint32_t> id(splats.size());
  std::iota(id.begin(), id.end(), 0u);
  const SplatClips clips = clips_in_cube(world, frame, splats, id);
  const TraversalVariant variant = choose_variant(scene.traversal, scene.octree, session.info()).variant;
  const Pairs build = measure_build(splats, variant, pairs);
  const OctreePools pools = build_pools(splats, variant); // Embree has no borders: both trace whole discs
  Tracer tracer{session, upload_pools(session, pools, variant.storage), variant};
  const EmbreePeer peer(splats);
  const std::vector<RayQuery> coherent = eye_rays(device_camera(scene, frame), {0, image, 0, image}),
                              bounced = bounced_rays(splats, 1'000'000, 7);
  double hit_share = 0.0;
  const Pairs coherent_pairs = measure_coherent(tracer, peer, coherent, pairs, hit_share);
  const auto [closest, any] = measure_incoherent(tracer, peer, bounced, pairs);
  const std::vector<RayQuery> shadow =
      shadow_rays(coherent, tracer.nearest(coherent), points_of(pools), lamp_over(splats));
  const ShadowPairs shadowed = shadow.empty() ? ShadowPairs{} : measure_shadow(tracer, peer, shadow, pairs);
  const OctreeSummary octree = summary_of(pools);
  const double bytes = static_cast<double>(octree.bytes) / static_cast<double>(splats.size());
  std::printf("%s, %zu splats, form %s, %.0f bytes a splat; %.0f %% of the eye rays hit\n", name.c_str(), splats.size(),
              octree.form, bytes, 100.0 * hit_share);
  nlohmann::json row{{"name", name},
                     {"splats", splats.size()},
                     {"form", octree.form},
                     {"bytes_per_splat", bytes},
                     {"hit_share", hit_share}};
  row["coherent"] = report_rays("coherent", coherent_pairs, coherent.size());
  row["incoherent"] = report_rays("incoherent", closest, bounced.size());
  row["any-hit"] = report_rays("any-hit", any, bounced.size());
  if (shadow.empty()) {
    std::printf("  no square of 2 x 2 pixels is covered and faces the lamp: no shadow rays\n");
  } else {
    row["shadow"] = report_rays("shadow", shadowed.pairs, shadow.size());
    row["shadow"]["blocked_share"] = shadowed.blocked_share;
    row["shadow"]["embree"] = shadowed.peer;
    std::printf("  %.0f %% of %zu shadow rays are blocked; Embree's best are %s\n", 100.0 * shadowed.blocked_share,
                shadow.size(), shadowed.peer);
  }
  if (!clips.empty()) {
    TraversalVariant clipped = variant;
    clipped.clips = true;
    Tracer ending{session, upload_pools(session, build_pools(splats, clipped, clips), variant.storage), clipped};
    std::printf("  borders    %.0f %% of the splats end at one\n",
                100.0 * static_cast<double>(clips.size()) / static_cast<double>(splats.size()));
    row["borders"] = measure_borders(ending, tracer, coherent, bounced, pairs);
    row["borders"]["share"] = static_cast<double>(clips.size()) / static_cast<double>(splats.size());
  }
  const double share = 1.0 / build.ratio();
  row["build"] = {{"seconds", median_of_repeats(build.ours)},
                  {"embree_seconds", median_of_repeats(build.theirs)},
                  {"ratio", share}};
  std::printf("  %-10s %7.3f s         Embree %7.3f   ratio %.2f\n", "build", median_of_repeats(build.ours),
              median_of_repeats(build.theirs), share);
  std::fflush(stdout);
  return row;
}

/// The rows as a table for the README: ours, Embree's, and how many times as fast ours is.
std::string markdown_of(const nlohmann::json& rows) {
  std::string text =
      "| splats | eye rays | bounced rays | any hit | build | bytes a splat |\n|---|---|---|---|---|---|\n";
  char cell[200];
  for (const auto& row : rows) {
    std::snprintf(cell, sizeof cell, "| %s, %.0fk |", row["name"].get<std::string>().c_str(),
                  1e-3 * row["splats"].get<double>());
    text += cell;
    for (const char* kind : {"coherent", "incoherent", "any-hit"}) {
      const auto& k = row[kind];
      std::snprintf(cell, sizeof cell, " %.1f against %.1f: **%.1f x** |", k["mrays_per_s"].get<double>(),
                    k["embree_mrays_per_s"].get<double>(), k["ratio"].get<double>());
      text += cell;
    }
    const auto& build = row["build"];
    std::snprintf(cell, sizeof cell, " %.3f s against %.3f: **%.2f of the time** | %.0f |\n",
                  build["seconds"].get<double>(), build["embree_seconds"].get<double>(), build["ratio"].get<double>(),
                  row["bytes_per_splat"].get<double>());
    text += cell;
  }
  return text;
}

/// The blob from close by, looking down on it: it and the floor fill the picture, a strip of sky stays.
Scene blob_view() {
  Scene scene;
  scene.up = UpAxis::z;
  scene.camera.position = {0.0, -4.5, 1.0};
  scene.camera.look_at = {0.0, 0.0, -0.125};
  scene.camera.fov_deg = 47.2;
  scene.camera.chosen = true;
  return scene;
}

} // namespace

int main(int argc, char** argv) {
  CLI::App app{"Rays through the octree against Embree"};
  std::string json_file, markdown_file, form_name = "auto", clock_name = "wall";
  std::vector<std::size_t> sizes;
  std::vector<std::string> clouds;
  int pairs = 5;
  app.add_option("--json", json_file, "write the figures to this file");
  app.add_option("--markdown", markdown_file, "write them to this file as a table, Mrays/s ours against Embree's");
  app.add_option("--splats", sizes, "sizes of the synthetic blob")->delimiter(',')->allow_extra_args(false);
  app.add_option("--pairs", pairs, "measurements of each side")->check(CLI::Range(1, 1000));
  app.add_option("--form", form_name, "auto, step or wide")->check(CLI::IsMember({"auto", "step", "wide"}));
  app.add_option("--clock", clock_name, "wall, or cpu: seconds computed by all threads")
      ->check(CLI::IsMember({"wall", "cpu"}));
  app.add_option("CLOUD.ply", clouds, "scans to measure");
  CLI11_PARSE(app, argc, argv);
  if (sizes.empty() && clouds.empty()) sizes = {50'000, 500'000, 2'000'000};
  const auto with_form = [&](Scene scene) {
    if (form_name != "auto") scene.traversal.form = form_name == "step" ? TraversalForm::step : TraversalForm::wide;
    return scene;
  };
  clock_id = clock_name == "cpu" ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC;
  spdlog::set_level(spdlog::level::warn);
  try {
    Session session(choose_device(""));
    std::printf("device: %s (%s)\n", session.info().name.c_str(), session.info().platform.c_str());
    nlohmann::json rows = nlohmann::json::array();
    for (const std::size_t n : sizes) {
      WorldSplats world;
      world.cloud = synthetic_blob(n);
      world.material.assign(world.cloud.size(), 0);
      rows.push_back(measure(session, "blob", world, with_form(blob_view()), pairs));
    }
    const Scene default_view;
    for (const std::string& cloud : clouds)
      rows.push_back(measure(session, std::filesystem::path(cloud).stem().string(), load_splats(load_bare_cloud(cloud)),
                             with_form(default_view), pairs));
    if (!json_file.empty())
      std::ofstream(json_file) << nlohmann::json{{"device", session.info().name},
                                                 {"clock", clock_name},
                                                 {"pairs", pairs},
                                                 {"rows", rows}}
                                      .dump(1)
                               << "\n";
    if (!markdown_file.empty()) std::ofstream(markdown_file) << markdown_of(rows);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
