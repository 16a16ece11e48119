// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_LAS_BYTES_HPP
#define PULSECAST_IO_DETAIL_LAS_BYTES_HPP

#include <array>
#include <cmath>
#include <cstring>
#include <string_view>

#include <pulsecast/base/namespace.hpp>

/// Byte layout of LAS files. Source of every offset: ASPRS LAS 1.4 R15, or 1.0 where named.
namespace PULSECAST_NAMESPACE::io::detail {

/// Bytes filled in by offsets.
template <class Bytes>
struct LasFields : Bytes {
  template <class Number>
  void put(std::size_t position, Number value) noexcept {
    std::memcpy(this->data() + position, &value, sizeof value);
  }
  void put_text(std::size_t position, std::string_view text) noexcept {
    std::memcpy(this->data() + position, text.data(), text.size());
  }
};
template <std::size_t Size>
using LasBytes = LasFields<std::array<std::byte, Size>>;

/// Nearest integer, clamped to [low, high]; NaN becomes `low`.
template <class Integer>
[[nodiscard]] Integer las_rounded(double value, double low, double high) noexcept {
  return static_cast<Integer>(std::nearbyint(std::fmin(std::fmax(value, low), high)));
}

inline constexpr std::size_t las_vlr_header_size = 54;  ///< [byte]

/// Header of a record with a body of `size` bytes. Source: LAS 1.4 R15, Variable Length Records.
[[nodiscard]] inline auto las_vlr_header(std::string_view user, std::uint16_t record, std::size_t size,
                                         std::string_view description) noexcept {
  LasBytes<las_vlr_header_size> h{};
  h.put_text(2, user);
  h.put(18, record);
  h.put(20, static_cast<std::uint16_t>(size));
  h.put_text(22, description);
  return h;
}

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
