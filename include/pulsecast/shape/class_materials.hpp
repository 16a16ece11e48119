// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SHAPE_CLASS_MATERIALS_HPP
#define PULSECAST_SHAPE_CLASS_MATERIALS_HPP

#include <algorithm>
#include <cmath>
#include <set>

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/vector.hpp>
#include <pulsecast/material/material.hpp>
#include <pulsecast/shape/raster.hpp>

namespace PULSECAST_NAMESPACE {

/// Materials of the classes of a raster of codes, as for `set_materials`.
struct ClassMaterials {
  std::vector<Material> materials{1};  ///< table of a part; the first is that of pixels without a class
  std::vector<CodeMaterial> listed{};  ///< code of each other material

  void validate() const {
    require_within("ClassMaterials::materials (number)", static_cast<double>(materials.size()), 1, 256, "");
  }
};

/// Gives each code that occurs in a raster the colour of a colour table (sRGB, each channel from 0
/// to 1), whose entry n is that of code n. A code that is not listed gets a copy of the first
/// material; one beyond the table or that is no whole number stays as it is.
/// @throws SettingError for more than 256 materials, and as `Raster::validate`
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
  for (const std::size_t code : present) {
    auto found = std::find_if(classes.listed.begin(), classes.listed.end(),
                              [&](const CodeMaterial& one) { return one.code == static_cast<double>(code); });
    if (found == classes.listed.end()) {
      require_within("ClassMaterials::materials (number)", static_cast<double>(classes.materials.size() + 1), 1, 256,
                     "");
      classes.listed.push_back({static_cast<double>(code), static_cast<std::uint8_t>(classes.materials.size())});
      classes.materials.push_back(classes.materials.front());
      classes.materials.back().name += " " + std::to_string(code);
      found = classes.listed.end() - 1;
    }
    classes.materials.at(found->material).colour = colours[code];
  }
}

}  // namespace PULSECAST_NAMESPACE

#endif
