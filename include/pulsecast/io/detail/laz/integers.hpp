// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_LAZ_INTEGERS_HPP
#define PULSECAST_IO_DETAIL_LAZ_INTEGERS_HPP

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

  /// Codes a number; 16-bit ones may be signed or unsigned, and are decoded modulo 2^16. Arithmetic wraps around.
  template <class Coder>
  std::int32_t code(Coder& coder, std::int32_t expected, std::int32_t number, std::size_t context = 0) {
    std::int32_t correction = laz_step(expected, number);
    if (bits_ == 16) correction = static_cast<std::int16_t>(correction);
    // corrections of k bits: in [1 - 2^k, -2^(k-1)] or [2^(k-1) + 1, 2^k]; with k = 0, 0 and 1
    const std::int64_t above = correction > 0 ? correction - 1 : -std::int64_t{correction};
    const auto size = static_cast<std::uint32_t>(above);
    length_ = coder.code(lengths_[context], static_cast<unsigned>(std::bit_width(size)));
    if (length_ == 0)
      correction = coder.code(zero_or_one_, correction == 1) ? 1 : 0;
    else if (length_ == 32)  // a single one
      correction = std::numeric_limits<std::int32_t>::min();
    else
      correction = of_length(coder, correction > 0 ? size : (1U << length_) - 1 - size);
    return Coder::encodes ? number : laz_step(laz_step(correction, 0), expected);
  }

  /// Bit length of the last correction: a measure of the error to expect of a related number.
  [[nodiscard]] unsigned last_length() const noexcept { return length_; }

 private:
  static constexpr unsigned modelled_bits = 8;

  /// Codes the rank of a correction of 1 to 31 bits.
  template <class Coder>
  std::int32_t of_length(Coder& coder, std::uint32_t rank) {
    LazModel<>& model = corrections_[length_ - 1];
    if (length_ <= modelled_bits) {
      rank = coder.code(model, rank);
    } else {
      const unsigned others = length_ - modelled_bits;
      const std::uint32_t high = coder.code(model, rank >> others);
      rank = high << others | coder.code_bits(rank & ((1U << others) - 1), others);
    }
    const std::uint32_t below = rank >> (length_ - 1) == 0 ? (1U << length_) - 1 : 0xFFFFFFFFU;
    return static_cast<std::int32_t>(rank - below);
  }

  unsigned bits_, length_ = 0;
  std::vector<LazModel<33>> lengths_;
  LazBitModel zero_or_one_;
  std::vector<LazModel<>> corrections_;  // by length, from 1
};

/// Context from a number of bits, rounded down to even and limited; plus 1 for an only return.
[[nodiscard]] inline std::size_t laz_context(unsigned bits, unsigned most, bool only) noexcept {
  return (bits < most ? bits & ~1U : most) + (only ? 1U : 0U);
}

/// Coder of x and y as the median of the last five steps in one of `Series`. Source: Isenburg 2013, LASzip, 4.1.
template <std::size_t Series>
class LazPlane {
 public:
  template <class Coder, class Point>
  void code(Coder& coder, std::size_t series, bool only, const Point& before, Point& p) {
    const std::int32_t dx = x_.code(coder, x_step_[series].value(), laz_step(before.x, p.x), only ? 1 : 0);
    x_step_[series].add(dx);
    const std::size_t context = laz_context(x_.last_length(), 20, only);
    const std::int32_t dy = y_.code(coder, y_step_[series].value(), laz_step(before.y, p.y), context);
    y_step_[series].add(dy);
    p.x = laz_step(laz_step(dx, 0), before.x);
    p.y = laz_step(laz_step(dy, 0), before.y);
  }

  /// Mean bit length of the last corrections.
  [[nodiscard]] unsigned last_length() const noexcept { return (x_.last_length() + y_.last_length()) / 2; }

 private:
  LazIntegers x_{32, 2}, y_{32, 22};
  std::array<LazMedian, Series> x_step_, y_step_;
};

/// Coder of times, as 64-bit patterns: continuations of one of four series, each with its last time and usual step; in
/// version 2 also an equal time. Source: Isenburg 2013, LASzip, 4 (GPSTIME11), and files of version 3.
class LazTimes {
 public:
  explicit LazTimes(std::int64_t first, bool has_equal = false)
      : equal_(has_equal ? 1 : 0), first_steps_(5 + equal_), multiples_(new_series + 4 + equal_) {
    last_[0] = first;
  }

  template <class Coder>
  std::int64_t code(Coder& coder, std::int64_t time) {
    for (;;) {
      const bool is_first = usual_[series_] == 0;
      const unsigned fresh = new_series_kind();
      const unsigned kind = coder.code(is_first ? first_steps_ : multiples_, Coder::encodes ? kind_of(time) : 0);
      if (kind == fresh) return begin_series(coder, time);
      if (kind < fresh && (equal_ == 0 || kind != equal_time_kind())) return go_on(coder, kind, time);
      if (kind < fresh) return last_[series_];
      series_ = (series_ + kind - fresh) % 4;
    }
  }

 private:
  /// Multiples of the usual step: 0 to 499, at least 500, -9 to -1, at most -10; then, in version 2, an equal time; a
  /// new series; the three others.
  static constexpr int most = 500, least = -10;
  static constexpr unsigned new_series = most - least + 1;

  [[nodiscard]] std::int64_t step_to(std::int64_t time, std::size_t series) const noexcept {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(time) - static_cast<std::uint64_t>(last_[series]));
  }
  [[nodiscard]] bool near(std::int64_t time, std::size_t series) const noexcept {
    const std::int64_t step = step_to(time, series);
    return step == static_cast<std::int32_t>(step);
  }

  [[nodiscard]] unsigned equal_time_kind() const noexcept { return usual_[series_] == 0 ? 0 : new_series; }
  [[nodiscard]] unsigned new_series_kind() const noexcept { return equal_ + (usual_[series_] == 0 ? 1 : new_series); }

  [[nodiscard]] unsigned kind_of(std::int64_t time) const noexcept {
    if (equal_ == 1 && time == last_[series_]) return equal_time_kind();
    for (unsigned k = 1; k < 4 && !near(time, series_); ++k)
      if (near(time, (series_ + k) % 4)) return new_series_kind() + k;
    if (!near(time, series_)) return new_series_kind();
    if (usual_[series_] == 0) return equal_;
    const double ratio = static_cast<double>(step_to(time, series_)) / usual_[series_];
    const int multiple = static_cast<int>(std::lround(std::fmin(std::fmax(ratio, least), most)));
    return static_cast<unsigned>(multiple >= 0 ? multiple : most - multiple);
  }

  template <class Coder>
  std::int64_t begin_series(Coder& coder, std::int64_t time) {
    const auto high = [](std::int64_t bits) { return static_cast<std::int32_t>(bits >> 32); };
    const std::int64_t upper = steps_.code(coder, high(last_[series_]), high(time), 8);
    series_ = newest_ = (newest_ + 1) % 4;
    usual_[series_] = 0;
    unusual_[series_] = 0;
    return last_[series_] = upper * (std::int64_t{1} << 32) + coder.code_bits(static_cast<std::uint32_t>(time), 32);
  }

  /// Codes a step, near a multiple of the usual one if there is one.
  template <class Coder>
  std::int64_t go_on(Coder& coder, unsigned kind, std::int64_t time) {
    std::int32_t& usual = usual_[series_];
    const int multiple = usual == 0 ? 0 : kind <= most ? static_cast<int>(kind) : most - static_cast<int>(kind);
    const auto expected =
        static_cast<std::int32_t>(static_cast<std::uint32_t>(multiple) * static_cast<std::uint32_t>(usual));
    const std::int32_t step = steps_.code(coder, expected, static_cast<std::int32_t>(step_to(time, series_)),
                                          usual == 0 ? 0 : context_of(multiple));
    const bool is_unlike = multiple == 0 || multiple == least || multiple == most;
    if (multiple == 1) unusual_[series_] = 0;
    if (usual == 0 || (is_unlike && ++unusual_[series_] > 3)) {
      usual = step;
      unusual_[series_] = 0;
    }
    const auto last = static_cast<std::uint64_t>(last_[series_]) + static_cast<std::uint64_t>(std::int64_t{step});
    return last_[series_] = static_cast<std::int64_t>(last);
  }

  [[nodiscard]] static constexpr std::size_t context_of(int multiple) noexcept {
    if (multiple == 1) return 1;
    if (multiple > 0) return multiple < 10 ? 2 : multiple < most ? 3 : 4;
    if (multiple < 0) return multiple > least ? 5 : 6;
    return 7;
  }

  unsigned equal_;                        // number of symbols for an equal time
  LazModel<new_series + 5> first_steps_;  // without a usual step: an equal time, a step, a new series, the others
  LazModel<new_series + 5> multiples_;
  LazIntegers steps_{32, 9};
  std::array<std::int64_t, 4> last_{};
  std::array<std::int32_t, 4> usual_{};
  std::array<unsigned, 4> unusual_{};  // steps nearly in a row that were unlike the usual one
  std::size_t series_ = 0, newest_ = 0;
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
