#include "host/render/band_passes.h"
#include "host/render/resolve.h"
#include <algorithm>

namespace pointgi {

namespace {

/// Pixels a row of the first launch, of which nothing is known yet: 8000 rays; and of any.
constexpr std::size_t first_columns = 16, most_columns = 4096;

/// Of the columns of a band; a pixel is a work-item a sample of a pass.
Pace pace_for(const Session& session) {
  const std::size_t work_items = static_cast<std::size_t>(band_rows) * GRID_RAYS;
  return Pace(first_columns, (busy_work_items(session.info()) + work_items - 1) / work_items, most_columns);
}

} // namespace

BandPasses::BandPasses(Session& session, const DevicePools& pools, const RenderRequest& request)
    : request_(request),
      tiles_(session, pools, request.lighting, request.frame.side, request.variant, request.paths, request.irradiance,
             request.shadow_rays, request.normal_field, request.has_caustics() ? request.photons : nullptr,
             request.backfaces, request.cones, request.stored_direct, request.point_ids.size, request.auxiliary),
      pace_(pace_for(session)) {}

void BandPasses::run(const BandOfSamples& band, const TileFilms& films, RenderTotals& totals,
                     const std::function<void(double)>& progress, const std::function<bool()>& stop) {
  const PixelWindow& window = request_.window;
  const auto width = static_cast<std::size_t>(window.x1 - window.x0);
  tiles_.set_samples(band.end);
  // All passes over a tile, and its film; the seconds of the longest launch.
  const auto tile = [&](std::size_t first, std::size_t count) {
    const int column = static_cast<int>(first), columns = static_cast<int>(count);
    double longest = 0.0;
    if (band.first > 0) tiles_.go_on_from(films.before(column, columns));
    for (pg_uint sample = band.first; sample < band.end; sample += GRID_RAYS) {
      if (totals.interrupted = stop(); totals.interrupted) return longest;
      const TileSeconds seconds =
          tiles_.launch(window.x0 + column, window.y0 + band.first_row, columns, band.rows, sample);
      totals.eye_seconds += seconds.eye;
      totals.device_seconds += seconds.all();
      longest = std::max({longest, seconds.eye, seconds.shade});
      const double of_tile =
          std::min(1.0, static_cast<double>(sample - band.first + GRID_RAYS) / (band.end - band.first));
      progress((column + columns * of_tile) / static_cast<double>(width));
    }
    films.after(column, columns, tiles_.film(columns, band.rows));
    return longest;
  };
  const LaunchControl control{[&] { return totals.interrupted; }, {}};
  for_each_batch(EqualItems{width}, pace_, control, tile);
}

} // namespace pointgi
