// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SHAPE_DETAIL_PACKED_NUMBERS_HPP
#define PULSECAST_SHAPE_DETAIL_PACKED_NUMBERS_HPP

#include <pulsecast/base/shared_array.hpp>

namespace PULSECAST_NAMESPACE::detail {

/// Numbers from 0 to 255 in 1, 2, 4 or 8 bits each, as the greatest needs; in none where all are 0.
class PackedNumbers {
 public:
  PackedNumbers() = default;
  explicit PackedNumbers(const std::vector<std::uint8_t>& numbers) {
    if (!numbers.empty()) most_ = *std::max_element(numbers.begin(), numbers.end());
    if (most_ == 0) return;
    while (most_ >> (1U << shift_) != 0) ++shift_;
    std::vector<std::uint8_t> bytes(bytes_of(numbers.size()));
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      std::uint8_t& byte = bytes[(i << shift_) / 8];
      byte = static_cast<std::uint8_t>(byte | numbers[i] << ((i << shift_) % 8));
    }
    bytes_ = std::move(bytes);
  }

  void archive(auto& a) { a(bytes_, shift_, most_); }
  /// True if there are `size` numbers, none above the greatest.
  [[nodiscard]] bool is_consistent(std::size_t size) const noexcept {
    if (bytes_.empty()) return most_ == 0;
    if (shift_ > 3 || bytes_.size() != bytes_of(size)) return false;
    for (std::size_t i = 0; i < size; ++i)
      if ((*this)[i] > most_) return false;
    return true;
  }

  [[nodiscard]] std::uint32_t operator[](std::size_t i) const noexcept {
    const std::size_t bit = i << shift_;
    return bytes_.empty() ? 0 : bytes_[bit / 8] >> bit % 8 & ((1U << (1U << shift_)) - 1);
  }
  [[nodiscard]] std::uint32_t greatest() const noexcept { return most_; }
  [[nodiscard]] std::size_t memory() const noexcept { return bytes_.memory(); }  ///< [byte]

 private:
  [[nodiscard]] std::size_t bytes_of(std::size_t size) const noexcept { return ((size << shift_) + 7) / 8; }

  SharedArray<std::uint8_t> bytes_;
  std::uint32_t shift_ = 0;  ///< log2 of the bits of a number
  std::uint32_t most_ = 0;   ///< greatest number
};

}  // namespace PULSECAST_NAMESPACE::detail

#endif
