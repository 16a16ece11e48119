// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <pulsecast/geometry/ray.hpp>
#include <pulsecast/geometry/triangle.hpp>

/// Arithmetic of some 32 digits, for references where closed forms in double precision fail.
namespace pulsecast::support {

/// A number as the sum of two doubles, the second below half a unit in the last place of the first. Sums and products
/// are right to 2^-100. Source: Dekker 1971; Knuth 1998, sec. 4.2.2.
struct DoubleDouble {
  double high = 0, low = 0;

  DoubleDouble() = default;
  DoubleDouble(double value) noexcept : high(value) {}  // NOLINT(google-explicit-constructor): every double is one
  DoubleDouble(double a, double b) noexcept : high(a + b), low(rest_of_sum(a, b, high)) {}

  explicit operator double() const noexcept { return high + low; }

  friend DoubleDouble operator-(const DoubleDouble& a) noexcept { return {-a.high, -a.low}; }
  friend DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) noexcept {
    const DoubleDouble highs(a.high, b.high), lows(a.low, b.low);
    const DoubleDouble sum(highs.high, highs.low + lows.high);
    return {sum.high, sum.low + lows.low};
  }
  friend DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) noexcept { return a + -b; }
  friend DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) noexcept {
    const double product = a.high * b.high;
    return {product, std::fma(a.high, b.high, -product) + (a.high * b.low + a.low * b.high)};
  }
  friend DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) noexcept {
    const DoubleDouble first = a.high / b.high, rest = a - first * b;
    const DoubleDouble second = rest.high / b.high, end = rest - second * b;
    return first + second + end.high / b.high;
  }
  friend bool operator<(const DoubleDouble& a, const DoubleDouble& b) noexcept {
    return a.high < b.high || (a.high == b.high && a.low < b.low);
  }

 private:
  static double rest_of_sum(double a, double b, double sum) noexcept {
    const double part = sum - a;
    return (a - (sum - part)) + (b - part);
  }
};

/// A vector of such numbers.
struct ExactVec3 {
  DoubleDouble x, y, z;

  ExactVec3(const DoubleDouble& a, const DoubleDouble& b, const DoubleDouble& c) noexcept : x(a), y(b), z(c) {}
  explicit ExactVec3(const Vec3& v) noexcept : x(v.x), y(v.y), z(v.z) {}
  /// a - b without any rounding.
  ExactVec3(const Vec3& a, const Vec3& b) noexcept : x(a.x, -b.x), y(a.y, -b.y), z(a.z, -b.z) {}

  explicit operator Vec3() const noexcept {
    return {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
  }
  friend ExactVec3 operator+(const ExactVec3& a, const ExactVec3& b) noexcept {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend ExactVec3 operator-(const ExactVec3& a, const ExactVec3& b) noexcept {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend ExactVec3 operator*(const ExactVec3& a, const DoubleDouble& s) noexcept { return {a.x * s, a.y * s, a.z * s}; }
};
[[nodiscard]] inline DoubleDouble dot(const ExactVec3& a, const ExactVec3& b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
[[nodiscard]] inline ExactVec3 cross(const ExactVec3& a, const ExactVec3& b) noexcept {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Where a ray, taken as a line, crosses a triangle's plane.
struct ExactCrossing {
  DoubleDouble range = std::numeric_limits<double>::quiet_NaN();  ///< [m]; no number if there is no such place
  double inside = 0;    ///< how far from the nearest edge, as a line, and to its inner side; negative outside [m]
  double sine = 0;      ///< of the angle between ray and plane
  double distance = 0;  ///< of the farthest corner from the ray's origin [m]
  double aspect = 0;    ///< how often the longest edge is longer than the triangle is wide
};

/// The corners are taken for exact. Range is in lengths of the direction.
[[nodiscard]] inline ExactCrossing exact_crossing(const Triangle& t, const ExactVec3& origin,
                                                  const ExactVec3& direction) noexcept {
  const ExactVec3 corners[3] = {ExactVec3(t.a) - origin, ExactVec3(t.b) - origin, ExactVec3(t.c) - origin};
  const ExactVec3 normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
  const DoubleDouble slope = dot(normal, direction);
  const double area = length(Vec3(normal));
  ExactCrossing crossing;
  for (const ExactVec3& corner : corners) crossing.distance = std::max(crossing.distance, length(Vec3(corner)));
  if (!(area > 0) || static_cast<double>(slope) == 0) return crossing;
  crossing.range = dot(normal, corners[0]) / slope;
  crossing.sine = std::fabs(static_cast<double>(slope)) / area / length(Vec3(direction));
  crossing.inside = std::numeric_limits<double>::infinity();
  double longest = 0;
  const ExactVec3 at = direction * crossing.range;
  for (int k = 0; k < 3; ++k) {
    const ExactVec3 edge = corners[(k + 1) % 3] - corners[k];
    const double off = static_cast<double>(dot(cross(normal, edge), at - corners[k])) / (area * length(Vec3(edge)));
    crossing.inside = std::min(crossing.inside, off);
    longest = std::max(longest, length(Vec3(edge)));
  }
  crossing.aspect = longest * longest / area;
  return crossing;
}

/// The ray, too, is taken for exact.
[[nodiscard]] inline ExactCrossing exact_crossing(const Triangle& t, const Ray& ray) noexcept {
  return exact_crossing(t, ExactVec3(ray.origin), ExactVec3(ray.direction));
}

}  // namespace pulsecast::support
