#pragma once
/// A picture that can be looked at between the passes of its samples.
#include "host/render/band_passes.h"

namespace pointgi {

/// Holds the sums of a window's films on the host: about 40 floats a pixel. After n samples, of which all growths but
/// the last end at a multiple of GRID_RAYS, the picture is bit for bit the one that render() makes of n.
class GrowingFilm {
public:
  /// `request`: its samples do not matter. Borrows all three. Throws as render() does.
  GrowingFilm(Session& session, const DevicePools& pools, const RenderRequest& request);

  /// From now on what has grown is kept in this thread's checkpoint, and what that has of an earlier run is there.
  void go_on_from_checkpoint();

  /// Until each pixel has `samples` in all. Ends early where `stop` says so: rows that were finished then have more
  /// samples than the others. `progress`: share of what is added, 0..1.
  void grow(pg_uint samples, const std::function<void(double)>& progress, const std::function<bool()>& stop);

  /// Launches the kernels once, so that drivers load them before a time counts. Changes nothing else.
  void load_kernels();

  /// Of the rows that have the fewest; may be 0.
  pg_uint samples() const;

  /// Hands all rows to `take`, those of no samples black; the totals are those of all growths.
  RenderTotals resolve(const std::function<void(const Band&)>& take) const;

private:
  std::vector<float> tile_of(std::size_t band, int column, int columns) const;

  const RenderRequest& request_;
  BandPasses passes_;
  int width_, height_;
  std::vector<std::vector<float>> bands_;          ///< sums of each, [rows x width x film_channels]; empty: nothing yet
  std::vector<pg_uint> samples_;                   ///< of each band
  std::vector<std::pair<double, double>> seconds_; ///< of each band: of the eye rays, and all of the device's
  RenderTotals totals_;
  bool is_kept_ = false; ///< in the checkpoint
};

} // namespace pointgi
