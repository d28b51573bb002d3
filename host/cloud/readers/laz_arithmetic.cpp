#include "host/cloud/readers/laz_arithmetic.h"
#include <algorithm>

namespace pointgi {

namespace {

constexpr unsigned bit_precision = 13, symbol_precision = 15;
constexpr unsigned upper_bits = 8; // of a large correction, which a model predicts

} // namespace

void LazBitModel::count(bool bit) {
  if (!bit) ++zeros_;
  if (--until_update_ == 0) update();
}

void LazBitModel::update() {
  bits_ += cycle_;
  if (bits_ > 1u << bit_precision) {
    bits_ = (bits_ + 1) >> 1;
    zeros_ = (zeros_ + 1) >> 1;
    if (zeros_ == bits_) ++bits_;
  }
  probability_ = static_cast<std::uint32_t>((std::uint64_t{0x80000000u / bits_} * zeros_) >> (31 - bit_precision));
  cycle_ = std::min(5 * cycle_ >> 2, 64u);
  until_update_ = cycle_;
}

LazModel::LazModel(std::uint32_t symbols) : counts_(symbols, 1), distribution_(symbols + 1), cycle_(symbols) {
  update();
  cycle_ = (symbols + 6) >> 1;
  until_update_ = cycle_;
}

void LazModel::update() {
  total_ += cycle_;
  if (total_ > 1u << symbol_precision) {
    total_ = 0;
    for (std::uint32_t& count : counts_)
      total_ += count = (count + 1) >> 1;
  }
  const std::uint32_t scale = 0x80000000u / total_;
  std::uint32_t sum = 0;
  for (std::size_t k = 0; k < counts_.size(); ++k) {
    distribution_[k] = scale * sum >> (31 - symbol_precision);
    sum += counts_[k];
  }
  distribution_.back() = 1u << symbol_precision; // which no symbol reaches
  cycle_ = std::min(5 * cycle_ >> 2, (symbols() + 6) << 3);
  until_update_ = cycle_;
}

LazDecoder::LazDecoder(const unsigned char* data, std::size_t size) : at_(data), end_(data + size) {
  for (int byte = 0; byte < 4; ++byte)
    value_ = value_ << 8 | next();
}

std::uint32_t LazDecoder::bit(LazBitModel& model) {
  const std::uint32_t split = model.zero_probability() * (length_ >> bit_precision);
  const bool one = value_ >= split;
  if (one) {
    value_ -= split;
    length_ -= split;
  } else {
    length_ = split;
  }
  renormalise();
  model.count(one);
  return one ? 1 : 0;
}

std::uint32_t LazDecoder::symbol(LazModel& model) {
  const std::uint32_t whole = length_;
  length_ >>= symbol_precision;
  std::uint32_t low = 0, high = model.symbols();
  while (high - low > 1) {
    const std::uint32_t middle = (low + high) / 2;
    if (length_ * model.before(middle) > value_)
      high = middle;
    else
      low = middle;
  }
  const std::uint32_t begin = length_ * model.before(low);
  const std::uint32_t end = low + 1 == model.symbols() ? whole : length_ * model.before(low + 1);
  value_ -= begin;
  length_ = end - begin;
  // Bytes that no encoder wrote can leave nothing of the interval.
  if (length_ == 0) {
    length_ = 1;
    overrun_ += 1u << 20;
  }
  renormalise();
  model.count(low);
  return low;
}

std::uint32_t LazDecoder::bits(unsigned count) {
  if (count > 19) {
    const std::uint32_t lower = bits(16);
    return bits(count - 16) << 16 | lower;
  }
  length_ >>= count;
  const std::uint32_t value = std::min(value_ / length_, (1u << count) - 1);
  value_ -= value * length_;
  renormalise();
  return value;
}

LazIntegers::LazIntegers(unsigned bits, std::size_t contexts)
    : bits_(bits), sizes_(contexts, LazModel(bits + 1)), corrections_(bits) {}

LazModel& LazIntegers::model_of(unsigned size) {
  std::unique_ptr<LazModel>& model = corrections_[size - 1];
  if (!model) model = std::make_unique<LazModel>(1u << std::min(size, upper_bits));
  return *model;
}

std::int32_t LazIntegers::decode(LazDecoder& decoder, std::int32_t predicted, std::size_t context) {
  const std::int32_t correct = correction(decoder, sizes_[context]);
  const std::uint32_t sum = static_cast<std::uint32_t>(predicted) + static_cast<std::uint32_t>(correct);
  if (bits_ >= 32) return static_cast<std::int32_t>(sum);
  const std::uint32_t range = 1u << bits_;
  const auto value = static_cast<std::int32_t>(sum);
  if (value < 0) return static_cast<std::int32_t>(sum + range);
  return static_cast<std::int32_t>(sum >= range ? sum - range : sum);
}

std::int32_t LazIntegers::correction(LazDecoder& decoder, LazModel& sizes) {
  last_bits_ = decoder.symbol(sizes);
  if (last_bits_ == 0) return static_cast<std::int32_t>(decoder.bit(small_));
  if (last_bits_ >= 32) return INT32_MIN;
  std::uint32_t value = decoder.symbol(model_of(last_bits_));
  if (last_bits_ > upper_bits) {
    const unsigned lower = last_bits_ - upper_bits;
    value = value << lower | decoder.bits(lower);
  }
  // 2^(k-1)+1 ... 2^k above, -(2^k-1) ... -2^(k-1) below.
  if (value >= 1u << (last_bits_ - 1)) return static_cast<std::int32_t>(value + 1);
  return static_cast<std::int32_t>(value - ((1u << last_bits_) - 1));
}

void LazMedian::add(std::int32_t value) {
  auto& v = values_;
  const auto sift = [&](std::size_t from, std::size_t to) { // values from..to-1 move one up, the last is forgotten
    std::copy_backward(v.begin() + from, v.begin() + to, v.begin() + to + 1);
  };
  const auto sink = [&](std::size_t from, std::size_t to) { // values from+1..to move one down
    std::copy(v.begin() + from + 1, v.begin() + to + 1, v.begin() + from);
  };
  if (high_ && value < v[2]) {
    const std::size_t place = value < v[0] ? 0 : value < v[1] ? 1 : 2;
    sift(place, 4);
    v[place] = value;
  } else if (high_) {
    const std::size_t place = value < v[3] ? 3 : 4;
    sift(place, 4);
    v[place] = value;
    high_ = false;
  } else if (v[2] < value) {
    const std::size_t place = v[4] < value ? 4 : v[3] < value ? 3 : 2;
    sink(0, place);
    v[place] = value;
  } else {
    const std::size_t place = v[1] < value ? 1 : 0;
    sink(0, place);
    v[place] = value;
    high_ = true;
  }
}

} // namespace pointgi
