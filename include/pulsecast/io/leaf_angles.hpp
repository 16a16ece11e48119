// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_LEAF_ANGLES_HPP
#define PULSECAST_IO_LEAF_ANGLES_HPP

#include <filesystem>

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/shape/leaf_angles.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Reads a table of leaf projections: rows of `x, y, z, G`, a unit direction and its G, in any order, without a header;
/// `#` begins a comment. Leaves face all azimuths and both sides alike, so only the angle to the vertical counts; equal
/// angles need equal G. Gaps between rows are at most 10 degrees.
///
/// G times the plant area density is the extinction coefficient: 1/2 for spherical leaf angles (Ross 1981). Tables of
/// HELIOS++ hold this G; its further division by 2 pi is not repeated. Throws a `FileError` with path and line at the
/// first error, or for a gap.
[[nodiscard]] LeafAngles read_leaf_angles(const std::filesystem::path& path);

}  // namespace PULSECAST_NAMESPACE::io

#if PULSECAST_DEFINITIONS
#include <pulsecast/io/detail/leaf_angle_reader.hpp>
#endif

#endif
