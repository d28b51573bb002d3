#pragma once
/// The entropy coder of LAZ: adaptive arithmetic decoding (Said 2004) and integers as corrections of predictions, as
/// LASzip writes them (Isenburg 2013).
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace pointgi {

/// How probable a bit was so far.
class LazBitModel {
public:
  std::uint32_t zero_probability() const { return probability_; } ///< of 2^13
  void count(bool bit);

private:
  void update();
  std::uint32_t zeros_ = 1, bits_ = 2, probability_ = 1u << 12, cycle_ = 4, until_update_ = 4;
};

/// How probable each of up to 256 (or some hundred) symbols was so far.
class LazModel {
public:
  explicit LazModel(std::uint32_t symbols);
  std::uint32_t symbols() const { return static_cast<std::uint32_t>(counts_.size()); }
  /// Sum of the probabilities of the symbols before this one, of 2^15.
  std::uint32_t before(std::uint32_t symbol) const { return distribution_[symbol]; }
  void count(std::uint32_t symbol) {
    ++counts_[symbol];
    if (--until_update_ == 0) update();
  }

private:
  void update();
  std::vector<std::uint32_t> counts_, distribution_;
  std::uint32_t total_ = 0, cycle_, until_update_ = 0;
};

/// Models that few files need all of are made when they are first used.
class LazModels {
public:
  LazModels(std::size_t count, std::uint32_t symbols) : first_(count, 0), symbols_(symbols) {}
  LazModel& operator[](std::size_t index) {
    if (first_[index] == 0) {
      models_.emplace_back(symbols_);
      first_[index] = models_.size();
    }
    return models_[first_[index] - 1];
  }

private:
  std::vector<std::size_t> first_; ///< place among the models, from 1; 0: not made
  std::vector<LazModel> models_;
  std::uint32_t symbols_;
};

/// Decodes from `size` bytes at `data`. Behind their end it reads zeros; overrun() tells how many.
class LazDecoder {
public:
  LazDecoder() = default;
  LazDecoder(const unsigned char* data, std::size_t size);

  std::uint32_t bit(LazBitModel& model);
  std::uint32_t symbol(LazModel& model);
  std::uint32_t bits(unsigned count); ///< 1 to 32 bits that no model predicts
  std::size_t overrun() const { return overrun_; }

private:
  unsigned char next() {
    if (at_ < end_) return *at_++;
    ++overrun_;
    return 0;
  }
  void renormalise() {
    while (length_ < (1u << 24)) {
      value_ = value_ << 8 | next();
      length_ <<= 8;
    }
  }

  const unsigned char* at_ = nullptr;
  const unsigned char* end_ = nullptr;
  std::size_t overrun_ = 0;
  std::uint32_t value_ = 0, length_ = 0xffffffff;
};

/// Whole numbers of `bits` bits near to a prediction; corrections of `contexts` kinds are told apart.
class LazIntegers {
public:
  explicit LazIntegers(unsigned bits, std::size_t contexts = 1);
  /// The number whose prediction was `predicted`.
  std::int32_t decode(LazDecoder& decoder, std::int32_t predicted, std::size_t context = 0);
  /// Bits of the last correction.
  unsigned last_bits() const { return last_bits_; }

private:
  std::int32_t correction(LazDecoder& decoder, LazModel& sizes);
  LazModel& model_of(unsigned size); ///< made when it is first used
  unsigned bits_;
  unsigned last_bits_ = 0;
  std::vector<LazModel> sizes_;                        ///< one a context: bits of the correction
  LazBitModel small_;                                  ///< corrections 0 and 1
  std::vector<std::unique_ptr<LazModel>> corrections_; ///< by their bits, from 1; of large ones the upper eight
};

/// The middle of the last five values, in the order in which LASzip forgets them.
class LazMedian {
public:
  std::int32_t get() const { return values_[2]; }
  void add(std::int32_t value);

private:
  std::array<std::int32_t, 5> values_{};
  bool high_ = true;
};

} // namespace pointgi
