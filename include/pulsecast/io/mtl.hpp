// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_MTL_HPP
#define PULSECAST_IO_MTL_HPP

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/io/detail/material_pictures.hpp>
#include <pulsecast/io/detail/spectra.hpp>
#include <pulsecast/material/material.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Content of MTL files.
struct MaterialLibrary {
  std::map<std::string, Material, std::less<>> materials;  ///< materials by name
  std::map<std::string, MaterialPictures, std::less<>>
      pictures{};                     ///< pictures of those that have some, not read: see `add_pictures`
  std::vector<std::string> warnings;  ///< oddities that could still be read
};

/// Reads an MTL file. Colours select the scattering model: `Ks` Phong's, `Kd` alone Lambert's. The reflectance is
/// `helios_reflectance`, a fraction, or else the spectrum named by `helios_spectra`. `Ns`, `helios_isGround` and
/// `helios_classification` count, too. Multi-bounce light is set by `illum`, `Ni`, `Tf`, `Pm` and keys of this library,
/// see docs/surveys.md; pictures by `map_Kd` (colour of points), `map_d` (outline) and `pulsecast_reflectanceMap`,
/// without their options. Other keys are ignored. The first of equal names counts. Keys before the first name describe
/// the material "default". Throws a `FileError` with path and line at the first error.
[[nodiscard]] MaterialLibrary read_mtl(const std::filesystem::path& path, const SpectralLibrary& spectra = {});

/// Surface without a description. It scatters equally in all directions, as in HELIOS++, which defined the extra keys.
[[nodiscard]] inline Material undescribed(std::string name) {
  return {.name = std::move(name), .law = DirectionIndependent{}};
}

}  // namespace PULSECAST_NAMESPACE::io

#if PULSECAST_DEFINITIONS
#include <pulsecast/io/detail/obj/mtl_reader.hpp>
#endif

#endif
