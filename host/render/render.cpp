#include "host/render/render.h"
#include "host/render/band_passes.h"
#include "host/render/resolve.h"
#include <algorithm>
#include <future>
#include <memory>

namespace pointgi {

RenderTotals render(Session& session, const DevicePools& pools, const RenderRequest& request,
                    const std::function<void(const Band&)>& take, const std::function<void(double)>& progress,
                    const std::function<bool()>& stop) {
  BandPasses passes(session, pools, request);
  const int height = request.window.y1 - request.window.y0;
  const pg_uint samples = request.lighting.params.samples;
  RenderTotals totals;
  totals.of_object.resize(request.first_ids.size);
  std::future<void> taken; // the band before, while the device is busy with the next
  const auto finish_taking = [&] {
    if (!taken.valid()) return;
    taken.get();
    totals.rows_done = std::min(height, totals.rows_done + band_rows);
  };
  for (int row = 0; row < height; row += band_rows) {
    const int rows = std::min(band_rows, height - row);
    Band band = empty_band(request, row, rows);
    const TileFilms films{{}, [&](int column, int columns, const std::vector<float>& film) {
                            resolve_tile(film.data(), passes.film_channels(), column, columns, request, samples, band,
                                         totals);
                          }};
    passes.run(
        {row, rows, 0, samples}, films, totals,
        [&](double share) { progress((row + rows * share) / static_cast<double>(height)); }, stop);
    finish_taking();
    if (totals.interrupted) return totals;
    totals.lit = totals.lit || is_lit(band);
    // Deferred where there is no thread to be had; a copy, as the library tries both ways with what it is given.
    const auto take_band = [&take, done = std::make_shared<const Band>(std::move(band))] { take(*done); };
    taken = std::async(std::launch::async | std::launch::deferred, take_band);
  }
  finish_taking();
  return totals;
}

} // namespace pointgi
