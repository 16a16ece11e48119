// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_STORED_NUMBERS_HPP
#define PULSECAST_IO_DETAIL_STORED_NUMBERS_HPP

#include <pulsecast/io/point_layout.hpp>

/// Numbers of point records, and of columns of points.
namespace PULSECAST_NAMESPACE::io {

static_assert(std::endian::native == std::endian::little, "records hold numbers as they lie in memory");

namespace detail {

/// Writes a number as `Number`: integers are rounded, and limited to their range; NaN becomes 0.
template <class Number>
void store_number(double value, std::byte* to) noexcept {
  Number number;
  if constexpr (std::is_floating_point_v<Number>) {
    number = static_cast<Number>(value);
  } else {
    using Limits = std::numeric_limits<Number>;
    constexpr auto beyond_53_bits = static_cast<std::uint64_t>(Limits::max()) >> 53;
    constexpr double least = static_cast<double>(Limits::min());
    constexpr double most = static_cast<double>(Limits::max() - static_cast<Number>(beyond_53_bits));
    const double whole = std::nearbyint(std::clamp(value, least, most));
    number = std::isnan(value) ? Number{} : static_cast<Number>(whole);
  }
  std::memcpy(to, &number, sizeof number);
}

/// Writes a whole number as an integer, limited to its range.
template <std::integral Number>
void store_whole(std::uint64_t value, std::byte* to) noexcept {
  constexpr std::uint64_t most = std::numeric_limits<Number>::max();
  const auto number = static_cast<Number>(std::min(value, most));
  std::memcpy(to, &number, sizeof number);
}

/// Calls `visit.operator()<Number>()` with a number type. Inlined, as this may be a constant.
template <class Visitor>
[[gnu::always_inline]] inline auto visit_number_type(NumberType type, const Visitor& visit) {
  switch (type) {
    case NumberType::int8:
      return visit.template operator()<std::int8_t>();
    case NumberType::uint8:
      return visit.template operator()<std::uint8_t>();
    case NumberType::int16:
      return visit.template operator()<std::int16_t>();
    case NumberType::uint16:
      return visit.template operator()<std::uint16_t>();
    case NumberType::int32:
      return visit.template operator()<std::int32_t>();
    case NumberType::uint32:
      return visit.template operator()<std::uint32_t>();
    case NumberType::int64:
      return visit.template operator()<std::int64_t>();
    case NumberType::uint64:
      return visit.template operator()<std::uint64_t>();
    case NumberType::float32:
      return visit.template operator()<float>();
    default:
      return visit.template operator()<double>();
  }
}

/// Values of a column of points: of one in `point_columns` by a loop of its own, without calls.
using ColumnLoop = void (*)(std::span<const PointView> points, double* values) noexcept;

template <std::size_t column>
void values_of(std::span<const PointView> points, double* values) noexcept {
  for (const PointView& point : points) *values++ = point_columns[column].get(point);
}

/// Loop of a column; null if it is not in `point_columns`.
[[nodiscard]] inline ColumnLoop loop_of(const PointColumn& column) noexcept {
  constexpr auto loops = []<std::size_t... k>(std::index_sequence<k...>) {
    return std::array<ColumnLoop, sizeof...(k)>{&values_of<k>...};
  }
  (std::make_index_sequence<point_columns.size()>());
  for (std::size_t k = 0; k < loops.size(); ++k)
    if (&point_columns[k] == &column) return loops[k];
  return nullptr;
}

}  // namespace detail

}  // namespace PULSECAST_NAMESPACE::io

#endif
