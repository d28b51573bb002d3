#pragma once
/// From the sums of a film, as the device has them, to the channels of a picture.
#include "host/render/render.h"

namespace pointgi {

/// A finished tile, `film_channels` scalars a pixel, of `samples` samples, into its band from `column` on, and into the
/// totals.
void resolve_tile(const float* film, std::size_t film_channels, int column, int columns, const RenderRequest& request,
                  pg_uint samples, Band& band, RenderTotals& totals);

/// Rows of a window without any value yet. `first_row`: of the window.
Band empty_band(const RenderRequest& request, int first_row, int rows);

/// Whether some pixel of R, G and B is above 0.
bool is_lit(const Band& band);

} // namespace pointgi
