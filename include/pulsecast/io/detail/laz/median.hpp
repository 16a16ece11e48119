// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_LAZ_MEDIAN_HPP
#define PULSECAST_IO_DETAIL_LAZ_MEDIAN_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <pulsecast/base/namespace.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Running median of five numbers, zeros at first. A new number replaces the greatest until one is not below the
/// median. From then on it replaces the least until one is not above the median. Source: Isenburg 2013, LASzip, 4.1
/// (median of five).
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

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
