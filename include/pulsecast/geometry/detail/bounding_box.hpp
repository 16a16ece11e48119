// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_GEOMETRY_DETAIL_BOUNDING_BOX_HPP
#define PULSECAST_GEOMETRY_DETAIL_BOUNDING_BOX_HPP

#include <algorithm>
#include <bit>
#include <concepts>
#include <iterator>

#include <pulsecast/base/simd.hpp>
#include <pulsecast/geometry/box.hpp>

namespace PULSECAST_NAMESPACE {

namespace detail {
/// Next greater number after finite r, as `std::nextafter` returns it, but without a call.
template <std::floating_point Real>
[[nodiscard]] Real next_above(Real r) noexcept {
  using Bits = std::conditional_t<sizeof(Real) == 4, std::int32_t, std::int64_t>;
  if (r == 0) return std::numeric_limits<Real>::denorm_min();
  return std::bit_cast<Real>(static_cast<Bits>(std::bit_cast<Bits>(r) + (r > 0 ? 1 : -1)));
}
}  // namespace detail

/// Least number of type Real that is not less than `value`.
template <std::floating_point Real>
[[nodiscard]] Real round_up(double value) noexcept {
  const Real r = static_cast<Real>(value);
  return static_cast<double>(r) < value ? detail::next_above(r) : r;
}

/// Greatest number of type Real that is not greater than `value`.
template <std::floating_point Real>
[[nodiscard]] Real round_down(double value) noexcept {
  return -round_up<Real>(-value);
}

/// Box of type Real, relative to the centre of an accelerator; rounded outwards, so never smaller.
template <std::floating_point Real>
struct BoundingBox {
  Real min[3], max[3];  ///< lower and upper walls by axis [m]

  /// Box around `box` [m], relative to `centre` [m].
  static BoundingBox around(const Box& box, const Vec3& centre) noexcept {
    constexpr double growing = 1 + 0x1p-51, shrinking = 1 - 0x1p-51;
    BoundingBox b;
    for (int k = 0; k < 3; ++k) {
      // the subtraction rounds by half an ulp; a factor leaves an empty box empty
      const double low = box.min[k] - centre[k], high = box.max[k] - centre[k];
      b.min[k] = round_down<Real>(low * (low > 0 ? shrinking : growing));
      b.max[k] = round_up<Real>(high * (high > 0 ? growing : shrinking));
    }
    return b;
  }
};

/// Eight boxes as structure of arrays. A free slot holds an inverted box: nothing is inside.
template <std::floating_point Real>
struct Box8 {
  alignas(8 * sizeof(Real)) Real min[3][8], max[3][8];  ///< lower and upper walls by axis [m]

  Box8() noexcept {
    constexpr Real most = std::numeric_limits<Real>::max();
    for (auto& side : min) std::fill(std::begin(side), std::end(side), most);
    for (auto& side : max) std::fill(std::begin(side), std::end(side), -most);
  }

  void put(std::size_t place, const BoundingBox<Real>& box) noexcept {
    for (std::size_t k = 0; k < 3; ++k) {
      min[k][place] = box.min[k];
      max[k][place] = box.max[k];
    }
  }
};

/// Up to eight boxes in half the memory, each rounded outwards to a grid of 65,536 steps an axis.
/// Source: Mahovsky & Wyvill 2006; Ylitie, Karras & Laine 2017.
template <std::floating_point Real>
struct QuantizedBox8 {
  std::uint16_t walls[3][2][8];  ///< grid coordinates by axis; lower walls first
  Real origin[3];                ///< origin of the grid [m]
  std::uint8_t exponent[3];      ///< binary exponent of the grid's step [m], biased by 127
  std::uint8_t count = 0;        ///< number of slots that hold a box, the first ones

  QuantizedBox8() noexcept {}  // leaves all but `count` uninitialized

  /// Sets up the grid; `around` encloses all boxes to be added.
  void begin(const BoundingBox<Real>& around) noexcept {
    for (std::size_t k = 0; k < 3; ++k) {
      const double extent = static_cast<double>(around.max[k]) - static_cast<double>(around.min[k]);
      // exponent of a power of two above the ratio, as of `std::frexp`; of a subnormal one, too low
      const auto e = static_cast<int>(std::bit_cast<std::uint64_t>(extent / (steps - 1)) >> 52U) - 1022;
      origin[k] = around.min[k];
      exponent[k] = static_cast<std::uint8_t>(127 + (extent > 0 ? std::max(e, min_exponent) : min_exponent));
      for (auto& side : walls[k]) std::fill(std::begin(side), std::end(side), std::uint16_t{0});
    }
    count = 0;
  }

  /// Appends a box, in the slot `count`.
  void add(const BoundingBox<Real>& box) noexcept {
    for (std::size_t k = 0; k < 3; ++k) {
      const double start = static_cast<double>(origin[k]), per_step = 1 / static_cast<double>(step(k));
      const double low = (static_cast<double>(box.min[k]) - start) * per_step,
                   high = (static_cast<double>(box.max[k]) - start) * per_step;
      const auto down = static_cast<std::uint32_t>(low), truncated = static_cast<std::uint32_t>(high);
      walls[k][0][count] = static_cast<std::uint16_t>(down);
      walls[k][1][count] = static_cast<std::uint16_t>(truncated + (truncated < high ? 1U : 0U));
    }
    ++count;
  }

  /// Steps of the grid along the axes [m]; the last lane is of no use.
  [[nodiscard]] simd::Vec4<Real> step4() const noexcept {
#if defined(__AVX2__)  // shifts by lane
    if constexpr (sizeof(Real) == 4) {
      using Words = simd::Vec<std::uint32_t, 4>;
      static_assert(offsetof(QuantizedBox8, count) == offsetof(QuantizedBox8, exponent) + 3);
      const Words exponents = Words{} + simd::load<std::uint32_t>(exponent[0]);
      return simd::load<simd::Vec4<Real>>(exponents << Words{23, 15, 7, 0} & 0x7F800000U);
    }
#endif
    return {step(0), step(1), step(2)};
  }
  [[nodiscard]] Real step(std::size_t k) const noexcept {
    if constexpr (sizeof(Real) == 4)
      return std::bit_cast<Real>(std::uint32_t{exponent[k]} << 23);
    else
      return std::bit_cast<Real>((std::uint64_t{exponent[k]} + (1023 - 127)) << 52);
  }

 private:
  static constexpr double steps = 65535;
  static constexpr int min_exponent = -126;
};

}  // namespace PULSECAST_NAMESPACE

#endif
