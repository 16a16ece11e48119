// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_MESH_FILE_MESH_RULES_HPP
#define PULSECAST_IO_DETAIL_MESH_FILE_MESH_RULES_HPP

#include <array>

#include <pulsecast/io/format_rules.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Elements of DAE and FBX files, as their text has them. Source: Khronos, COLLADA 1.4.1; assimp 5.2, what it drops.
inline constexpr auto mesh_rules = std::to_array<FormatRule>({
    {"<unit", FormatUse::read, "size of a unit"},
    {"<up_axis", FormatUse::read, "vertical axis"},
    {"UnitScaleFactor", FormatUse::read, "size of a unit"},
    {"UpAxis", FormatUse::read, "vertical axis"},
    {"<ph>", FormatUse::refused, "polygons without holes, as of an export of triangles"},
    {"<skew", FormatUse::refused, "a matrix in its place"},
    {"<lookat", FormatUse::refused, "a matrix in its place"},
    {"<visibility>0", FormatUse::noted, "hidden nodes are shown"},
    {"<animation", FormatUse::noted, "nodes stand as without animation"},
    {"<spline", FormatUse::noted, "curves are left out"},
    {"<convex_mesh", FormatUse::noted, "convex hulls are left out"},
    {".dae#", FormatUse::noted, "nodes of other files are left out"},
    {"<geographic_location", FormatUse::noted, "the model is not moved to its place on the globe"},
    {"AnimationCurve", FormatUse::noted, "nodes stand as without animation"},
    {"LodGroup", FormatUse::noted, "all levels of detail are there, one within the other"},
    {"NurbsSurface", FormatUse::noted, "surfaces other than meshes are left out"},
});

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
