#pragma once
/// What a checkpoint (host/cache/checkpoint.h) keeps of a picture: its bands, finished or with the passes so far.
#include "host/cache/checkpoint.h"
#include "host/render/render.h"

namespace pointgi {

/// A band of a picture that is made at once.
struct FinishedBand {
  Band band;
  RenderTotals totals; ///< of its rows alone
};
void pack(Packer& to, const FinishedBand& band);
void unpack(Unpacker& from, FinishedBand& band);

/// A band of a picture that grows.
struct BandSums {
  std::vector<float> sums;                        ///< [rows x width x film_channels]; empty: nothing yet
  pg_uint samples = 0;                            ///< a pixel
  double eye_seconds = 0.0, device_seconds = 0.0; ///< that they took
};
void pack(Packer& to, const BandSums& band);
void unpack(Unpacker& from, BandSums& band);

/// Adds what was counted of some rows; `interrupted` and `rows_done` stay.
void add(const RenderTotals& of_rows, RenderTotals& to);

/// The band `number` of an earlier run; absent: it has not kept it.
template <typename T>
std::optional<T> kept_band(const char* kind, int number) {
  Checkpoint* const checkpoint = current_checkpoint();
  const std::optional<std::string> bytes =
      checkpoint != nullptr ? checkpoint->find(kind + std::to_string(number)) : std::nullopt;
  if (!bytes) return std::nullopt;
  T kept;
  Unpacker from(*bytes);
  unpack(from, kept);
  return from.is_whole() ? std::optional<T>(std::move(kept)) : std::nullopt;
}

/// `checkpoint`: current_checkpoint() of the run, whose thread may be another; may be null.
template <typename T>
void keep_band(Checkpoint* checkpoint, const char* kind, int number, const T& band) {
  if (checkpoint == nullptr) return;
  try {
    Packer to;
    pack(to, band);
    checkpoint->keep_soon(kind + std::to_string(number), to.take());
  } catch (const std::bad_alloc&) {
    checkpoint->give_up("there is no memory for what would be kept of the picture");
  }
}

} // namespace pointgi
