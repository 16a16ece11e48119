// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_LAZ_INTEGERS_HPP
#define PULSECAST_IO_DETAIL_LAZ_INTEGERS_HPP

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

#include <pulsecast/io/detail/laz/coder.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Running median of five numbers, zeros at first. A new one replaces the greatest until one is not
/// below the median, then the least until one is not above it. Source: Isenburg 2013, LASzip, 4.1.
class LazMedian {
 public:
  [[nodiscard]] std::int32_t value() const noexcept { return sorted_[2]; }

  void add(std::int32_t number) noexcept {
    const std::int32_t middle = value();
    if (drop_greatest_) {
      sorted_[4] = number;
      for (std::size_t i = 4; i > 0 && sorted_[i] < sorted_[i - 1]; --i) std::swap(sorted_[i], sorted_[i - 1]);
      drop_greatest_ = number < middle;
    } else {
      sorted_[0] = number;
      for (std::size_t i = 0; i < 4 && sorted_[i + 1] < sorted_[i]; ++i) std::swap(sorted_[i], sorted_[i + 1]);
      drop_greatest_ = number <= middle;
    }
  }

 private:
  std::array<std::int32_t, 5> sorted_{};
  bool drop_greatest_ = true;
};

/// Step between two integers, which wraps around.
[[nodiscard]] inline std::int32_t laz_step(std::int32_t from, std::int32_t to) noexcept {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(to) - static_cast<std::uint32_t>(from));
}

/// Coder of integers as corrections to a prediction: bit length, by a model for each context, then
/// rank, with its highest eight bits modelled. Source: Isenburg 2013, LASzip, 4.
class LazIntegers {
 public:
  /// `bits` of the integers, 16 or 32; number of contexts.
  LazIntegers(unsigned bits, std::size_t contexts) : bits_(bits), lengths_(contexts, LazModel<33>(bits + 1)) {
    for (unsigned k = 1; k <= bits; ++k) corrections_.emplace_back(std::size_t{1} << std::min(k, modelled_bits));
  }

  /// Encodes a number; 16-bit ones may be signed or unsigned. Arithmetic wraps around.
  void encode(LazEncoder& encoder, std::int32_t expected, std::int32_t number, std::size_t context = 0) {
    std::int32_t correction = laz_step(expected, number);
    if (bits_ == 16) correction = static_cast<std::int16_t>(correction);
    // corrections of k bits: in [1 - 2^k, -2^(k-1)] or [2^(k-1) + 1, 2^k]; with k = 0, 0 and 1
    const std::int64_t above = correction > 0 ? correction - 1 : -std::int64_t{correction};
    const auto size = static_cast<std::uint32_t>(above);
    length_ = static_cast<unsigned>(std::bit_width(size));
    encoder.encode(lengths_[context], length_);
    if (length_ == 0) return encoder.encode(zero_or_one_, correction == 1);
    if (length_ == 32) return;  // a single one: -2^31
    const std::uint32_t place = correction > 0 ? size : (1U << length_) - 1 - size;
    LazModel<>& model = corrections_[length_ - 1];
    if (length_ <= modelled_bits) return encoder.encode(model, place);
    const unsigned others = length_ - modelled_bits;
    encoder.encode(model, place >> others);
    encoder.encode_bits(place & ((1U << others) - 1), others);
  }

  /// Bit length of the last correction: a measure of the error to expect of a related number.
  [[nodiscard]] unsigned last_length() const noexcept { return length_; }

 private:
  static constexpr unsigned modelled_bits = 8;

  unsigned bits_, length_ = 0;
  std::vector<LazModel<33>> lengths_;
  LazBitModel zero_or_one_;
  std::vector<LazModel<>> corrections_;  // by length, from 1
};

/// Coder of times, as 64-bit patterns: continuations of one of four series, each with its last time
/// and usual step. Source: Isenburg 2013, LASzip, 4 (GPSTIME11), and files of version 3.
class LazTimes {
 public:
  explicit LazTimes(std::int64_t first) { last_[0] = first; }

  void encode(LazEncoder& encoder, std::int64_t time) {
    if (!near(time, series_)) {
      for (std::size_t k = 1; k < 4; ++k)
        if (const std::size_t other = (series_ + k) % 4; near(time, other)) {
          change_series(encoder, k);
          series_ = other;
          return go_on(encoder, time);
        }
      return begin_series(encoder, time);
    }
    go_on(encoder, time);
  }

 private:
  /// Multiples of the usual step: 0 to 499, at least 500, -9 to -1, at most -10; or a new series.
  static constexpr int most = 500, least = -10, new_series = most - least + 1;
  static constexpr int symbols = new_series + 4;  // plus the three other series

  [[nodiscard]] std::int64_t step_to(std::int64_t time, std::size_t series) const noexcept {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(time) - static_cast<std::uint64_t>(last_[series]));
  }
  [[nodiscard]] bool near(std::int64_t time, std::size_t series) const noexcept {
    const std::int64_t step = step_to(time, series);
    return step == static_cast<std::int32_t>(step);
  }

  void change_series(LazEncoder& encoder, std::size_t k) {
    if (usual_[series_] == 0)
      encoder.encode(first_steps_, 1 + k);
    else
      encoder.encode(multiples_, new_series + k);
  }

  void begin_series(LazEncoder& encoder, std::int64_t time) {
    change_series(encoder, 0);
    const auto high = [](std::int64_t bits) { return static_cast<std::int32_t>(bits >> 32); };
    steps_.encode(encoder, high(last_[series_]), high(time), 8);
    encoder.encode_bits(static_cast<std::uint32_t>(time), 32);
    series_ = newest_ = (newest_ + 1) % 4;
    last_[series_] = time;
    usual_[series_] = 0;
    unusual_[series_] = 0;
  }

  void go_on(LazEncoder& encoder, std::int64_t time) {
    const auto step = static_cast<std::int32_t>(step_to(time, series_));
    last_[series_] = time;
    std::int32_t& usual = usual_[series_];
    if (usual == 0) {
      encoder.encode(first_steps_, 0);
      steps_.encode(encoder, 0, step, 0);
      usual = step;
      unusual_[series_] = 0;
      return;
    }
    const double ratio = static_cast<double>(step) / usual;
    const int multiple = static_cast<int>(std::lround(std::fmin(std::fmax(ratio, least), most)));
    encoder.encode(multiples_, static_cast<std::size_t>(multiple >= 0 ? multiple : most - multiple));
    const auto expected =
        static_cast<std::int32_t>(static_cast<std::uint32_t>(multiple) * static_cast<std::uint32_t>(usual));
    steps_.encode(encoder, expected, step, context_of(multiple));
    if (multiple == 1) unusual_[series_] = 0;
    if (multiple != 0 && multiple != least && multiple != most) return;
    if (++unusual_[series_] <= 3) return;
    usual = step;
    unusual_[series_] = 0;
  }

  [[nodiscard]] static constexpr std::size_t context_of(int multiple) noexcept {
    if (multiple == 1) return 1;
    if (multiple > 0) return multiple < 10 ? 2 : multiple < most ? 3 : 4;
    if (multiple < 0) return multiple > least ? 5 : 6;
    return 7;
  }

  LazModel<5> first_steps_;  // without a usual step: a step, a new series, one of the others
  LazModel<symbols> multiples_;
  LazIntegers steps_{32, 9};
  std::array<std::int64_t, 4> last_{};
  std::array<std::int32_t, 4> usual_{};
  std::array<unsigned, 4> unusual_{};  // steps nearly in a row that were unlike the usual one
  std::size_t series_ = 0, newest_ = 0;
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
