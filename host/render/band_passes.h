#pragma once
/// The passes of samples over the tiles of some rows.
#include "host/cl/batches.h"
#include "host/render/render.h"
#include "host/render/tile_renderer.h"

namespace pointgi {

/// Which part of a picture's samples.
struct BandOfSamples {
  int first_row, rows; ///< of the window
  pg_uint first, end;  ///< samples of each pixel, `first` a multiple of GRID_RAYS
};

/// The films of a band's tiles before and after its samples, [rows x columns x film_channels]; `column`: the first.
struct TileFilms {
  /// Only asked for where samples were taken before; may be empty where none were.
  std::function<std::vector<float>(int column, int columns)> before;
  std::function<void(int column, int columns, const std::vector<float>& film)> after;
};

class BandPasses {
public:
  /// Builds the programs where they are not built yet. Borrows all three.
  BandPasses(Session& session, const DevicePools& pools, const RenderRequest& request);

  /// Adds its seconds to the totals, and sets `interrupted` where `stop` ended it. `progress`: share of the band, 0..1.
  void run(const BandOfSamples& band, const TileFilms& films, RenderTotals& totals,
           const std::function<void(double)>& progress, const std::function<bool()>& stop);

  std::size_t film_channels() const { return tiles_.film_channels(); }

private:
  const RenderRequest& request_;
  TileRenderer tiles_;
  Pace pace_;
};

} // namespace pointgi
