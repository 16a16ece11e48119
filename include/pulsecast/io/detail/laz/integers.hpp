// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_LAZ_INTEGERS_HPP
#define PULSECAST_IO_DETAIL_LAZ_INTEGERS_HPP

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <pulsecast/io/detail/laz/coder.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Coder of integers as corrections to a prediction. First comes the bit length of the correction, by a model for each
/// context, then its rank among corrections of that length, with its highest eight bits modelled. Source: Isenburg
/// 2013, LASzip, 4 (Entropy coding).
class LazIntegers {
 public:
  /// `bits` of the integers, 16 or 32; number of contexts.
  LazIntegers(unsigned bits, std::size_t contexts) : bits_(bits), lengths_(contexts, LazModel<33>(bits + 1)) {
    for (unsigned k = 1; k <= bits; ++k) corrections_.emplace_back(std::size_t{1} << std::min(k, modelled_bits));
  }

  /// Encodes a number; 16-bit ones may be signed or unsigned. Arithmetic wraps around.
  void encode(LazEncoder& encoder, std::int32_t expected, std::int32_t number, std::size_t context = 0) {
    auto correction =
        static_cast<std::int32_t>(static_cast<std::uint32_t>(number) - static_cast<std::uint32_t>(expected));
    if (bits_ == 16) correction = static_cast<std::int16_t>(correction);
    // corrections of k bits are those in [1 - 2^k, -2^(k-1)] and [2^(k-1) + 1, 2^k]; with k = 0, 0 and 1
    const auto size = static_cast<std::uint32_t>(correction > 0 ? correction - 1 : -std::int64_t{correction});
    length_ = static_cast<unsigned>(std::bit_width(size));
    encoder.encode(lengths_[context], length_);
    if (length_ == 0) return encoder.encode(zero_or_one_, correction == 1);
    if (length_ == 32) return;  // a single one: -2^31
    const std::uint32_t place =
        correction > 0 ? size : (1U << length_) - 1 - size;  // index among those of its length, from 0
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

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
