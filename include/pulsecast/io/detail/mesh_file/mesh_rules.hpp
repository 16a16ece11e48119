// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_MESH_FILE_MESH_RULES_HPP
#define PULSECAST_IO_DETAIL_MESH_FILE_MESH_RULES_HPP

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
    {"params of other names", FormatUse::refused, "accessors with the params X Y Z, S T, U V or R G B A"},
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

/// Extensions of glTF, and members of its core. The last row is for extensions in no other row: that the file requires
/// none of them is checked apart. Source: Khronos registry of glTF extensions; glTF 2.0.
inline constexpr auto gltf_rules = std::to_array<FormatRule>({
    {"KHR_draco_mesh_compression", FormatUse::read, "compressed meshes, where assimp is built with Draco"},
    {"KHR_mesh_quantization", FormatUse::read, "positions and texture coordinates of whole numbers"},
    {"EXT_mesh_gpu_instancing", FormatUse::read, "a part for each instance"},
    {"KHR_texture_transform", FormatUse::read, "texture coordinates of the picture of the base colour"},
    {"KHR_node_visibility", FormatUse::read, "hidden nodes, and those below them, are left out"},
    {"sparse", FormatUse::read, "positions and texture coordinates that differ from their accessors"},
    {"mode", FormatUse::read, "triangles, strips and fans; points and lines are left out"},
    {"MSFT_lod", FormatUse::read, "the finest level of detail"},
    {"KHR_materials_transmission", FormatUse::read, "share of the light that passes"},
    {"KHR_materials_ior", FormatUse::read, "refractive index"},
    {"KHR_materials_unlit", FormatUse::read, "a surface of its base colour"},
    {"KHR_materials_emissive_strength", FormatUse::read, "nothing: surfaces do not glow"},
    {"KHR_lights_*", FormatUse::read, "nothing: lamps are not seen"},
    {"EXT_lights_*", FormatUse::read, "nothing: lamps are not seen"},
    {"KHR_xmp*", FormatUse::read, "nothing: metadata"},
    {"EXT_structural_metadata", FormatUse::read, "nothing: metadata"},
    {"EXT_mesh_features", FormatUse::read, "nothing: metadata"},
    {"EXT_instance_features", FormatUse::read, "nothing: metadata"},
    {"KHR_materials_pbrSpecularGlossiness", FormatUse::noted, "its base colour is that of the fallback, or white"},
    {"KHR_materials_variants", FormatUse::noted, "surfaces have the materials of no variant"},
    {"KHR_materials_*", FormatUse::noted, "surfaces reflect as without it"},
    {"KHR_texture_basisu", FormatUse::noted, "pictures in KTX2 colour nothing and cut no outline"},
    {"EXT_texture_*", FormatUse::noted, "pictures in WebP or AVIF colour nothing and cut no outline"},
    {"MSFT_texture_dds", FormatUse::noted, "pictures in DDS colour nothing and cut no outline"},
    {"COLOR_0", FormatUse::noted, "points do not get the colours of vertices"},
    {"CESIUM_RTC", FormatUse::noted, "the model is not moved to its place on the globe"},
    {"animations", FormatUse::noted, "nodes stand as without animation"},
    {"skins", FormatUse::noted, "meshes stand as modelled, not as their bones do"},
    {"weights", FormatUse::noted, "meshes have their shapes without morph targets"},
    {"scenes", FormatUse::noted, "of several scenes, the default one is read, or the first"},
    {"EXT_meshopt_compression", FormatUse::refused, "a file without it, as gltfpack makes without -c"},
    {"KHR_meshopt_compression", FormatUse::refused, "a file without it, as gltfpack makes without -c"},
    {"WEB3D_quantized_attributes", FormatUse::refused, "glTF 2.0"},
    {"minVersion", FormatUse::refused, "glTF 2.0"},
    {"*", FormatUse::noted, "the file does not require it, and is read as without it"},
});

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
