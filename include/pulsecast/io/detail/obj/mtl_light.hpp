// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_OBJ_MTL_LIGHT_HPP
#define PULSECAST_IO_DETAIL_OBJ_MTL_LIGHT_HPP

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include <tiny_obj_loader.h>

#include <pulsecast/base/text.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/material/material.hpp>
#include <pulsecast/material/microfacet.hpp>
#include <pulsecast/material/retroreflector.hpp>
#include <pulsecast/material/water_types.hpp>

/// Keys of MTL files for light reflected or transmitted specularly.
namespace PULSECAST_NAMESPACE::io::detail {

/// Numbers from the word `first` on, at most `most`; empty if one of them is none, or outside the limits.
[[nodiscard]] inline std::optional<std::vector<double>> numbers_from(const std::vector<std::string_view>& words,
                                                                     std::size_t first, std::size_t least,
                                                                     std::size_t most, double low, double high) {
  if (words.size() < first + least || words.size() > first + most) return std::nullopt;
  std::vector<double> numbers;
  for (std::size_t i = first; i < words.size(); ++i) {
    const auto number = text::number_in<double>(words[i]);
    if (!number || !(*number >= low && *number <= high)) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

/// True for a standard key among them.
[[nodiscard]] inline bool is_light_key(std::string_view key) {
  return key == "illum" || key == "Ni" || key == "Tf" || key == "Pm";
}

/// Expected words of a key, for a message; null if they are right, or the key is another.
[[nodiscard]] inline const char* expected_of_light_key(std::string_view key,
                                                       const std::vector<std::string_view>& words) {
  const auto is = [&](std::string_view word) { return !words.empty() && words[0] == word; };
  if (key == "pulsecast_interface") {
    const bool right = (is("mirror") && numbers_from(words, 1, 1, 1, 0, 1)) ||
                       (is("pane") && numbers_from(words, 1, 1, 1, 0, 10)) ||
                       ((is("glass") || is("water") || is("none")) && words.size() == 1);
    return right
               ? nullptr
               : "mirror and its reflectance from 0 to 1, pane and its thickness from 0 to 10 m, glass, water or none";
  }
  if (key == "pulsecast_medium") {
    const bool right =
        numbers_from(
            {words.begin(), words.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(words.size(), 2))}, 0, 1,
            2, 1, 4) &&
        numbers_from(words, std::min<std::size_t>(words.size(), 2), 0, 3, 0, 1e6);
    return right ? nullptr
                 : "an index from 1 to 4, and then, as far as given, a group index from 1 to 4, absorption, scattering "
                   "and backscatter from 0";
  }
  if (key == "pulsecast_water") {
    const bool right =
        (words.size() == 1 && jerlov_type(words[0])) || (is("secchi") && numbers_from(words, 1, 1, 1, 0.1, 80));
    return right
               ? nullptr
               : "a type of Jerlov's, I, IA, IB, II, III, 1C, 3C, 5C, 7C or 9C, or secchi and a depth from 0.1 to 80 m";
  }
  if (key == "pulsecast_roughness")
    return numbers_from(words, 0, 1, 1, 1e-3, 2) ? nullptr : "a root mean square slope from 0.001 to 2";
  if (key == "pulsecast_retroreflector") {
    const bool right = ((is("beads") || is("cubeCorner")) && numbers_from(words, 1, 0, 1, 0, 0.1)) ||
                       (is("prisms") && words.size() >= 2 && numbers_from({words[1]}, 0, 1, 1, 1, 4) &&
                        numbers_from(words, 2, 0, 1, 0, 0.1));
    return right ? nullptr
                 : "beads, cubeCorner, or prisms and their index from 1 to 4, and then, if given, the half width of "
                   "the light from 0 to 0.1 rad";
  }
  return nullptr;
}

/// Sets what a material passes on from the standard keys: `illum` 3, 5 and 8, and `Pm`, are mirrors; 4, 6, 7 and 9
/// bodies of glass with the index `Ni`. Source: MTL specification, Wavefront 1995; `Pm`: the common extension for
/// physically based shading. Returns false for an index out of range, in place of which that of glass is set.
[[nodiscard]] inline bool set_standard_light(Material& made, const tinyobj::material_t& m) {
  const double rest = 1 - std::min(made.reflectance, 1.0),
               specular = (m.specular[0] + m.specular[1] + m.specular[2]) / 3;
  if (m.metallic > 0)
    made.smooth = SmoothInterface::mirror(std::min<double>(m.metallic, rest));
  else if (m.illum == 3 || m.illum == 5 || m.illum == 8)
    made.smooth = SmoothInterface::mirror(std::min(specular > 0 ? specular : 1.0, rest));
  else if (m.illum == 4 || m.illum == 6 || m.illum == 7 || m.illum == 9) {
    made.smooth = SmoothInterface::glass();
    if (m.ior < 1 || m.ior > 4) return false;
    if (m.ior > 1) made.smooth.inside = {.index = m.ior};
  }
  return true;
}

/// Water of a key's words, which are right, for light of a wavelength [m]. @throws SettingError for a wavelength out of
/// range
[[nodiscard]] inline SmoothInterface water_of(const std::vector<std::string_view>& words, double wavelength) {
  if (const auto type = jerlov_type(words[0])) return SmoothInterface::water(water(*type, wavelength));
  return SmoothInterface::water(secchi_water(*text::number_in<double>(words[1]), wavelength));
}

/// Sets what a material passes on from the keys of this library, but for water, whose words are right. `words_of(key)`
/// are those of a key.
template <class WordsOf>
void set_own_light(Material& made, const tinyobj::material_t& m, const WordsOf& words_of) {
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
    const auto kind = words_of("pulsecast_retroreflector");
    const bool prisms = !kind.empty() && kind[0] == "prisms",
               corners = prisms || (!kind.empty() && kind[0] == "cubeCorner");
    const std::size_t width = prisms ? 2 : 1;
    const double half_angle = kind.size() > width ? number(kind[width]) : 0;
    if (corners)
      made.law = Retroreflector<CubeCorners>{coefficient, half_angle, {prisms ? number(kind[1]) : 1}};
    else
      made.law =
          Retroreflector<Beads>{coefficient, half_angle, words.size() > 1 ? Beads{radians(number(words[1]))} : Beads{}};
  }
  if (const auto words = words_of("pulsecast_roughness"); !words.empty()) made.law = Microfacet{number(words[0])};
}

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
