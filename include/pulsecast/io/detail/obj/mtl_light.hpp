// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_OBJ_MTL_LIGHT_HPP
#define PULSECAST_IO_DETAIL_OBJ_MTL_LIGHT_HPP

#include <tiny_obj_loader.h>

#include <pulsecast/io/detail/obj/statements.hpp>
#include <pulsecast/material/material.hpp>
#include <pulsecast/material/microfacet.hpp>
#include <pulsecast/material/retroreflector.hpp>
#include <pulsecast/material/water_types.hpp>

/// Keys of MTL files for light reflected or transmitted specularly.
namespace PULSECAST_NAMESPACE::io::detail {

/// Expected words of an extra key, for a message; null if they are right, or the key is another.
[[nodiscard]] inline const char* expected_words(std::string_view key, const std::vector<std::string_view>& words) {
  const std::size_t count = words.size();
  const auto is = [&](std::string_view word) { return count > 0 && words[0] == word; };
  const auto are = [&](std::size_t first, std::size_t end, double low, double high) {  // numbers in a range
    for (std::size_t i = first; i < std::min(end, count); ++i) {
      const std::optional<double> number = number_in<double>(words[i]);
      if (!number || *number < low || *number > high) return false;
    }
    return true;
  };
  const auto need = [](bool right, const char* expected) { return right ? nullptr : expected; };
  if (key == "helios_reflectance")
    return need(count == 1 && are(0, 1, 0, 100), "a fraction from 0 to 1, or up to 100 percent");
  if (key == "helios_classification")
    return need(count == 1 && number_in<std::uint16_t>(words[0]), "a whole number from 0 to 65535");
  if (key == "pulsecast_normalizedPhong") return need(count == 1 && (is("true") || is("false")), "true or false");
  if (key == "pulsecast_interface")
    return need((is("mirror") && count == 2 && are(1, 2, 0, 1)) || (is("pane") && count == 2 && are(1, 2, 0, 10)) ||
                    ((is("glass") || is("water") || is("none")) && count == 1),
                "mirror and its reflectance from 0 to 1, pane and its thickness from 0 to 10 m, glass, water or none");
  if (key == "pulsecast_medium")
    return need(count >= 1 && count <= 5 && are(0, 2, 1, 4) && are(2, 5, 0, 1e6),
                "an index from 1 to 4, and then, as far as given, a group index from 1 to 4, absorption, scattering "
                "and backscatter from 0");
  if (key == "pulsecast_water")
    return need((count == 1 && jerlov_type(words[0])) || (is("secchi") && count == 2 && are(1, 2, 0.1, 80)),
                "a type of Jerlov's, I, IA, IB, II, III, 1C, 3C, 5C, 7C or 9C, or secchi and a depth from 0.1 to 80 m");
  if (key == "pulsecast_roughness")
    return need(count == 1 && are(0, 1, 1e-3, 2), "a root mean square slope from 0.001 to 2");
  if (key == "pulsecast_retroreflection")
    return need(count >= 1 && count <= 2 && are(0, 1, 0, 1e6) && are(1, 2, 1, 85),
                "a coefficient from 0 to 1e6 cd/(lx m^2), and the angle of half of it from 1 to 85 degrees");
  if (key == "pulsecast_retroreflector")
    return need(((is("beads") || is("cubeCorner")) && count <= 2 && are(1, 2, 0, 0.1)) ||
                    (is("prisms") && count >= 2 && count <= 3 && are(1, 2, 1, 4) && are(2, 3, 0, 0.1)),
                "beads, cubeCorner, or prisms and their index from 1 to 4, and then, if given, the half width of "
                "the light from 0 to 0.1 rad");
  return nullptr;
}

/// Sets specular light by the standard keys: `illum` 3, 5 and 8, and `Pm`, are mirrors; 4, 6, 7 and
/// 9 glass of the index `Ni`, or that of glass if it is out of range. Source: MTL
/// specification, Wavefront 1995; `Pm`: the common extension for physically based shading.
inline void set_standard_light(Material& made, const tinyobj::material_t& m) {
  const double rest = 1 - std::min(made.reflectance, 1.0),
               specular = (m.specular[0] + m.specular[1] + m.specular[2]) / 3;
  if (m.metallic > 0)
    made.smooth = SmoothInterface::mirror(std::min<double>(m.metallic, rest));
  else if (m.illum == 3 || m.illum == 5 || m.illum == 8)
    made.smooth = SmoothInterface::mirror(std::min(specular > 0 ? specular : 1.0, rest));
  else if (m.illum == 4 || m.illum == 6 || m.illum == 7 || m.illum == 9) {
    made.smooth = SmoothInterface::glass();
    if (m.ior > 1 && m.ior <= 4) made.smooth.inside = {.index = m.ior};
  }
}

/// Sets specular light by the keys of this library, but for water. `words_of(key)` are right.
void set_own_light(Material& made, const tinyobj::material_t& m, const auto& words_of) {
  const auto number = [](std::string_view word) { return *text::number_in<double>(word); };
  if (const auto words = words_of("pulsecast_interface"); !words.empty()) {
    if (words[0] == "mirror") made.smooth = SmoothInterface::mirror(number(words[1]));
    if (words[0] == "pane") made.smooth = SmoothInterface::pane(number(words[1]));
    if (words[0] == "glass") made.smooth = SmoothInterface::glass();
    if (words[0] == "water") made.smooth = SmoothInterface::water();
    if (words[0] == "none") made.smooth = {};
    if (m.ior > 1 && m.ior <= 4 && made.smooth.inside.index > 1) made.smooth.inside = {.index = m.ior};
  }
  if (const auto words = words_of("pulsecast_medium"); !words.empty()) {
    Medium& inside = made.smooth.inside = {.index = number(words[0])};
    double* const members[] = {&inside.group_index, &inside.absorption, &inside.scattering, &inside.backscatter};
    for (std::size_t i = 1; i < words.size(); ++i) *members[i - 1] = number(words[i]);
  }
  const double transmission = (m.transmittance[0] + m.transmittance[1] + m.transmittance[2]) / 3;
  if (made.smooth.kind == InterfaceKind::pane && made.smooth.thickness > 0 && transmission > 0 && transmission < 1)
    made.smooth.inside.absorption = -std::log(transmission) / made.smooth.thickness;
  if (const auto words = words_of("pulsecast_retroreflection"); !words.empty()) {
    const double coefficient = number(words[0]);
    const auto of = words_of("pulsecast_retroreflector");
    const std::string_view kind = of.empty() ? "beads" : of[0];
    const std::size_t width = kind == "prisms" ? 2 : 1;
    const double half_angle = of.size() > width ? number(of[width]) : 0;
    const Beads beads = words.size() > 1 ? Beads{radians(number(words[1]))} : Beads{};
    if (kind == "beads")
      made.law = Retroreflector<Beads>{coefficient, half_angle, beads};
    else
      made.law = Retroreflector<CubeCorners>{coefficient, half_angle, {kind == "prisms" ? number(of[1]) : 1}};
  }
  if (const auto words = words_of("pulsecast_roughness"); !words.empty()) made.law = Microfacet{number(words[0])};
}

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
