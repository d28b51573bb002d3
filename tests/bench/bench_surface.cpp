/// Frames a second of scans as patches and as discs, and of Embree's rays through the same discs: the table of Min and
/// Kim's "Real-time Global Illumination for Point Set using GPUs" (method.md §8). A frame has a ray a pixel, Phong
/// shading with one lamp's shadows, and reflections to the second bounce. Sides take turns, medians of the rounds.
///   bench_surface [--markdown FILE] [--rounds K] [--size WxH,…] CLOUD.ply …
#include "host/passes/ray_packets.h"
#include "host/render/render.h"
#include "host/repeats.h"
#include "host/stages/light_stages.h"
#include "host/stages/prepared_scene.h"
#include "host/tune/profile.h"
#include "tests/bench/embree_peer.h"
#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <spdlog/spdlog.h>
#include <unistd.h>

namespace {

using namespace pointgi;
using namespace pointgi::bench;

template <typename Work>
double seconds_of(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

Scene scene_of(const std::string& cloud, SurfaceForm surface, int width, int height) {
  // Named after the process, for two may run at once.
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("bench_surface_" + std::to_string(::getpid()) + ".toml");
  std::ofstream(file) << "version = 1\n[render]\nsize = [" << width << ", " << height
                      << "]\nspp = 1\njitter = false\nmax_depth = 2\n[radiosity]\nmethod = \"none\"\n[caustics]\n"
                      << "photons = 0\n[traversal]\ngrouping = \"ray\"\nsurface = \"" << name_of(surface)
                      << "\"\n[[material]]\nname = \"m\"\ntype = \"phong\"\nalbedo = [0.6, 0.6, 0.6]\n"
                      << "specular = [0.3, 0.3, 0.3]\nexponent = 200\n[[light]]\ntype = \"directional\"\n"
                      << "direction = [-1, -1, -1]\nirradiance = [3, 3, 3]\n[[cloud]]\nfile = \""
                      << std::filesystem::absolute(cloud).string() << "\"\nmaterial = \"m\"\n";
  Scene scene = load_scene(file.string());
  std::filesystem::remove(file);
  return scene;
}

/// A scene on the device, ready to be rendered again and again.
class Frames {
public:
  Frames(Session& session, const std::string& cloud, SurfaceForm surface, int width, int height)
      : session_(session), scene_(scene_of(cloud, surface, width, height)),
        ready_(prepare_scene(session, scene_, false, stages_)) {
    const IndirectRequest wanted{ready_.choice.variant, scene_, ready_.frame, ready_.lighting, ready_.points, false};
    light_ = run_light_stages(session, ready_.on_device, wanted, stages_);
  }

  double seconds() {
    RenderRequest request{{0, scene_.render.width, 0, scene_.render.height},
                          ready_.lighting,
                          ready_.frame,
                          ready_.ids,
                          ready_.choice.variant,
                          {}};
    request.normal_field = light_.normal_field ? &*light_.normal_field : nullptr;
    return seconds_of([&] {
      render(
          session_, ready_.on_device, request, [](const Band&) {}, [](double) {}, [] { return false; });
    });
  }
  const PreparedScene& ready() const { return ready_; }
  const Scene& scene() const { return scene_; }

private:
  Session& session_;
  StageLog stages_;
  Scene scene_;
  PreparedScene ready_;
  SceneLight light_;
};

using Vector = Eigen::Vector3f;

RayQuery ray_from(const Vector& origin, const Vector& direction, float t_min) {
  RayQuery ray{};
  std::copy_n(origin.data(), 3, ray.origin);
  std::copy_n(direction.data(), 3, ray.direction);
  ray.t_min = t_min;
  ray.t_max = 8.0f;
  return ray;
}

/// Embree's part of a frame: hits of the eye rays, then of what they mirror, and a shadow ray off each.
class EmbreeFrames {
public:
  explicit EmbreeFrames(const Frames& of)
      : points_(of.ready().points.begin(), of.ready().points.end()), peer_(points_) {
    const Camera camera = of.ready().lighting.params.camera;
    const auto vector = [](const float v[3]) { return Vector(v[0], v[1], v[2]); };
    const int width = of.scene().render.width, height = of.scene().render.height;
    constexpr int columns = 16, rows = 8; // a packet's rays close together
    for (int y = 0; y < height; y += rows)
      for (int x = 0; x < width; x += columns)
        for (int k = 0; k < columns * rows; ++k) {
          const float u = static_cast<float>(std::min(x + k % columns, width - 1)) + 0.5f;
          const float v = static_cast<float>(std::min(y + k / columns, height - 1)) + 0.5f;
          eye_.push_back(ray_from(
              vector(camera.origin),
              (vector(camera.corner) + u * vector(camera.step_x) + v * vector(camera.step_y)).normalized(), 0.0f));
        }
    packets_ = packets_of(eye_);
    answers_.resize(eye_.size());
    packet_answers_.resize(packets_.size());
    peer_.closest_single(eye_, answers_);
    mirrored_ = leave(eye_, answers_, shadows_);
    mirrored_answers_.resize(mirrored_.size());
    peer_.closest_single(mirrored_, mirrored_answers_);
    leave(mirrored_, mirrored_answers_, shadows_);
  }

  double seconds() {
    const double eye = std::min(seconds_of([&] { peer_.closest_single(eye_, answers_); }),
                                seconds_of([&] { peer_.closest_packet16(packets_, packet_answers_); }));
    return eye + seconds_of([&] {
             peer_.closest_single(mirrored_, mirrored_answers_);
             peer_.any_single(shadows_);
           });
  }

private:
  /// The mirrored ray of each hit; adds its shadow ray.
  std::vector<RayQuery> leave(const std::vector<RayQuery>& rays, const std::vector<RayAnswer>& answers,
                              std::vector<RayQuery>& shadows) const {
    std::vector<RayQuery> mirrored;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (answers[i].splat == NO_SPLAT) continue;
      const Splat& splat = points_[answers[i].splat];
      const Vector d = Vector::Map(rays[i].direction), n = Vector::Map(splat.normal);
      const Vector place = Vector::Map(rays[i].origin) + answers[i].t * d;
      const float apart = SELF_HIT_REACH * 2.0f * splat.radius; // so that no ray ends at its own surface's discs
      mirrored.push_back(ray_from(place, d - 2.0f * d.dot(n) * n, apart));
      shadows.push_back(ray_from(place, Vector(1, 1, 1).normalized(), apart));
    }
    return mirrored;
  }

  std::vector<Splat> points_;
  EmbreePeer peer_;
  std::vector<RayQuery> eye_, mirrored_, shadows_;
  std::vector<RayPacketQuery> packets_;
  std::vector<RayAnswer> answers_, mirrored_answers_;
  std::vector<RayPacketAnswer> packet_answers_;
};

struct Size {
  int width, height;
};

/// One row of the table.
std::string measure(Session& session, const std::string& cloud, Size size, int rounds) {
  Frames patches(session, cloud, SurfaceForm::mls, size.width, size.height);
  Frames discs(session, cloud, SurfaceForm::discs, size.width, size.height);
  EmbreeFrames embree(discs);
  patches.seconds(); // builds and warms
  discs.seconds();
  std::vector<double> of_patches, of_discs, of_embree, ratios;
  for (int k = 0; k < rounds; ++k) {
    of_patches.push_back(patches.seconds());
    of_discs.push_back(discs.seconds());
    of_embree.push_back(embree.seconds());
    ratios.push_back(of_embree.back() / of_patches.back());
  }
  char row[200];
  std::snprintf(row, sizeof row, "| %s, %zu | %dx%d | %.2f | %.2f | %.2f | %.2f |\n",
                std::filesystem::path(cloud).stem().c_str(), discs.ready().points.size(), size.width, size.height,
                1.0 / median_of_repeats(of_patches), 1.0 / median_of_repeats(of_discs),
                1.0 / median_of_repeats(of_embree), median_of_repeats(ratios));
  std::printf("%s", row);
  std::fflush(stdout);
  return row;
}

} // namespace

int main(int argc, char** argv) {
  CLI::App app{"Frames a second of patches, discs, and Embree's discs"};
  std::string markdown_file;
  std::vector<std::string> clouds, size_words{"640x640", "1858x1057"};
  int rounds = 5;
  app.add_option("--markdown", markdown_file, "write the table to this file");
  app.add_option("--rounds", rounds, "frames of each side")->check(CLI::Range(1, 1000));
  app.add_option("--size", size_words, "pictures' sizes")->delimiter(',')->allow_extra_args(false);
  app.add_option("CLOUD.ply", clouds, "scans to measure")->required();
  CLI11_PARSE(app, argc, argv);
  spdlog::set_level(spdlog::level::warn);
  try {
    Session session(choose_device(""));
    std::printf("device: %s (%s)\n", session.info().name.c_str(), session.info().platform.c_str());
    std::string table =
        "| scan, splats | size | `\"mls\"`, frames/s | `\"discs\"`, frames/s | Embree's rays, frames/s | "
        "`\"mls\"` over Embree |\n|---|---|---|---|---|---|\n";
    std::printf("%s", table.c_str());
    for (const std::string& cloud : clouds)
      for (const std::string& word : size_words) {
        Size size{};
        if (std::sscanf(word.c_str(), "%dx%d", &size.width, &size.height) != 2)
          throw std::runtime_error("--size: expected sizes such as 640x640, found " + word);
        table += measure(session, cloud, size, rounds);
      }
    if (!markdown_file.empty()) std::ofstream(markdown_file) << table;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
