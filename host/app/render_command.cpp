#include "host/app/commands.h"
#include "host/app/interrupt.h"
#include "host/app/light_stages.h"
#include "host/app/output_files.h"
#include "host/app/prepared_scene.h"
#include "host/app/progress.h"
#include "host/app/stats.h"
#include "host/app/view_warnings.h"
#include "host/cache/binary_cache.h"
#include "host/tune/self_test.h"
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <spdlog/spdlog.h>

namespace pointgi {

namespace {

/// Exactly `count` whole numbers separated by `separator`, or an Error(usage) that shows how it is written.
std::vector<int> whole_numbers(const std::string& text, char separator, std::size_t count, const std::string& form) {
  std::vector<int> numbers;
  std::size_t at = 0;
  while (at <= text.size()) {
    const std::size_t end = std::min(text.find(separator, at), text.size());
    const std::string part = text.substr(at, end - at);
    if (part.empty() || part.size() > 9 || part.find_first_not_of("0123456789") != std::string::npos) break;
    numbers.push_back(std::stoi(part));
    at = end + 1;
  }
  if (numbers.size() != count || at <= text.size()) throw Error(ErrorKind::usage, form + ", found \"" + text + "\"");
  return numbers;
}

/// Flags win over the scene file; they become overrides, so that one place checks both.
std::vector<std::string> all_overrides_of(const RenderOptions& options) {
  std::vector<std::string> overrides = overrides_of(options);
  if (!options.size.empty()) {
    const auto size = whole_numbers(options.size, 'x', 2, "--size: expected WIDTHxHEIGHT, for example 640x480");
    if (size[0] < 1 || size[1] < 1)
      throw Error(ErrorKind::usage,
                  "--size: expected a width and height of at least 1, found \"" + options.size + "\"");
    overrides.push_back("render.size=[" + std::to_string(size[0]) + ", " + std::to_string(size[1]) + "]");
  }
  if (options.spp) overrides.push_back("render.spp=" + std::to_string(*options.spp));
  return overrides;
}

PixelWindow window_of(const RenderOptions& options, const RenderSettings& render) {
  if (options.pixel_bounds.empty()) return {0, render.width, 0, render.height};
  const std::string form = "--pixelbounds: expected x0,x1,y0,y1 with 0 <= x0 < x1 <= " + std::to_string(render.width) +
                           " and 0 <= y0 < y1 <= " + std::to_string(render.height);
  const auto b = whole_numbers(options.pixel_bounds, ',', 4, form);
  if (b[0] >= b[1] || b[1] > render.width || b[2] >= b[3] || b[3] > render.height)
    throw Error(ErrorKind::usage, form + ", found \"" + options.pixel_bounds + "\"");
  return {b[0], b[1], b[2], b[3]};
}

std::string output_of(const RenderOptions& options) {
  return options.output.empty() ? std::filesystem::path(options.input).stem().string() + ".exr" : options.output;
}

/// The paths to trace, or nothing where no path is traced.
std::optional<LightPaths> paths_of(const RenderOptions& options, const Scene& scene) {
  if (options.integrator != "path") return std::nullopt;
  return light_paths(options.paths, scene.render.max_depth);
}

PictureAttributes attributes_of(const Scene& scene, const RenderOptions& options, const Session& session,
                                std::uint64_t scene_hash) {
  PictureAttributes attributes;
  char hash[17];
  std::snprintf(hash, sizeof hash, "%016llx", static_cast<unsigned long long>(scene_hash));
  attributes.text["software"] = "pointgi " POINTGI_VERSION;
  attributes.text["pointgi/device"] = session.info().name + " (" + session.info().platform + ")";
  attributes.text["pointgi/scene_hash"] = hash;
  attributes.text["pointgi/quality"] = options.quality;
  attributes.text["pointgi/integrator"] = options.integrator;
  if (!options.paths.empty()) attributes.text["pointgi/paths"] = options.paths;
  attributes.number["samplesPerPixel"] = scene.render.spp;
  attributes.world_to_camera = world_to_camera(scene);
  attributes.world_to_ndc = world_to_ndc(scene);
  return attributes;
}

/// What the picture depends on: splats, lights, camera and samples, as the device reads them.
std::uint64_t hash_of(const OctreePools& pools, const DeviceLighting& lighting) {
  const auto bytes = [](const auto& v) {
    return std::string_view(reinterpret_cast<const char*>(v.data()), v.size() * sizeof(v[0]));
  };
  std::uint64_t hash = fnv1a(bytes(points_of(pools)));
  hash = fnv1a(bytes(lighting.delta), hash);
  hash = fnv1a(bytes(lighting.materials), hash);
  return fnv1a(std::string_view(reinterpret_cast<const char*>(&lighting.params), sizeof lighting.params), hash);
}

Scene checked_scene(const RenderOptions& options) {
  if (options.integrator != "path" && !options.paths.empty())
    throw Error(ErrorKind::usage, "--paths: only --integrator path can choose the light paths that count");
  light_paths(options.paths, {}); // before a large scene is read
  Scene scene = load_any(options.input, all_overrides_of(options));
  apply_quality(options.quality, scene, options.spp.has_value());
  if (options.integrator != "path") require_possible_radiosity(scene);
  // Before the work, not after it.
  const bool unnamed = options.output.empty();
  require_outputs(options.input, scene,
                  {{"-o", output_of(options), unnamed},
                   {"-o", png_path_of(output_of(options)), unnamed},
                   {"--stats", options.stats_file},
                   {"--trace", options.trace_file}});
  return scene;
}

/// Seconds of the device in all stages.
double kernel_seconds(const Session& session) {
  double seconds = 0.0;
  for (const auto& [name, time] : session.kernel_times())
    seconds += time.seconds;
  return seconds;
}

/// Renders and writes the picture; false when it was interrupted before a row was finished, which leaves an older
/// picture alone.
bool render_picture(Session& session, const DevicePools& pools, const RenderRequest& request, PictureWriter& writer,
                    bool quiet, RenderTotals& totals, StageLog& stages) {
  stages.start("render");
  {
    Progress progress("render", quiet);
    totals = render(
        session, pools, request, [&](const Band& band) { writer.write(band); },
        [&](double share) { progress.update(share); }, interrupted);
  }
  stages.finish(totals.rays, "rays", totals.device_seconds);
  for (const auto& [name, time] : session.kernel_times())
    spdlog::debug("kernel {}: {} launches, {:.3f} s", name, time.launches, time.seconds);
  if (totals.interrupted && totals.rows_done == 0) return false;
  const double render_seconds = stages.records().back().seconds;
  stages.start("image");
  writer.finish(render_seconds);
  const PixelWindow& w = request.window;
  stages.finish(static_cast<std::uint64_t>(w.x1 - w.x0) * (w.y1 - w.y0), "pixels");
  return true;
}

} // namespace

ExitCode run_render(const RenderOptions& options) {
  StageLog stages;
  Stats stats;
  stages.start("scene");
  Scene scene = checked_scene(options);
  const PixelWindow window = window_of(options, scene.render);
  stages.finish(scene.clouds.size() + scene.shapes.size(), "objects");

  Session session(choose_tested_device(options.device));
  session.dump_kernels_to(options.dump_folder);
  if (!options.trace_file.empty()) session.record_launches();
  spdlog::info("device: {} ({}, driver {})", session.info().name, session.info().platform, session.info().driver);

  const PreparedScene ready = prepare_scene(session, scene, !is_scene_file(options.input), stages);
  const TraversalVariant& variant = ready.choice.variant;
  const OctreePools& pools = ready.pools;
  const DeviceLighting& lighting = ready.lighting;
  stats.octree = summary_of(pools);
  const std::optional<LightPaths> paths = paths_of(options, scene);
  bool told_of_black = paths && warn_of_paths(options.paths, scene, ready);
  catch_interrupts();
  const IndirectRequest wanted{variant,           scene,         ready.frame, lighting, points_of(pools),
                               paths.has_value(), options.quiet, interrupted};
  const SceneLight light = run_light_stages(session, ready.on_device, wanted, stages);
  told_of_black = told_of_black || warn_of_unlit(scene, ready, light.indirect.direct, light.indirect.from_surfaces);
  RenderRequest request{window, lighting, ready.frame, ready.ids, variant, paths};
  request.first_ids = ready.first_ids;
  Buffer<cl_float4> irradiance;
  if (!light.indirect.from_surfaces.empty()) {
    irradiance = upload_irradiance(session, light.indirect, scene);
    request.irradiance = &irradiance;
    request.shadow_rays = !direct_light_by_radiosity(scene);
  }
  request.normal_field = light.normal_field ? &*light.normal_field : nullptr;
  request.photons = light.photons ? &*light.photons : nullptr;
  PictureWriter writer(output_of(options), scene.render.width, scene.render.height, window,
                       film_channels(request.has_indirect(), request.has_specular(), request.has_caustics()),
                       attributes_of(scene, options, session, hash_of(pools, lighting)), scene.render.exposure);
  const bool written = render_picture(session, ready.on_device, request, writer, options.quiet, stats.render, stages);
  if (!written)
    throw Error(ErrorKind::interrupted, "interrupted before the first rows were finished; nothing was written");
  warn_of_view(stats.render, scene, ready, told_of_black);
  if (!options.stats_file.empty()) {
    stats.command = "render";
    stats.integrator = options.integrator;
    stats.variant = ready.choice;
    stats.scene = &scene;
    stats.session = &session;
    stats.indirect = &light.indirect;
    stats.photons = light.ledger;
    stats.photon_watts = lighting.radiance.scale * ready.frame.side * ready.frame.side;
    stats.seconds = stages.seconds();
    write_stats(options.stats_file, stats, stages);
  }
  if (!options.trace_file.empty()) write_text(options.trace_file, stages.chrome_trace(session.launches()));
  std::printf("%s\n%s\n", writer.exr_path().c_str(), writer.png_path().c_str());
  if (stats.render.interrupted) {
    spdlog::warn("interrupted: the picture holds its first {} of {} rows", stats.render.rows_done,
                 window.y1 - window.y0);
    return ExitCode::interrupted;
  }
  spdlog::info("{} splats, {:.1f} million rays, {} ({} of kernels on the device)", stats.octree.points,
               1e-6 * static_cast<double>(stats.render.rays), duration_text(stages.seconds()),
               duration_text(kernel_seconds(session)));
  return ExitCode::done;
}

} // namespace pointgi
