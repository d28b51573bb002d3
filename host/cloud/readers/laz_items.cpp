#include "host/cloud/readers/laz_items.h"
#include <algorithm>
#include <cstring>

namespace pointgi {

using laz_detail::folded;

namespace {

constexpr int multi_most = 500, multi_least = -10; // multiples of the last difference of times
constexpr std::uint32_t multi_full = 511;          // then a whole time follows; one more where "unchanged" has a symbol

} // namespace

void LazColour::next(LazDecoder& decoder, const unsigned char* last, unsigned char* bytes) {
  const std::uint32_t changed = decoder.symbol(used);
  const auto corrected = [&](unsigned bit, std::size_t model, int predicted, unsigned char before) {
    if ((changed & bit) == 0) return before;
    const int bounded = std::clamp(predicted, 0, 255);
    return folded(decoder.symbol(difference[model]) + static_cast<std::uint32_t>(bounded));
  };
  unsigned char result[6]; // low and high byte of red, green, blue
  result[0] = corrected(1, 0, last[0], last[0]);
  result[1] = corrected(2, 1, last[1], last[1]);
  if ((changed & 64) == 0) { // grey
    for (int byte = 2; byte < 6; ++byte)
      result[byte] = result[byte % 2];
  } else {
    // Green and blue change as red did; low bytes first, then high ones.
    for (int byte = 0; byte < 2; ++byte) {
      const int red = result[byte] - last[byte];
      result[2 + byte] = corrected(byte == 0 ? 4 : 8, byte == 0 ? 2 : 3, red + last[2 + byte], last[2 + byte]);
      const int both = (red + result[2 + byte] - last[2 + byte]) / 2;
      result[4 + byte] = corrected(byte == 0 ? 16 : 32, byte == 0 ? 4 : 5, both + last[4 + byte], last[4 + byte]);
    }
  }
  std::memcpy(bytes, result, sizeof result);
}

LazTimes::LazTimes(bool has_unchanged, std::int64_t first)
    : unchanged_(has_unchanged ? 1 : 0), multi_(515 + unchanged_), zero_(5 + unchanged_) {
  times_[0] = first;
}

/// A time of its own, which begins a sequence.
void LazTimes::restart(LazDecoder& decoder) {
  newest_ = (newest_ + 1) & 3;
  const auto upper = static_cast<std::int32_t>(times_[last_] >> 32);
  const auto high = static_cast<std::uint32_t>(integers_.decode(decoder, upper, 8));
  times_[newest_] = static_cast<std::int64_t>(std::uint64_t{high} << 32 | decoder.bits(32));
  last_ = newest_;
  difference_[last_] = 0;
  extremes_[last_] = 0;
}

std::int64_t LazTimes::next(LazDecoder& decoder) {
  // A switch to another sequence is followed by another symbol; bytes that no encoder wrote could switch for ever.
  for (int switches = 0; switches < 4; ++switches)
    if (difference_[last_] == 0 ? first_difference(decoder) : multiple(decoder)) break;
  return times_[last_];
}

namespace {
std::int64_t plus(std::int64_t time, std::int32_t difference) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(time) +
                                   static_cast<std::uint64_t>(std::int64_t{difference}));
}
std::int32_t times(int factor, std::int32_t difference) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(factor) * static_cast<std::uint32_t>(difference));
}
} // namespace

/// False: it switched to another sequence.
bool LazTimes::first_difference(LazDecoder& decoder) {
  const std::uint32_t symbol = decoder.symbol(zero_) + (1 - unchanged_);
  if (symbol == 1) {
    difference_[last_] = integers_.decode(decoder, 0, 0);
    times_[last_] = plus(times_[last_], difference_[last_]);
    extremes_[last_] = 0;
  } else if (symbol == 2) {
    restart(decoder);
  } else if (symbol > 2) {
    last_ = (last_ + symbol - 2) & 3;
    return false;
  }
  return true;
}

void LazTimes::count_extreme(std::int32_t difference) {
  if (++extremes_[last_] <= 3) return;
  difference_[last_] = difference;
  extremes_[last_] = 0;
}

bool LazTimes::multiple(LazDecoder& decoder) {
  const std::uint32_t symbol = decoder.symbol(multi_);
  const std::int32_t known = difference_[last_];
  const auto decoded = [&](int factor, std::size_t context) {
    return integers_.decode(decoder, times(factor, known), context);
  };
  if (symbol >= multi_full) {
    if (symbol < multi_full + unchanged_) return true;
    if (symbol == multi_full + unchanged_) {
      restart(decoder);
      return true;
    }
    last_ = (last_ + symbol - multi_full - unchanged_) & 3;
    return false;
  }
  const int multi = static_cast<int>(symbol);
  std::int32_t difference = 0;
  if (multi == 1) {
    difference = decoded(1, 1);
    extremes_[last_] = 0;
  } else if (multi == 0) {
    difference = integers_.decode(decoder, 0, 7);
    count_extreme(difference);
  } else if (multi < multi_most) {
    difference = decoded(multi, multi < 10 ? 2 : 3);
  } else if (multi == multi_most) {
    difference = decoded(multi_most, 4);
    count_extreme(difference);
  } else if (multi_most - multi > multi_least) {
    difference = decoded(multi_most - multi, 5);
  } else {
    difference = decoded(multi_least, 6);
    count_extreme(difference);
  }
  times_[last_] = plus(times_[last_], difference);
  return true;
}

} // namespace pointgi
