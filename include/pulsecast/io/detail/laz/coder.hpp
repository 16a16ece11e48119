// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_LAZ_CODER_HPP
#define PULSECAST_IO_DETAIL_LAZ_CODER_HPP

#include <algorithm>
#include <bit>
#include <cstring>
#include <span>
#include <vector>

#include <pulsecast/base/require.hpp>

/// Arithmetic coder of LAZ. Source: Said 2004, Introduction to Arithmetic Coding, 2.2 and 3; of
/// constants: Isenburg 2013, LASzip, and its files.
namespace PULSECAST_NAMESPACE::io::detail {

/// Adaptive frequency model of some symbols. Updates of the shares become rarer while coding.
template <std::size_t Capacity = 256>
class LazModel {
 public:
  static constexpr unsigned share_bits = 15;

  explicit LazModel(std::size_t symbols = Capacity) noexcept
      : symbols_(static_cast<std::uint32_t>(symbols)), cycle_(symbols_) {
    PULSECAST_ASSERT(symbols >= 2 && symbols <= Capacity);
    std::fill_n(count_.begin(), symbols, std::uint16_t{1});
    renew();
    until_renewal_ = cycle_ = (symbols_ + 6) / 2;
  }

  /// Cumulative share of the symbols below this one, in 2^-15; that of the last ends at 1.
  [[nodiscard]] std::uint32_t below(std::size_t symbol) const noexcept { return below_[symbol]; }
  [[nodiscard]] bool last(std::size_t symbol) const noexcept { return symbol + 1 == symbols_; }

  /// Symbol with a share, in 2^-15; the last one beyond 1.
  [[nodiscard]] unsigned at(std::uint32_t share) noexcept {
    if (!has_starts_) find_starts();
    share = std::min(share, (1U << share_bits) - 1);
    unsigned symbol = start_[share >> start_bits];
    while (below_[symbol + 1] <= share) ++symbol;
    return symbol;
  }

  void learn(std::size_t symbol) noexcept {
    ++count_[symbol];
    if (--until_renewal_ == 0) renew();
  }

 private:
  void renew() noexcept {
    if ((total_ += cycle_) > 1U << share_bits) {
      total_ = 0;
      for (std::size_t i = 0; i < symbols_; ++i) total_ += count_[i] = static_cast<std::uint16_t>((count_[i] + 1) / 2);
    }
    const std::uint32_t scale = (1U << 31) / total_;
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < symbols_; ++i) {
      below_[i] = static_cast<std::uint16_t>(scale * sum >> (31 - share_bits));
      sum += count_[i];
    }
    has_starts_ = false;
    until_renewal_ = cycle_ = std::min(5 * cycle_ / 4, 8 * (symbols_ + 6));
  }

  void find_starts() noexcept {
    below_[symbols_] = 0xFFFF;  // ends a search
    unsigned symbol = 0;
    for (std::uint32_t i = 0; i < start_.size(); ++i) {
      while (below_[symbol + 1] <= i << start_bits) ++symbol;
      start_[i] = static_cast<std::uint16_t>(symbol);
    }
    has_starts_ = true;
  }

  std::uint32_t symbols_, cycle_, total_ = 0, until_renewal_ = 0;
  std::array<std::uint16_t, Capacity + 1> below_;
  std::array<std::uint16_t, Capacity> count_;
  static constexpr unsigned start_bits = share_bits - 6;
  std::array<std::uint16_t, 64> start_;  // symbol at each 64th of the shares, for decoders
  bool has_starts_ = false;
};

class LazBitModel {
 public:
  static constexpr unsigned share_bits = 13;

  /// Share of 0, in 2^-13.
  [[nodiscard]] std::uint32_t of_zero() const noexcept { return of_zero_; }

  void learn(bool bit) noexcept {
    zeros_ += bit ? 0U : 1U;
    if (--until_renewal_ != 0) return;
    if ((total_ += cycle_) > 1U << share_bits) {
      total_ = (total_ + 1) / 2;
      zeros_ = (zeros_ + 1) / 2;
      if (zeros_ == total_) ++total_;
    }
    of_zero_ = (1U << 31) / total_ * zeros_ >> (31 - share_bits);
    until_renewal_ = cycle_ = std::min(5 * cycle_ / 4, 64U);
  }

 private:
  std::uint32_t zeros_ = 1, total_ = 2, of_zero_ = 1U << (share_bits - 1), cycle_ = 4, until_renewal_ = 4;
};

/// Arithmetic encoder: the bytes are a number in [0, 1), and each symbol narrows its interval. As for `LazDecoder`,
/// what is coded is returned: laws of coding are functions of either.
class LazEncoder {
 public:
  static constexpr bool encodes = true;

  template <std::size_t Capacity>
  unsigned code(LazModel<Capacity>& model, unsigned symbol) {
    const std::uint32_t unit = length_ >> LazModel<Capacity>::share_bits, low = unit * model.below(symbol);
    narrow(low, (model.last(symbol) ? length_ : unit * model.below(symbol + 1)) - low);
    model.learn(symbol);
    return symbol;
  }

  bool code(LazBitModel& model, bool bit) {
    const std::uint32_t zero = (length_ >> LazBitModel::share_bits) * model.of_zero();
    narrow(bit ? zero : 0, bit ? length_ - zero : zero);
    model.learn(bit);
    return bit;
  }

  /// Codes the lowest `count` bits of a number, from 1 to 32, as equally likely; others are 0.
  std::uint32_t code_bits(std::uint32_t value, unsigned count) {
    const std::uint32_t all = value;
    if (count > 19) {  // more would exceed the interval
      code_bits(value & 0xFFFFU, 16);
      value >>= 16;
      count -= 16;
    }
    const std::uint32_t unit = length_ >> count;
    narrow(unit * value, unit);
    return all;
  }

  /// Bytes of all coded symbols; bytes after them do not matter.
  [[nodiscard]] std::vector<std::byte> finish() && {
    const std::uint32_t gap = (0U - base_) & 0xFFFFFFU;  // to 24 zeros: length_ >= 2^24
    base_ += gap;
    if (base_ < gap) carry();
    out_.resize(size_);
    out_.push_back(static_cast<std::byte>(base_ >> 24));
    out_.resize(size_ + 4);  // decoders read four bytes ahead
    return std::move(out_);
  }

 private:
  void narrow(std::uint32_t low, std::uint32_t length) {
    const std::uint32_t base = base_ + low;
    if (base < low) carry();
    if (size_ + 4 > out_.size()) out_.resize(std::max<std::size_t>(2 * out_.size(), 1024));
    std::array<std::byte, 4> bytes{};
    for (unsigned i = 0; i < 4; ++i) bytes[i] = static_cast<std::byte>(base >> (24 - 8 * i));
    std::memcpy(out_.data() + size_, bytes.data(), bytes.size());
    const unsigned done = static_cast<unsigned>(std::countl_zero(length)) & 24U;  // settled
    size_ += done / 8;
    base_ = base << done;
    length_ = length << done;
  }

  void carry() noexcept {
    std::size_t at = size_ - 1;
    for (; out_[at] == std::byte{255}; --at) out_[at] = std::byte{0};
    out_[at] = static_cast<std::byte>(std::to_integer<unsigned>(out_[at]) + 1);
  }

  std::uint32_t base_ = 0, length_ = 0xFFFFFFFFU;
  std::vector<std::byte> out_;
  std::size_t size_ = 0;
};

/// Arithmetic decoder; values to be coded are ignored. Bytes beyond the end are 0, and any bytes give symbols.
class LazDecoder {
 public:
  static constexpr bool encodes = false;

  LazDecoder() = default;
  explicit LazDecoder(std::span<const std::byte> bytes) noexcept : rest_(bytes) { take(4); }

  template <std::size_t Capacity>
  unsigned code(LazModel<Capacity>& model, unsigned /*symbol*/ = 0) noexcept {
    const std::uint32_t unit = length_ >> LazModel<Capacity>::share_bits;
    const unsigned symbol = model.at(value_ / unit);
    const std::uint32_t low = unit * model.below(symbol);
    narrow(low, (model.last(symbol) ? length_ : unit * model.below(symbol + 1)) - low);
    model.learn(symbol);
    return symbol;
  }

  bool code(LazBitModel& model, bool /*bit*/ = false) noexcept {
    const std::uint32_t zero = (length_ >> LazBitModel::share_bits) * model.of_zero();
    const bool bit = value_ >= zero;
    narrow(bit ? zero : 0, bit ? length_ - zero : zero);
    model.learn(bit);
    return bit;
  }

  std::uint32_t code_bits(std::uint32_t /*value*/, unsigned count) noexcept {
    if (count > 19) {
      const std::uint32_t low = code_bits(0, 16);
      return code_bits(0, count - 16) << 16 | low;
    }
    const std::uint32_t unit = length_ >> count, value = std::min(value_ / unit, (1U << count) - 1);
    narrow(unit * value, unit);
    return value;
  }

  /// True if more bytes were taken than there are and encoders leave out.
  [[nodiscard]] bool is_beyond_end() const noexcept { return missing_ > 4; }

 private:
  void narrow(std::uint32_t low, std::uint32_t length) noexcept {
    const auto done = static_cast<unsigned>(std::countl_zero(length)) & 24U;
    value_ -= low;
    length_ = length << done;
    take(done / 8);
  }

  void take(unsigned bytes) noexcept {
    for (; bytes > 0; --bytes) {
      value_ <<= 8;
      if (rest_.empty()) {
        ++missing_;
        continue;
      }
      value_ |= std::to_integer<std::uint32_t>(rest_.front());
      rest_ = rest_.subspan(1);
    }
  }

  std::span<const std::byte> rest_;
  std::uint32_t value_ = 0, length_ = 0xFFFFFFFFU;
  std::size_t missing_ = 0;
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
