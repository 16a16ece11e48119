// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_BASE_VECTOR_HPP
#define PULSECAST_BASE_VECTOR_HPP

#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>

#include <glm/ext/matrix_double3x3.hpp>
#include <glm/ext/quaternion_double.hpp>
#include <glm/ext/quaternion_geometric.hpp>
#include <glm/ext/quaternion_trigonometric.hpp>
#include <glm/ext/vector_double2.hpp>
#include <glm/ext/vector_double3.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <pulsecast/base/namespace.hpp>

// GLM's own functions have one name for all orders of a quaternion's parts: files that differ in it
// must not be linked. Linkers accept an absolute symbol many times if it has one value.
#if defined(__ELF__)
#if defined(GLM_FORCE_QUAT_DATA_WXYZ) || defined(GLM_FORCE_QUAT_DATA_XYZW)
__asm__(".globl pulsecast_order_of_quaternion_data\n.set pulsecast_order_of_quaternion_data, 1");
#else
__asm__(".globl pulsecast_order_of_quaternion_data\n.set pulsecast_order_of_quaternion_data, 0");
#endif
#if defined(GLM_FORCE_QUAT_CTOR_XYZW)
__asm__(".globl pulsecast_order_of_quaternion_constructors\n.set pulsecast_order_of_quaternion_constructors, 1");
#else
__asm__(".globl pulsecast_order_of_quaternion_constructors\n.set pulsecast_order_of_quaternion_constructors, 0");
#endif
#endif

/// Vectors and rotations. GLM is named in this header only.
namespace PULSECAST_NAMESPACE {

// Packed, whatever alignment a program selects for GLM; constexpr only where GLM is.
using Vec2 = glm::vec<2, double, glm::packed_highp>;  ///< vector in two dimensions
using Vec3 = glm::vec<3, double, glm::packed_highp>;  ///< vector in three dimensions

/// Rotation as a unit quaternion; `rotation * vector` rotates the vector.
using Rotation = glm::qua<double, glm::packed_highp>;

static_assert(std::is_trivially_copyable_v<Vec3> && std::is_trivially_copyable_v<Rotation>,
              "vectors must be copied as memory: compile without GLM_FORCE_CTOR_INIT, GLM_FORCE_CXX98, "
              "GLM_FORCE_CXX03, GLM_FORCE_CXX_UNKNOWN");

using glm::conjugate;
using glm::cross;
using glm::dot;
using glm::length;
using glm::normalize;
using std::numbers::pi;
namespace detail {
inline constexpr double infinity = std::numeric_limits<double>::infinity();
}

namespace axis {
inline GLM_CONSTEXPR const Vec3 right{1, 0, 0};    ///< +x: east in the world
inline GLM_CONSTEXPR const Vec3 forward{0, 1, 0};  ///< +y: north, or along a beam
inline GLM_CONSTEXPR const Vec3 up{0, 0, 1};       ///< +z
}  // namespace axis

namespace detail {
/// Rotation of a unit quaternion. GLM_FORCE_QUAT_CTOR_XYZW reorders the parts of constructors.
[[nodiscard]] inline GLM_CONSTEXPR Rotation rotation_wxyz(double w, double x, double y, double z) noexcept {
  Rotation rotation{};
  rotation.w = w;
  rotation.x = x;
  rotation.y = y;
  rotation.z = z;
  return rotation;
}
}  // namespace detail

inline const Rotation no_rotation = detail::rotation_wxyz(1, 0, 0, 0);  ///< identity rotation

/// Right-handed rotation about an axis of any length but zero, by an angle [rad].
[[nodiscard]] inline Rotation rotation_about(const Vec3& axis, double angle) noexcept {
  return glm::angleAxis(angle, normalize(axis));
}

/// Rotation vector of a unit quaternion: axis times angle, by the smaller angle [rad].
[[nodiscard]] inline Vec3 rotation_vector(const Rotation& rotation) noexcept {
  const Vec3 half{rotation.x, rotation.y, rotation.z};
  const double sine = length(half), angle = 2 * std::atan2(sine, std::fabs(rotation.w));
  return (sine > 0 ? std::copysign(angle / sine, rotation.w) : 2) * half;
}

/// Rotation of a rotation vector [rad]. Inverse of `rotation_vector`.
[[nodiscard]] inline Rotation rotation_by(const Vec3& vector) noexcept {
  const double angle = length(vector);
  return angle > 0 ? rotation_about(vector, angle) : no_rotation;
}

/// Rotation matrix: columns are the rotated x, y, z. Cheaper than a quaternion for several vectors.
using Matrix3 = glm::mat<3, 3, double, glm::packed_highp>;
/// Matrix of a unit quaternion.
[[nodiscard]] inline Matrix3 matrix_of(const Rotation& rotation) noexcept { return glm::mat3_cast(rotation); }
/// Rotation of a matrix; unit if the columns are unit and at right angles.
[[nodiscard]] inline Rotation rotation_of(const Matrix3& matrix) noexcept { return glm::quat_cast(matrix); }

/// True if no component is infinite or NaN.
[[nodiscard]] inline bool finite(const Vec3& v) noexcept {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Component-wise minimum.
[[nodiscard]] inline Vec3 min(const Vec3& a, const Vec3& b) noexcept {
  return {a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z};
}

/// Component-wise maximum.
[[nodiscard]] inline Vec3 max(const Vec3& a, const Vec3& b) noexcept {
  return {a.x > b.x ? a.x : b.x, a.y > b.y ? a.y : b.y, a.z > b.z ? a.z : b.z};
}

/// True if no component is beyond `limit` in magnitude, or not a number.
[[nodiscard]] inline bool is_within(const Vec3& v, double limit) noexcept {
  return std::fabs(v.x) <= limit && std::fabs(v.y) <= limit && std::fabs(v.z) <= limit;
}

/// Maximum norm: largest magnitude of a component. Components that are not numbers may not count.
[[nodiscard]] inline double max_norm(const Vec3& v) noexcept {
  const Vec3 m = max(v, -v);
  const double xy = m.x > m.y ? m.x : m.y;
  return xy > m.z ? xy : m.z;
}

}  // namespace PULSECAST_NAMESPACE

#endif
