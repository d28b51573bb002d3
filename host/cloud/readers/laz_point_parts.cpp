#include "host/cloud/readers/laz_items.h"
#include <cstring>

namespace pointgi {

namespace {

using laz_detail::even;
using laz_detail::folded;

template <class Value>
Value load(const unsigned char* bytes) {
  Value value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}
template <class Value>
void store(unsigned char* bytes, Value value) {
  std::memcpy(bytes, &value, sizeof value);
}

// Bytes of the 20 that all of these formats begin with.
constexpr std::size_t at_intensity = 12, at_returns = 14, at_class = 15, at_angle = 16, at_user = 17, at_source = 18;

/// Contexts of returns: r of n. Numbers that begin with 0, or of which r exceeds n, have contexts of their own.
constexpr unsigned char return_context[8][8] = {{15, 14, 13, 12, 11, 10, 9, 8},  {14, 0, 1, 3, 6, 10, 10, 9},
                                                {13, 1, 2, 4, 7, 11, 11, 10},    {12, 3, 4, 5, 8, 12, 12, 11},
                                                {11, 6, 7, 8, 9, 13, 13, 12},    {10, 10, 11, 12, 13, 14, 14, 13},
                                                {9, 10, 11, 12, 13, 14, 15, 14}, {8, 9, 10, 11, 12, 13, 14, 15}};

/// x y z, intensity, flags, class, angle, user data, source.
class Point10 : public LazPointPart {
public:
  void begin(const unsigned char* bytes) override {
    std::memcpy(last_, bytes, sizeof last_);
    store<std::uint16_t>(last_ + at_intensity, 0);
  }

  void next(LazDecoder& decoder, unsigned char* bytes) override {
    const std::uint32_t changed = decoder.symbol(changed_);
    if ((changed & 32) != 0) last_[at_returns] = folded(decoder.symbol(returns_[last_[at_returns]]));
    const unsigned r = last_[at_returns] & 7, n = last_[at_returns] >> 3 & 7;
    const unsigned context = return_context[n][r];
    if (changed != 0) {
      if ((changed & 16) != 0)
        intensities_[context] =
            static_cast<std::uint16_t>(intensity_.decode(decoder, intensities_[context], context < 3 ? context : 3));
      store(last_ + at_intensity, intensities_[context]);
      if ((changed & 8) != 0) last_[at_class] = folded(decoder.symbol(class_[last_[at_class]]));
      if ((changed & 4) != 0)
        last_[at_angle] = folded(last_[at_angle] + decoder.symbol(angle_[last_[at_returns] >> 6 & 1]));
      if ((changed & 2) != 0) last_[at_user] = folded(decoder.symbol(user_[last_[at_user]]));
      if ((changed & 1) != 0)
        store(last_ + at_source,
              static_cast<std::uint16_t>(source_.decode(decoder, load<std::uint16_t>(last_ + at_source))));
    }
    move(decoder, n, context, laz_return_level(n, r));
    std::memcpy(bytes, last_, sizeof last_);
  }

private:
  void move(LazDecoder& decoder, unsigned n, unsigned context, unsigned level) {
    const unsigned single = n == 1 ? 1 : 0;
    const auto step = [&](std::size_t axis, LazIntegers& integers, LazMedian& median, std::size_t kind) {
      const std::int32_t difference = integers.decode(decoder, median.get(), kind);
      store(last_ + 4 * axis, load<std::uint32_t>(last_ + 4 * axis) + static_cast<std::uint32_t>(difference));
      median.add(difference);
    };
    step(0, x_, x_medians_[context], single);
    step(1, y_, y_medians_[context], single + even(x_.last_bits(), 20));
    const unsigned bits = (x_.last_bits() + y_.last_bits()) / 2;
    heights_[level] = z_.decode(decoder, heights_[level], single + even(bits, 18));
    store(last_ + 8, heights_[level]);
  }

  unsigned char last_[20]{};
  LazModel changed_{64};
  LazModels returns_{256, 256}, class_{256, 256}, user_{256, 256}, angle_{2, 256};
  LazIntegers intensity_{16, 4}, source_{16}, x_{32, 2}, y_{32, 22}, z_{32, 20};
  std::array<std::uint16_t, 16> intensities_{};
  std::array<LazMedian, 16> x_medians_{}, y_medians_{};
  std::array<std::int32_t, 8> heights_{};
};

class Time : public LazPointPart {
public:
  void begin(const unsigned char* bytes) override { times_ = LazTimes(true, load<std::int64_t>(bytes)); }
  void next(LazDecoder& decoder, unsigned char* bytes) override { store(bytes, times_.next(decoder)); }

private:
  LazTimes times_{true, 0};
};

class Colour : public LazPointPart {
public:
  void begin(const unsigned char* bytes) override { std::memcpy(last_, bytes, sizeof last_); }
  void next(LazDecoder& decoder, unsigned char* bytes) override {
    colour_.next(decoder, last_, bytes);
    std::memcpy(last_, bytes, sizeof last_);
  }

private:
  unsigned char last_[6]{};
  LazColour colour_;
};

class ExtraBytes : public LazPointPart {
public:
  explicit ExtraBytes(std::size_t bytes) : last_(bytes), models_(bytes, LazModel(256)) {}
  void begin(const unsigned char* bytes) override { std::memcpy(last_.data(), bytes, last_.size()); }
  void next(LazDecoder& decoder, unsigned char* bytes) override {
    for (std::size_t k = 0; k < last_.size(); ++k)
      bytes[k] = last_[k] = folded(last_[k] + decoder.symbol(models_[k]));
  }

private:
  std::vector<unsigned char> last_;
  std::vector<LazModel> models_;
};

} // namespace

std::unique_ptr<LazPointPart> make_point_part(const LazItem& item) {
  if (item.version != 2) return nullptr;
  if (item.type == 6 && item.bytes == 20) return std::make_unique<Point10>();
  if (item.type == 7 && item.bytes == 8) return std::make_unique<Time>();
  if (item.type == 8 && item.bytes == 6) return std::make_unique<Colour>();
  if (item.type == 0) return std::make_unique<ExtraBytes>(item.bytes);
  return nullptr;
}

} // namespace pointgi
