#pragma once
/// The picture that all others are compared with.
#include "host/measure/picture_maker.h"
#include "host/measure/reference.h"
#include <functional>

namespace pointgi {

struct MadeReference {
  Picture first, second; ///< halves, R, G and B; of a file `second` has no pixels
  Picture shown;         ///< with coverage and albedo, by which an exposure is chosen; noisy
  std::string source;    ///< TradeReference::source
  double seconds = 0.0;
  bool whole() const { return second.channels.empty(); }
  Reference reference() const { return whole() ? Reference(first) : Reference(first, second); }
};

/// Size of the picture that is measured: the scene's own, its longest side cut to between 160 and 320 pixels, as many
/// as leave the reference enough samples. `seconds_a_sample`: of one at 160 pixels; `seconds`: for the reference.
std::pair<int, int> size_to_measure(int width, int height, double seconds_a_sample, double seconds);

/// Path-traced halves within `seconds`, at least one sample a pixel each, `seed`: of the k-th picture that is
/// traced for it. `elapsed`: seconds of a clock of the caller's. Throws Error(interrupted) when `run` ends before both
/// have a sample; what is there is kept otherwise.
MadeReference trace_reference(PictureMaker& maker, double seconds, const std::function<unsigned(unsigned)>& seed,
                              const std::function<double()>& elapsed, const RunControl& run);

/// A file's. Throws Error(input) where it cannot be read, is a part of a picture or has no R, G and B, or is not of the
/// size that is asked for (absent: any).
MadeReference read_reference(const std::string& path, const std::optional<std::pair<int, int>>& size);

/// The halves in `folder`, from an earlier run of this size; absent where they are not there.
std::optional<MadeReference> kept_reference(const std::string& folder, int width, int height);
void keep_reference(const MadeReference& made, const std::string& folder);

} // namespace pointgi
