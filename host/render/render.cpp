#include "host/render/render.h"
#include "host/render/band_passes.h"
#include "host/render/kept_bands.h"
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
  Checkpoint* const checkpoint = current_checkpoint();
  std::future<void> taken; // the band before, while the device is busy with the next
  const auto finish_taking = [&] {
    if (!taken.valid()) return;
    taken.get();
    totals.rows_done = std::min(height, totals.rows_done + band_rows);
  };
  for (int row = 0; row < height; row += band_rows) {
    const int rows = std::min(band_rows, height - row);
    std::optional<FinishedBand> kept = kept_band<FinishedBand>("rows-", row);
    const bool is_kept = kept.has_value();
    FinishedBand made = is_kept ? std::move(*kept) : FinishedBand{empty_band(request, row, rows), {}};
    if (!is_kept) {
      made.totals.of_object.resize(request.first_ids.size);
      const TileFilms films{{}, [&](int column, int columns, const std::vector<float>& film) {
                              resolve_tile(film.data(), passes.film_channels(), column, columns, request, samples,
                                           made.band, made.totals);
                            }};
      passes.run(
          {row, rows, 0, samples}, films, made.totals,
          [&](double share) { progress((row + rows * share) / static_cast<double>(height)); }, stop);
      made.totals.lit = is_lit(made.band);
    }
    finish_taking();
    totals.interrupted = made.totals.interrupted;
    add(made.totals, totals);
    if (totals.interrupted) return totals;
    // Deferred where there is no thread to be had; a copy, as the library tries both ways with what it is given.
    const auto take_band = [&take, checkpoint, is_kept, row,
                            done = std::make_shared<const FinishedBand>(std::move(made))] {
      take(done->band);
      if (!is_kept) keep_band(checkpoint, "rows-", row, *done);
    };
    taken = std::async(std::launch::async | std::launch::deferred, take_band);
  }
  finish_taking();
  return totals;
}

} // namespace pointgi
