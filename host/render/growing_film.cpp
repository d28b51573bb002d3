#include "host/render/growing_film.h"
#include "host/render/kept_bands.h"
#include "host/render/resolve.h"
#include <algorithm>
#include <utility>

namespace pointgi {

GrowingFilm::GrowingFilm(Session& session, const DevicePools& pools, const RenderRequest& request)
    : request_(request), passes_(session, pools, request), width_(request.window.x1 - request.window.x0),
      height_(request.window.y1 - request.window.y0),
      bands_(static_cast<std::size_t>((height_ + band_rows - 1) / band_rows)), samples_(bands_.size(), 0),
      seconds_(bands_.size()) {}

void GrowingFilm::go_on_from_checkpoint() {
  is_kept_ = true;
  const std::size_t row = passes_.film_channels() * static_cast<std::size_t>(width_);
  for (std::size_t b = 0; b < bands_.size(); ++b) {
    std::optional<BandSums> kept = kept_band<BandSums>("film-", static_cast<int>(b) * band_rows);
    const int rows = std::min(band_rows, height_ - static_cast<int>(b) * band_rows);
    if (!kept || kept->sums.size() != row * static_cast<std::size_t>(rows)) continue;
    bands_[b] = std::move(kept->sums);
    samples_[b] = kept->samples;
    seconds_[b] = {kept->eye_seconds, kept->device_seconds};
    totals_.eye_seconds += kept->eye_seconds;
    totals_.device_seconds += kept->device_seconds;
  }
}

std::vector<float> GrowingFilm::tile_of(std::size_t band, int column, int columns) const {
  const std::size_t channels = passes_.film_channels(), row = channels * static_cast<std::size_t>(width_);
  std::vector<float> film;
  for (auto at = bands_[band].begin(); at != bands_[band].end(); at += static_cast<std::ptrdiff_t>(row)) {
    const auto from = at + static_cast<std::ptrdiff_t>(channels) * column;
    film.insert(film.end(), from, from + static_cast<std::ptrdiff_t>(channels) * columns);
  }
  return film;
}

void GrowingFilm::grow(pg_uint samples, const std::function<void(double)>& progress,
                       const std::function<bool()>& stop) {
  const std::size_t channels = passes_.film_channels(), row = channels * static_cast<std::size_t>(width_);
  totals_.interrupted = false;
  for (std::size_t b = 0; b < bands_.size(); ++b) {
    if (samples_[b] >= samples) continue;
    const int first_row = static_cast<int>(b) * band_rows, rows = std::min(band_rows, height_ - first_row);
    std::vector<float> sums(row * static_cast<std::size_t>(rows));
    const TileFilms films{[&](int column, int columns) { return tile_of(b, column, columns); },
                          [&](int column, int columns, const std::vector<float>& film) {
                            const std::size_t part = channels * static_cast<std::size_t>(columns);
                            for (std::size_t y = 0; y < static_cast<std::size_t>(rows); ++y)
                              std::copy_n(&film[y * part], part,
                                          &sums[y * row + channels * static_cast<std::size_t>(column)]);
                          }};
    const double eye_before = totals_.eye_seconds, all_before = totals_.device_seconds;
    passes_.run(
        {first_row, rows, samples_[b], samples}, films, totals_,
        [&](double share) { progress((static_cast<double>(b) + share) / static_cast<double>(bands_.size())); }, stop);
    if (totals_.interrupted) return;
    bands_[b] = std::move(sums);
    samples_[b] = samples;
    seconds_[b].first += totals_.eye_seconds - eye_before;
    seconds_[b].second += totals_.device_seconds - all_before;
    if (Checkpoint* const checkpoint = is_kept_ ? current_checkpoint() : nullptr)
      keep_band(checkpoint, "film-", first_row, BandSums{bands_[b], samples, seconds_[b].first, seconds_[b].second});
  }
}

void GrowingFilm::load_kernels() {
  RenderTotals ignored;
  bool launched = false;
  const TileFilms films{{}, [](int, int, const std::vector<float>&) {}};
  passes_.run(
      {0, std::min(band_rows, height_), 0, GRID_RAYS}, films, ignored, [](double) {},
      [&] { return std::exchange(launched, true); });
}

pg_uint GrowingFilm::samples() const {
  return *std::min_element(samples_.begin(), samples_.end());
}

RenderTotals GrowingFilm::resolve(const std::function<void(const Band&)>& take) const {
  RenderTotals totals = totals_;
  totals.of_object.assign(request_.first_ids.size, {});
  for (std::size_t b = 0; b < bands_.size(); ++b) {
    const int first_row = static_cast<int>(b) * band_rows;
    Band band = empty_band(request_, first_row, std::min(band_rows, height_ - first_row));
    if (samples_[b] > 0) {
      resolve_tile(bands_[b].data(), passes_.film_channels(), 0, width_, request_, samples_[b], band, totals);
      totals.rows_done = first_row + band.rows;
    }
    totals.lit = totals.lit || is_lit(band);
    take(band);
  }
  return totals;
}

} // namespace pointgi
