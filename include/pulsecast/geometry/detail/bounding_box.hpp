// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_GEOMETRY_DETAIL_BOUNDING_BOX_HPP
#define PULSECAST_GEOMETRY_DETAIL_BOUNDING_BOX_HPP

#include <algorithm>
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
  [[nodiscard]] BoundingBox<Real> at(std::size_t place) const noexcept {
    return {{min[0][place], min[1][place], min[2][place]}, {max[0][place], max[1][place], max[2][place]}};
  }
};

}  // namespace PULSECAST_NAMESPACE

#endif
