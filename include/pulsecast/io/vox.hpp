// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_VOX_HPP
#define PULSECAST_IO_VOX_HPP

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/base/require.hpp>
#include <pulsecast/base/vector.hpp>
#include <pulsecast/shape/voxel_data.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Use of the voxels of a file.
enum class VoxelUse : std::uint8_t {
  transmissive,  ///< filled with leaves of a density
  opaque,        ///< cubes of the size of their cells
  scaled,        ///< cubes that shrink with the density of their cells
};

/// Settings for voxel files.
struct VoxelFileSettings {
  VoxelUse use = VoxelUse::transmissive;  ///< use of the voxels
  double exponent = 0.5;  ///< of scaled cubes: their edge is (PAD / PADmax)^exponent times that of the cell
  std::optional<double> density_max =
      std::nullopt;  ///< PADmax; by default from the file, or else its maximum [m^2/m^3]
  std::optional<std::uint64_t> shift =
      std::nullopt;  ///< seed of random shifts of scaled cubes inside their cells; none if empty

  void validate() const {
    require_not_negative("VoxelFileSettings::exponent", exponent, "");
    if (density_max) require_positive("VoxelFileSettings::density_max", *density_max, "m^2/m^3");
  }
};

/// Content of a voxel file.
struct VoxelFile {
  VoxelData voxels;                   ///< with densities, or with scales and shifts, by use
  std::vector<float> transmittances;  ///< for each voxel, NaN where unknown; none without such a column
  double density_max = 0;             ///< PADmax: as set, from the file, or its maximum [m^2/m^3]
  std::vector<std::string> warnings;  ///< oddities that could still be read
};

/// Reads a voxel file of AMAPVox: text that begins with `VOXEL SPACE`. Lines of `#key: value` follow in any order, then
/// a row of column names, and a row for each voxel. Required keys are `min_corner` and `res` (one edge length, as
/// voxels are cubes). Required columns are i, j, k and PadBVTotal; for opaque and scaled voxels also transmittance.
/// Left out of the grid are
/// - transmissive voxels of density 0, or, with a warning, NaN;
/// - opaque and scaled voxels of transmittance 1 (fully transparent) or NaN (never observed);
/// - scaled voxels of density 0, and so of size 0, or, with a warning, NaN.
/// Shifts of scaled cubes are uniform within their cells, and depend on the seed and the cell alone.
/// Throws a `FileError` with path and line at the first error, and if no voxel is left.
/// Source of the format and of the three uses: AMAPVox (Vincent et al. 2017); Weiser et al. 2021, opaque voxel-based
/// tree models.
[[nodiscard]] VoxelFile read_voxel_file(const std::filesystem::path& path, const VoxelFileSettings& settings = {});

}  // namespace PULSECAST_NAMESPACE::io

#if PULSECAST_DEFINITIONS
#include <pulsecast/io/detail/voxel_file_reader.hpp>
#endif

#endif
