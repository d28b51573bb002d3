#include "host/render/resolve.h"
#include "host/render/tile_renderer.h"
#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstring>

namespace pointgi {

namespace {

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
  c_variance_r,
  c_variance_g,
  c_variance_b,
  c_id,
  c_first_optional ///< Diffuse, Specular, Caustic, three each, as many of them as there are, then what guides a
                   ///< denoiser
};

/// Variance of the mean of `samples` radiances: that of one, by their squared differences from the mean, over their
/// number. Of one sample nothing is known.
double variance_of_mean(double spread, double samples) {
  return samples > 1.0 ? std::min(spread / (samples * (samples - 1.0)), double{FLT_MAX}) : INFINITY;
}

/// Film sums of one pixel into the band's planes: means, world units, world radiance.
void resolve_pixel(const float* film, const RenderRequest& request, float samples, std::size_t at, Band& band) {
  const auto set = [&](int channel, double value) { band.values[channel][at] = static_cast<float>(value); };
  const double scale = request.lighting.radiance.scale;
  for (int k = 0; k < 3; ++k) {
    const double direct = scale * (film[FILM_DIRECT + k] / samples);
    double all = direct;
    int channel = c_first_optional + k;
    const auto add = [&](bool is_there, int of_film) {
      if (!is_there) return;
      const double light = scale * (film[of_film + k] / samples);
      set(channel, light);
      all += light;
      channel += 3;
    };
    add(request.has_indirect(), FILM_DIFFUSE);
    add(request.has_specular(), FILM_SPECULAR);
    add(request.has_caustics(), FILM_CAUSTIC);
    set(c_r + k, all);
    set(c_direct_r + k, direct);
    set(c_variance_r + k, variance_of_mean(scale * scale * double{film[FILM_SPREAD + k]}, samples));
  }
  if (request.auxiliary) {
    const std::size_t first = band.values.size() - AUXILIARY_CHANNELS; // behind all others, in the film's order
    const float* sums = film + film_scalars(request.has_specular(), request.has_caustics(), false);
    for (int k = 0; k < AUXILIARY_CHANNELS; ++k)
      set(static_cast<int>(first) + k, (k < AUXILIARY_EMISSION ? 1.0 : scale) * (sums[k] / samples));
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

std::vector<ChannelName> film_channels(bool indirect, bool specular, bool caustic, bool auxiliary) {
  std::vector<ChannelName> names;
  for (const char* name :
       {"R",   "G",   "B",   "A",   "Direct.R", "Direct.G", "Direct.B", "Albedo.R",   "Albedo.G",   "Albedo.B",
        "N.X", "N.Y", "N.Z", "P.X", "P.Y",      "P.Z",      "Z",        "Variance.R", "Variance.G", "Variance.B"})
    names.push_back({name, false});
  names.push_back({"PointId", true});
  for (const char* name : {"Diffuse.R", "Diffuse.G", "Diffuse.B"})
    if (indirect) names.push_back({name, false});
  for (const char* name : {"Specular.R", "Specular.G", "Specular.B"})
    if (specular) names.push_back({name, false});
  for (const char* name : {"Caustic.R", "Caustic.G", "Caustic.B"})
    if (caustic) names.push_back({name, false});
  for (const char* name : {"Denoise.Albedo.R", "Denoise.Albedo.G", "Denoise.Albedo.B", "Denoise.N.X", "Denoise.N.Y",
                           "Denoise.N.Z", "Denoise.Emission.R", "Denoise.Emission.G", "Denoise.Emission.B"})
    if (auxiliary) names.push_back({name, false});
  return names;
}

namespace {

void count_for_object(const float* film, const RenderRequest& request, RenderTotals& totals) {
  std::uint32_t point;
  std::memcpy(&point, &film[FILM_POINT], sizeof point);
  if (point == FILM_NO_POINT || request.first_ids.size == 0) return;
  const auto* after = std::upper_bound(request.first_ids.begin(), request.first_ids.end(), request.point_ids[point]);
  ObjectRays& rays = totals.of_object[static_cast<std::size_t>(after - request.first_ids.begin()) - 1];
  rays.on_splats += static_cast<std::uint64_t>(film[FILM_COVERAGE]);
  rays.on_backs += static_cast<std::uint64_t>(film[FILM_BACK_FACE]);
}

} // namespace

bool is_lit(const Band& band) {
  return std::any_of(band.values.begin() + c_r, band.values.begin() + c_a, [](const std::vector<float>& colour) {
    return std::any_of(colour.begin(), colour.end(), [](float value) { return value > 0.0f; });
  });
}

void resolve_tile(const float* film, std::size_t film_channels, int column, int columns, const RenderRequest& request,
                  pg_uint samples, Band& band, RenderTotals& totals) {
  for (int y = 0; y < band.rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const float* pixel = film + (static_cast<std::size_t>(y) * columns + x) * film_channels;
      resolve_pixel(pixel, request, static_cast<float>(samples), static_cast<std::size_t>(y) * band.width + column + x,
                    band);
      totals.rays += static_cast<std::uint64_t>(pixel[FILM_RAYS]);
      totals.eye_rays_on_splats += static_cast<std::uint64_t>(pixel[FILM_COVERAGE]);
      totals.eye_rays_on_back_faces += static_cast<std::uint64_t>(pixel[FILM_BACK_FACE]);
      count_for_object(pixel, request, totals);
    }
  totals.eye_rays += static_cast<std::uint64_t>(columns) * band.rows * samples;
}

Band empty_band(const RenderRequest& request, int first_row, int rows) {
  const int width = request.window.x1 - request.window.x0;
  const std::size_t channels =
      film_channels(request.has_indirect(), request.has_specular(), request.has_caustics(), request.auxiliary).size();
  return {request.window.y0 + first_row, rows, width,
          std::vector<std::vector<float>>(channels, std::vector<float>(static_cast<std::size_t>(width) * rows))};
}

} // namespace pointgi
