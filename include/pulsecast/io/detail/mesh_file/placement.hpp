// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_MESH_FILE_PLACEMENT_HPP
#define PULSECAST_IO_DETAIL_MESH_FILE_PLACEMENT_HPP

#include <cmath>
#include <limits>
#include <optional>

#include <pulsecast/base/vector.hpp>
#include <pulsecast/io/detail/mesh_file/raw_scene.hpp>
#include <pulsecast/scene/part.hpp>

/// Transforms of nodes as placements of parts.
namespace PULSECAST_NAMESPACE::io::detail {

/// Transform as what is applied to the vertices, and then a placement.
struct SplitTransform {
  Matrix3 shape{1};     ///< symmetric, of determinant 1 or -1; the identity for a similarity
  Placement placement;  ///< of the shape
  bool is_similarity = true;
};

/// Greatest absolute entry.
[[nodiscard]] inline double greatest(const Matrix3& m) noexcept {
  double most = 0;
  for (int i = 0; i < 3; ++i) most = std::fmax(most, max_norm(m[i]));
  return most;
}

/// Inverse of the transpose.
[[nodiscard]] inline Matrix3 inverse_transposed(const Matrix3& m) noexcept {
  const double determinant = dot(m[0], cross(m[1], m[2]));
  return Matrix3(cross(m[1], m[2]) / determinant, cross(m[2], m[0]) / determinant, cross(m[0], m[1]) / determinant);
}

[[nodiscard]] inline Matrix3 transposed(const Matrix3& m) noexcept {
  return Matrix3(m[0][0], m[1][0], m[2][0], m[0][1], m[1][1], m[2][1], m[0][2], m[1][2], m[2][2]);
}

/// Splits a transform by its polar decomposition, so that transforms that differ by a similarity have the same shape.
/// Empty for one that flattens, or is not finite. A deviation of lengths from a similarity of up to 1e-6 is ignored, as
/// it comes of single precision. Source: Higham 1986, Computing the polar decomposition, SIAM J. Sci. Stat. Comput.
/// 7(4), Newton's iteration.
[[nodiscard]] inline std::optional<SplitTransform> split(const Affine& transform) {
  constexpr double tolerance = 1e-6;
  const double determinant = dot(transform.linear[0], cross(transform.linear[1], transform.linear[2]));
  const double scale = std::cbrt(std::fabs(determinant));
  if (!(scale >= 1e-30 && scale <= 1e30) || !finite(transform.shift)) return std::nullopt;
  const Matrix3 unit = transform.linear * (1 / scale);
  if (!(greatest(unit) <= 1e6)) return std::nullopt;  // flattened to a millionth of a millionth
  Matrix3 turn = unit;
  for (int i = 0; i < 60; ++i) {
    const Matrix3 next = (turn + inverse_transposed(turn)) * 0.5, step = next - turn;
    turn = next;
    if (greatest(step) < 1e-14) break;
  }
  const double sign = determinant < 0 ? -1 : 1;
  SplitTransform made;
  made.placement = {
      .rotation = normalize(pulsecast::rotation_of(turn * sign)), .scale = scale, .translation = transform.shift};
  made.shape = transposed(turn) * unit * sign;
  made.is_similarity = determinant > 0 && greatest(made.shape - Matrix3(1)) <= tolerance;
  if (made.is_similarity) made.shape = Matrix3(1);
  return made;
}

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
