// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SHAPE_CLASS_MATERIALS_HPP
#define PULSECAST_SHAPE_CLASS_MATERIALS_HPP

#include <set>

#include <pulsecast/material/material.hpp>
#include <pulsecast/shape/raster.hpp>

namespace PULSECAST_NAMESPACE {

/// Materials of the classes of a raster of codes, as for `set_materials`.
struct ClassMaterials {
  std::vector<Material> materials{1};  ///< of a part; the first is that of pixels without a class
  std::vector<CodeMaterial> listed{};  ///< code of each other material

  void validate() const { require_within("ClassMaterials::materials (number)", materials.size(), 1, 256); }
};

/// Gives each code that occurs in a raster its entry of a table of colours (sRGB, from 0 to 1), by
/// number. An unlisted one gets a copy of the first material; one beyond the table, or no whole
/// number, is left. @throws SettingError for more than 256 materials, and as `Raster::validate`
inline void colour_classes(ClassMaterials& classes, const Raster& codes, std::span<const Vec3> colours) {
  classes.validate();
  codes.validate();
  std::set<std::size_t> present;
  codes.read([&](const auto& code) {
    for (std::size_t i = 0; i < codes.pixels(); ++i) {
      const float value = code[i];
      if (value >= 0 && value < static_cast<float>(colours.size()) && std::floor(value) == value)
        present.insert(static_cast<std::size_t>(value));
    }
  });
  auto& [materials, listed] = classes;
  for (const std::size_t code : present) {
    const auto number = static_cast<double>(code);
    std::size_t i = 0;
    while (i < listed.size() && listed[i].code != number) ++i;
    if (i == listed.size()) {
      require_within("ClassMaterials::materials (number)", materials.size() + 1, 1, 256);
      listed.push_back({number, static_cast<std::uint8_t>(materials.size())});
      materials.push_back(materials.front());
      materials.back().name += " " + std::to_string(code);
    }
    materials.at(listed[i].material).colour = colours[code];
  }
}

}  // namespace PULSECAST_NAMESPACE

#endif
