#pragma once
/// The parts of a compressed LAS point record. Each keeps what it needs of the points before.
#include "host/cloud/readers/laz_arithmetic.h"
#include <memory>

namespace pointgi {

/// A part as the record "laszip encoded" of a LAZ file lists them.
struct LazItem {
  unsigned type = 0;
  std::size_t bytes = 0; ///< of the point record
  unsigned version = 0;  ///< of its compression
};

/// Of files whose points are coded one after the other (point formats 0 to 5).
class LazPointPart {
public:
  virtual ~LazPointPart() = default;
  /// `bytes`: the part in the chunk's first point, which is stored as it is.
  virtual void begin(const unsigned char* bytes) = 0;
  virtual void next(LazDecoder& decoder, unsigned char* bytes) = 0;
};
/// Null for a part that is not known here.
std::unique_ptr<LazPointPart> make_point_part(const LazItem& item);

/// A layer of a chunk: one attribute of all its points. Empty: it does not change.
struct LazLayer {
  LazDecoder decoder;
  bool is_empty = true;
};

/// Of files whose attributes are coded one after the other (point formats 6 to 10).
class LazLayerPart {
public:
  virtual ~LazLayerPart() = default;
  virtual std::size_t layers() const = 0;
  /// `channel`: the scanner channel of the first point.
  virtual void begin(const unsigned char* bytes, unsigned channel) = 0;
  /// `layers`: this part's. The part of the point itself comes first and sets `channel`.
  virtual void next(LazLayer* layers, unsigned& channel, unsigned char* bytes) = 0;
};
std::unique_ptr<LazLayerPart> make_layer_part(const LazItem& item);

/// Contexts of returns: how far return `r` is from the last of `n`.
inline unsigned laz_return_level(unsigned n, unsigned r) {
  return n > r ? n - r : r - n;
}

namespace laz_detail {
inline unsigned char folded(std::uint32_t value) {
  return static_cast<unsigned char>(value & 255);
}
/// The context of a height: that of how much x and y changed.
inline unsigned even(unsigned bits, unsigned most) {
  return bits < most ? bits & ~1u : most;
}
} // namespace laz_detail

/// The colour behind `last`, each of three 16-bit channels; shared by both kinds of file.
struct LazColour {
  LazModel used{128};
  std::vector<LazModel> difference = std::vector<LazModel>(6, LazModel(256));
  void next(LazDecoder& decoder, const unsigned char* last, unsigned char* bytes);
};

/// Times as differences to up to four sequences of times before.
class LazTimes {
public:
  /// Pointwise files have a symbol for an unchanged time.
  LazTimes(bool has_unchanged, std::int64_t first);
  std::int64_t next(LazDecoder& decoder);

private:
  void restart(LazDecoder& decoder);
  bool first_difference(LazDecoder& decoder);
  bool multiple(LazDecoder& decoder);
  void count_extreme(std::int32_t difference);
  std::uint32_t unchanged_; ///< 1: there is such a symbol
  LazModel multi_, zero_;
  LazIntegers integers_{32, 9};
  std::size_t last_ = 0, newest_ = 0;
  std::array<std::int64_t, 4> times_{};
  std::array<std::int32_t, 4> difference_{};
  std::array<int, 4> extremes_{};
};

} // namespace pointgi
