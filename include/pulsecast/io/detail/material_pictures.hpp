// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_MATERIAL_PICTURES_HPP
#define PULSECAST_IO_DETAIL_MATERIAL_PICTURES_HPP

#include <filesystem>
#include <functional>
#include <map>

#include <pulsecast/material/spectrum.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Vertical axis of a file.
enum class UpAxis : std::uint8_t {
  z,  ///< coordinates unchanged
  y,  ///< (x, y, z) becomes (x, -z, y)
};

/// Spectra by name.
struct SpectralLibrary {
  std::map<std::string, std::shared_ptr<const Spectrum>, std::less<>> spectra{};  ///< by name
  std::vector<std::string> reports{};   ///< report of each file, as in `SpectrumFile`
  std::vector<std::string> warnings{};  ///< oddities that could still be read
  std::vector<double> wavelengths{};    ///< of the lasers, for warnings; empty if unknown [m]
};

/// Picture that a material names: a file, or bytes inside the file of the mesh.
struct PictureSource {
  std::filesystem::path file{};  ///< path; of embedded bytes, a name for messages; empty: none
  std::shared_ptr<const std::vector<std::byte>> embedded{};  ///< content of an embedded file

  [[nodiscard]] bool empty() const noexcept { return file.empty() && !embedded; }
};

/// Pictures of a material, not read yet: see `add_pictures`.
struct MaterialPictures {
  PictureSource colour{};            ///< colour of points
  PictureSource opacity{};           ///< outline: by its opacity, or by its grey or red without one
  PictureSource reflectance{};       ///< reflectance
  bool reflectance_pattern = false;  ///< true if that is a pattern, see `ReflectanceMap::pattern`
  bool outlined_by_colour = false;   ///< true: the opacity of the colour picture is the outline
  double cutoff = 0.5;               ///< opacity from which a surface is solid, in [0, 1]

  [[nodiscard]] bool empty() const noexcept { return colour.empty() && opacity.empty() && reflectance.empty(); }
  void append_to(std::vector<std::filesystem::path>& files) const {
    for (const PictureSource* const one : {&colour, &opacity, &reflectance})
      if (!one->empty() && !one->embedded) files.push_back(one->file);
  }
};

}  // namespace PULSECAST_NAMESPACE::io

#endif
