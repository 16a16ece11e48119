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

/// Statements of OBJ files, and comments. Source: Wavefront 1995, Advanced Visualizer, appendix B1.
inline constexpr auto obj_rules = std::to_array<FormatRule>({
    {"vn, o, g, s", FormatUse::read, "nothing: surfaces are flat, and objects and groups are one"},
    {"v, vt, f, usemtl, mtllib", FormatUse::read, "vertices, texture coordinates, polygons and materials"},
    {"v x y z r g b", FormatUse::noted, "colours of vertices have no effect, pictures and MTL files do"},
    {"v x y z w", FormatUse::noted, "vertices are not divided by their weights"},
    {"f without area", FormatUse::noted, "a face without area is left out"},
    {"f that crosses itself", FormatUse::noted,
     "the outline of the polygon crosses itself: it becomes a fan about its first corner"},
    {"cut line", FormatUse::noted, "the last line has no line end: the file may be truncated"},
    {"l, p, curv*", FormatUse::noted, "lines, points and curves have no area and are left out"},
    {"surf", FormatUse::noted, "free-form surfaces are left out, polygons are read"},
    {"lod", FormatUse::noted, "all levels of detail are there, one within the other"},
    {"shadow_obj, trace_obj", FormatUse::noted, "surfaces are those of this file"},
    {"maplib, usemap", FormatUse::noted, "pictures are those of MTL files"},
    {"fo, call, csh", FormatUse::refused, "faces as `f`, in one file that calls no others"},
    {"# unit", FormatUse::noted, "a unit is a metre, or as the settings say"},
    {"# offset", FormatUse::noted, "vertices are not moved: a translation of the part moves them"},
    {"*", FormatUse::noted, "other statements are left out"},
});

/// Keys of MTL files. Source: MTL specification, Wavefront 1995; the extension for physically based shading; HELIOS++.
inline constexpr auto mtl_rules = std::to_array<FormatRule>({
    {"newmtl, Kd, Ks, Ns", FormatUse::read, "[law of reflected light](survey-scenes.md#materials)"},
    {"illum, Ni, Tf, Pm", FormatUse::read, "[mirrors, glass and panes](survey-scenes.md#materials)"},
    {"map_Kd, map_d, pulsecast_reflectanceMap", FormatUse::read, "pictures of colours, outline and reflectance"},
    {"helios_reflectance, helios_spectra", FormatUse::read, "reflectance, or the spectrum of a library"},
    {"helios_isGround, helios_classification", FormatUse::read, "place for set-ups, and class of points"},
    {"pulsecast_normalizedPhong, pulsecast_interface, pulsecast_medium, pulsecast_water, pulsecast_roughness, "
     "pulsecast_retroreflection, pulsecast_retroreflector",
     FormatUse::read, "[laws and media of this library](survey-scenes.md#materials)"},
    {"pulsecast_*", FormatUse::refused, "a key that docs/survey-scenes.md has"},
    {"d below 1, Tr above 0", FormatUse::noted,
     "the surface is opaque; map_d cuts holes, pulsecast_interface makes panes"},
    {"d, Tr", FormatUse::read, "an opaque surface"},
    {"Ka, Ke, map_Ka, map_Ke, helios_useVertexColors", FormatUse::read, "nothing: surfaces do not glow"},
    {"map_*", FormatUse::noted, "pictures have no effect but for map_Kd and map_d"},
    {"bump, norm, disp", FormatUse::noted, "surfaces are flat between their corners"},
    {"*", FormatUse::noted, "surfaces reflect as without it"},
});

/// Elements of CityGML files without prefix, and attributes. Source: OGC 12-019 (CityGML 2.0); OGC 03-105r1
/// (GML 3.1.1).
inline constexpr auto city_rules = std::to_array<FormatRule>({
    {"posList, srsName, transformationMatrix", FormatUse::read, "corners, EPSG code, place of shared geometries"},
    {"another srsName", FormatUse::refused, "one reference system in a file"},
    {"srsDimension=\"2\"", FormatUse::refused, "corners with heights"},
    {"uomLabels", FormatUse::noted, "coordinates are taken as metres"},
    {"last row of a transformationMatrix", FormatUse::refused, "0 0 0 1"},
    {"libraryObject", FormatUse::noted, "implicit geometries that are files of their own are left out"},
    {"citygml/3.0", FormatUse::refused, "CityGML 1 or 2"},
    {"coordinates, outerBoundaryIs, innerBoundaryIs", FormatUse::refused, "GML 3: posList, exterior and interior"},
    {"surfaceMembers, Ring, Tin, RasterRelief", FormatUse::refused,
     "polygons as LinearRing, one a surfaceMember, or a TriangulatedSurface"},
    {"terminationDate", FormatUse::noted, "objects stand at all times"},
    {"X3DMaterial, ParameterizedTexture, GeoreferencedTexture", FormatUse::noted,
     "surfaces have materials by their classes, without colours and pictures"},
    {"measureAttribute", FormatUse::read, "nothing: attributes have no effect"},
    {"*", FormatUse::noted, "other elements than those of libcitygml are left out"},
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
    {"KHR_materials_emissive_strength, KHR_lights_*, EXT_lights_*", FormatUse::read, "nothing: nothing glows"},
    {"KHR_xmp*, EXT_structural_metadata, EXT_mesh_features, EXT_instance_features", FormatUse::read,
     "nothing: metadata"},
    {"KHR_materials_pbrSpecularGlossiness", FormatUse::noted, "its base colour is that of the fallback, or white"},
    {"KHR_materials_variants", FormatUse::noted, "surfaces have the materials of no variant"},
    {"KHR_materials_*", FormatUse::noted, "surfaces reflect as without it"},
    {"KHR_texture_basisu, EXT_texture_*, MSFT_texture_dds", FormatUse::noted,
     "pictures in KTX2, WebP, AVIF and DDS colour nothing and cut no outline"},
    {"COLOR_0", FormatUse::noted, "points do not get the colours of vertices"},
    {"CESIUM_RTC", FormatUse::noted, "the model is not moved to its place on the globe"},
    {"normalTexture", FormatUse::noted, "surfaces are flat between their corners"},
    {"animations", FormatUse::noted, "nodes stand as without animation"},
    {"skins", FormatUse::noted, "meshes stand as modelled, not as their bones do"},
    {"weights", FormatUse::noted, "meshes have their shapes without morph targets"},
    {"scenes", FormatUse::noted, "of several scenes, the default one is read, or the first"},
    {"EXT_meshopt_compression, KHR_meshopt_compression", FormatUse::refused,
     "a file without it, as gltfpack makes without -c"},
    {"WEB3D_quantized_attributes, minVersion", FormatUse::refused, "glTF 2.0"},
    {"*", FormatUse::noted, "the file does not require it, and is read as without it"},
});

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
