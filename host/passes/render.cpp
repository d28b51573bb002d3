#include "host/passes/render.h"
#include <algorithm>
#include <cstring>

namespace pointgi {

namespace {

/// Rows of a band: enough for the EXR's blocks of 16, few enough that a picture 65536 wide stays small in memory.
constexpr int band_rows = 16;
/// A launch aims at this many seconds: short for a watchdog or a Ctrl-C, long against the cost of launching.
constexpr double launch_seconds = 0.1;

enum Channel {
  c_r,
  c_g,
  c_b,
  c_a,
  c_direct_r,
  c_direct_g,
  c_direct_b,
  c_albedo_r,
  c_albedo_g,
  c_albedo_b,
  c_nx,
  c_ny,
  c_nz,
  c_px,
  c_py,
  c_pz,
  c_z,
  c_id,
  channel_count
};

/// Film sums of one pixel into the band's planes: means, world units, world radiance.
void resolve_pixel(const float* film, const RenderRequest& request, float samples, std::size_t at, Band& band) {
  const auto set = [&](int channel, double value) { band.values[channel][at] = static_cast<float>(value); };
  const double scale = request.lighting.radiance.scale;
  for (int k = 0; k < 3; ++k) {
    const double direct = scale * (film[FILM_DIRECT + k] / samples);
    set(c_r + k, direct);
    set(c_direct_r + k, direct);
  }
  const float hits = film[FILM_COVERAGE];
  set(c_a, hits / samples);
  std::uint32_t point;
  std::memcpy(&point, &film[FILM_POINT], sizeof point);
  const std::uint32_t id = point == FILM_NO_POINT ? FILM_NO_POINT : request.point_ids[point];
  std::memcpy(&band.values[c_id][at], &id, sizeof id);
  if (hits <= 0.0f) {
    set(c_z, INFINITY);
    return;
  }
  for (int k = 0; k < 3; ++k)
    set(c_albedo_r + k, film[FILM_ALBEDO + k] / hits);
  Eigen::Vector3f normal(film[FILM_NORMAL], film[FILM_NORMAL + 1], film[FILM_NORMAL + 2]);
  if (normal.squaredNorm() > 0.0f) normal.normalize();
  const Vector3d position = request.frame.to_world(
      Eigen::Vector3f(film[FILM_POSITION], film[FILM_POSITION + 1], film[FILM_POSITION + 2]) / hits);
  for (int k = 0; k < 3; ++k) {
    set(c_nx + k, normal[k]);
    set(c_px + k, position[k]);
  }
  set(c_z, request.frame.side * (film[FILM_DEPTH] / hits));
}

} // namespace

std::vector<ChannelName> film_channels() {
  std::vector<ChannelName> names;
  for (const char* name : {"R", "G", "B", "A", "Direct.R", "Direct.G", "Direct.B", "Albedo.R", "Albedo.G", "Albedo.B",
                           "N.X", "N.Y", "N.Z", "P.X", "P.Y", "P.Z", "Z"})
    names.push_back({name, false});
  names.push_back({"PointId", true});
  return names;
}

RenderTotals render(Session& session, const DevicePools& pools, const RenderRequest& request,
                    const std::function<void(const Band&)>& take, const std::function<void(double)>& progress,
                    const std::function<bool()>& stop) {
  const DeviceLighting& lighting = request.lighting;
  RenderParams params = lighting.params;
  params.step_delta = static_cast<float>(request.variant.step_delta / request.frame.side);
  const SceneFeatures features{!lighting.delta.empty(), !lighting.emitters.empty(), lighting.has_environment};
  cl::Kernel kernel = session.kernel("render/render.cl", build_options(request.variant, features), "render_pixels");
  const auto device_params = session.upload(&params, 1);
  const auto materials = session.upload(lighting.materials);
  const auto delta = session.upload(lighting.delta);
  const auto emitters = session.upload(lighting.emitters);

  const int width = request.window.x1 - request.window.x0, height = request.window.y1 - request.window.y0;
  const auto samples = static_cast<float>(params.samples);
  RenderTotals totals;
  int columns = std::min(width, 64); // of a launch; grows or shrinks towards launch_seconds
  Buffer<float> film;
  for (int row = 0; row < height; row += band_rows) {
    const int rows = std::min(band_rows, height - row);
    Band band{
        request.window.y0 + row, rows, width,
        std::vector<std::vector<float>>(channel_count, std::vector<float>(static_cast<std::size_t>(width) * rows))};
    for (int column = 0; column < width;) {
      if (stop()) {
        totals.interrupted = true;
        return totals;
      }
      const int launched = std::min(columns, width - column);
      const std::size_t pixels = static_cast<std::size_t>(launched) * rows;
      if (film.size < pixels * FILM_CHANNELS) film = session.allocate<float>(pixels * FILM_CHANNELS);
      const LaunchShape shape{{static_cast<std::size_t>(launched) * GRID_X, static_cast<std::size_t>(rows) * GRID_Y},
                              {GRID_X, GRID_Y}};
      const double seconds = session.launch(
          kernel, shape, pools.nodes, pools.leaves, pools.points, device_params, materials, delta, emitters, film,
          static_cast<cl_uint>(request.window.x0 + column), static_cast<cl_uint>(request.window.y0 + row));
      totals.device_seconds += seconds;
      const std::vector<float> sums = session.download(film, pixels * FILM_CHANNELS);
      for (int y = 0; y < rows; ++y)
        for (int x = 0; x < launched; ++x) {
          const float* pixel = &sums[(static_cast<std::size_t>(y) * launched + x) * FILM_CHANNELS];
          resolve_pixel(pixel, request, samples, static_cast<std::size_t>(y) * width + column + x, band);
          totals.rays += static_cast<std::uint64_t>(pixel[FILM_RAYS]);
          totals.eye_rays_on_splats += static_cast<std::uint64_t>(pixel[FILM_COVERAGE]);
          totals.eye_rays_on_back_faces += static_cast<std::uint64_t>(pixel[FILM_BACK_FACE]);
        }
      totals.eye_rays += pixels * params.samples;
      column += launched;
      progress((static_cast<double>(row) * width + static_cast<double>(column) * rows) /
               (static_cast<double>(width) * height));
      columns = seconds < 0.5 * launch_seconds   ? std::min(columns * 2, 4096)
                : seconds > 2.0 * launch_seconds ? std::max(columns / 2, 8)
                                                 : columns;
    }
    take(band);
    totals.rows_done = row + rows;
  }
  return totals;
}

} // namespace pointgi
