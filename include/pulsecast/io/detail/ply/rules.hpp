// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_PLY_RULES_HPP
#define PULSECAST_IO_DETAIL_PLY_RULES_HPP

#include <pulsecast/io/format_rules.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Elements of PLY files where a mesh is expected, and their properties by canonical names; other properties have no
/// influence on a mesh. Source: Turk 1994, The PLY polygon file format; Stanford 3D Scanning Repository.
inline constexpr std::array<FormatRule, 17> ply_mesh_rules{{
    {"vertex", FormatUse::read, "places `x`, `y`, `z`"},
    {"vertex u", FormatUse::read, "texture coordinates `u`, `v` or `s`, `t`"},
    {"vertex red, face red, vertex alpha, face alpha", FormatUse::noted,
     "colours have no effect, pictures and MTL files do"},
    {"vertex classification, face classification", FormatUse::noted,
     "classes are those of materials, from an MTL file"},
    {"face", FormatUse::read, "polygons, by the list `vertex_indices`"},
    {"face texcoord", FormatUse::read, "texture coordinates of the corners"},
    {"face material_index", FormatUse::noted, "all faces have one material, named default"},
    {"tristrips", FormatUse::read, "strips of triangles, which end at negative numbers"},
    {"range_grid", FormatUse::refused, "faces, as meshing programs make them of grids; xyzloader reads the points"},
    {"edge", FormatUse::noted, "lines have no area and are left out"},
    {"camera", FormatUse::noted, "vertices are not moved by the pose of a camera"},
    {"comment texturefile", FormatUse::read, "picture of the colours"},
    {"comment texturefile 2", FormatUse::noted, "several pictures have no effect, one has"},
    {"comment offset", FormatUse::noted, "vertices are not moved: a translation of the part moves them"},
    {"comment transform*, comment scale*, comment up, comment up_axis", FormatUse::noted,
     "vertices are not moved: a placement of the part moves them"},
    {"comment unit*, comment crs, comment epsg*, comment srs", FormatUse::noted,
     "a unit is a metre, or as the settings say"},
    {"*", FormatUse::noted, "elements other than vertices, faces and strips have no effect"},
}};

/// Elements of PLY files where points are expected.
inline constexpr std::array<FormatRule, 8> ply_cloud_rules{{
    {"vertex", FormatUse::read, "points, with columns as below"},
    {"face, tristrips", FormatUse::noted, "surfaces have no effect: a mesh loader reads them"},
    {"range_grid", FormatUse::read, "grid of the points"},
    {"camera", FormatUse::noted, "points are not moved by the pose of a camera"},
    {"comment offset", FormatUse::noted, "points are not moved: a translation of the part moves them"},
    {"comment transform*, comment scale*, comment up, comment up_axis", FormatUse::noted,
     "points are not moved: a placement of the part moves them"},
    {"comment unit*, comment crs, comment epsg*, comment srs", FormatUse::noted, "a unit is a metre"},
    {"*", FormatUse::noted, "elements other than vertices have no effect"},
}};

/// Columns of points with an effect, by canonical names, in PLY files and texts with a row of names.
inline constexpr std::array<FormatRule, 12> point_rules{{
    {"x", FormatUse::read, "first coordinate"},
    {"y", FormatUse::read, "second coordinate"},
    {"z", FormatUse::read, "third coordinate"},
    {"nx", FormatUse::read, "first component of the normal; also `normal_x`"},
    {"ny", FormatUse::read, "second component of the normal; also `normal_y`"},
    {"nz", FormatUse::read, "third component of the normal; also `normal_z`"},
    {"red", FormatUse::read, "colour; also `r`, `diffuse_red`"},
    {"green", FormatUse::read, "colour; also `g`, `diffuse_green`"},
    {"blue", FormatUse::read, "colour; also `b`, `diffuse_blue`"},
    {"classification", FormatUse::read, "class; also `class`, `label`, `scalar_Classification`"},
    {"object", FormatUse::read, "number of the object; also `object_id`, `instance`"},
    {"lat*, lon*", FormatUse::refused, "coordinates in metres, not degrees"},
}};

/// Canonical name of a column or property, by the words that programs write for it.
[[nodiscard]] inline std::string canonical_name(std::string_view written) {
  std::string name = text::lower(written);
  for (const std::string_view begin : {"\"", "scalar_", "diffuse_", "texture_"})
    if (name.starts_with(begin)) name.erase(0, begin.size());
  if (name.ends_with('"')) name.pop_back();
  constexpr std::string_view aliases =
      " normal_x=nx normal_y=ny normal_z=nz r=red g=green b=blue class=classification label=classification"
      " object_id=object instance=object s=u t=v vertex_index=vertex_indices ";
  const std::size_t at = aliases.find(' ' + name + '=');
  if (at == aliases.npos) return name;
  std::string_view rest = aliases.substr(at + name.size() + 2);
  return std::string(text::take_word(rest, " "));
}

/// Columns of a point by their names: the first of each.
struct PointNames {
  std::array<std::optional<std::size_t>, point_rules.size()> column{};  ///< by row of `point_rules`
  const FormatRule* refused = nullptr;                                  ///< rule of a name without x, y and z, or null

  void add(std::string_view written, std::size_t number) {
    const FormatRule* const rule = rule_of(point_rules, canonical_name(written));
    if (!rule) return;
    if (rule->use == FormatUse::refused) refused = rule;
    std::optional<std::size_t>& place = column[static_cast<std::size_t>(rule - point_rules.data())];
    if (!place) place = number;
  }
  /// Columns of a vector from a row of the table on: 0 for the position, 3 for the normal, 6 for the colour.
  [[nodiscard]] std::optional<std::array<std::size_t, 3>> vector(std::size_t row) const {
    if (!column[row] || !column[row + 1] || !column[row + 2]) return std::nullopt;
    return std::array{*column[row], *column[row + 1], *column[row + 2]};
  }
};

/// Number of a class or an object; 0 for what is none, as programs write -1 or NaN for unknown.
[[nodiscard]] constexpr std::uint32_t whole_number(double value) noexcept {
  return value >= 0 && value <= 4294967295.0 ? static_cast<std::uint32_t>(value) : 0;
}

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
