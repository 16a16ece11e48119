// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_GEOTIFF_SAMPLES_HPP
#define PULSECAST_IO_DETAIL_GEOTIFF_SAMPLES_HPP

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

#include <pulsecast/base/namespace.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Half-precision number as its bits.
enum class Half : std::uint16_t {};

/// Converts a half-precision number. Source: IEEE 754-2019, 3.4, binary16.
[[nodiscard]] inline float from_half(std::uint16_t half) noexcept {
  const int exponent = half >> 10 & 0x1F;
  const auto fraction = static_cast<float>(half & 0x3FF);
  float value = 0;
  if (exponent == 31)
    value = fraction == 0 ? std::numeric_limits<float>::infinity() : std::numeric_limits<float>::quiet_NaN();
  else
    value = exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);
  return (half & 0x8000) != 0 ? -value : value;
}

/// Value of the sample that begins at a byte.
template <class Sample>
[[nodiscard]] double sample_at(const unsigned char* bytes) noexcept {
  if constexpr (std::is_same_v<Sample, Half>) {
    std::uint16_t half = 0;
    std::memcpy(&half, bytes, sizeof half);
    return static_cast<double>(from_half(half));
  } else {
    Sample sample{};
    std::memcpy(&sample, bytes, sizeof sample);
    return static_cast<double>(sample);
  }
}

/// True for the value of missing heights, which may be written with more digits than a single-precision sample has.
template <class Sample>
[[nodiscard]] bool is_missing(double value, double missing) noexcept {
  if constexpr (std::is_same_v<Sample, float>)
    return value == missing || static_cast<float>(value) == static_cast<float>(missing);
  return value == missing;
}

/// True for numbers that often mark missing heights. Source: Esri, NODATA_value (-9999); Rodriguez et al. 2005, An
/// assessment of the SRTM topographic products, JPL D-31639 (-32768); GDAL manual, DTED driver (-32767).
[[nodiscard]] inline bool may_be_missing(double value) noexcept {
  return value == -9999 || value == -32768 || value == -32767 || value == -99999 || value == -999999;
}

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
