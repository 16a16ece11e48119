// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <numbers>

#include <glm/ext/matrix_double3x3.hpp>
#include <glm/ext/quaternion_double.hpp>
#include <glm/ext/quaternion_geometric.hpp>
#include <glm/ext/quaternion_trigonometric.hpp>
#include <glm/ext/vector_double2.hpp>
#include <glm/ext/vector_double3.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <pulsecast/base/arithmetic.hpp>

/// Vectors and rotations. GLM is named in this header only.
namespace pulsecast {

// packed, and constexpr only where GLM is: a program may tell GLM to align its own vectors, and to use intrinsics
using Vec2 = glm::vec<2, double, glm::packed_highp>;
using Vec3 = glm::vec<3, double, glm::packed_highp>;

/// A rotation as a unit quaternion; `rotation * vector` turns the vector.
using Rotation = glm::qua<double, glm::packed_highp>;

using glm::conjugate;
using glm::cross;
using glm::dot;
using glm::length;
using glm::normalize;
using std::numbers::pi;

namespace axis {
inline GLM_CONSTEXPR const Vec3 right{1, 0, 0};    ///< +x of the world (east), a body and an instrument
inline GLM_CONSTEXPR const Vec3 forward{0, 1, 0};  ///< +y: north, and where a beam leaves
inline GLM_CONSTEXPR const Vec3 up{0, 0, 1};       ///< +z
}  // namespace axis

inline const Rotation no_rotation{1, 0, 0, 0};

/// The right-handed rotation about an axis of any length but zero, by an angle [rad].
[[nodiscard]] inline Rotation rotation_about(const Vec3& axis, double angle) noexcept { return glm::angleAxis(angle, normalize(axis)); }

/// The columns are where x, y and z are turned to; it costs less than the rotation where more than one vector is to be turned.
using Matrix3 = glm::mat<3, 3, double, glm::packed_highp>;
[[nodiscard]] inline Matrix3 matrix_of(const Rotation& rotation) noexcept { return glm::mat3_cast(rotation); }

[[nodiscard]] inline bool finite(const Vec3& v) noexcept { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

[[nodiscard]] inline Vec3 min(const Vec3& a, const Vec3& b) noexcept {
  return {a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z};
}

[[nodiscard]] inline Vec3 max(const Vec3& a, const Vec3& b) noexcept {
  return {a.x > b.x ? a.x : b.x, a.y > b.y ? a.y : b.y, a.z > b.z ? a.z : b.z};
}

/// The largest of the three magnitudes.
[[nodiscard]] inline double max_norm(const Vec3& v) noexcept {
  const Vec3 m = max(v, -v);
  const double xy = m.x > m.y ? m.x : m.y;
  return xy > m.z ? xy : m.z;
}

}  // namespace pulsecast
