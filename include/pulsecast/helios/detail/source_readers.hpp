// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_SOURCE_READERS_HPP
#define PULSECAST_HELIOS_DETAIL_SOURCE_READERS_HPP

#include <pulsecast/helios/scene.hpp>
#include <pulsecast/io/ascii_grid.hpp>
#include <pulsecast/io/geotiff.hpp>
#include <pulsecast/io/leaf_angles.hpp>
#include <pulsecast/io/mesh_file.hpp>
#include <pulsecast/io/mtl.hpp>
#include <pulsecast/io/obj.hpp>
#include <pulsecast/io/picture.hpp>
#include <pulsecast/io/png_heights.hpp>
#include <pulsecast/io/vox.hpp>
#include <pulsecast/io/world_file.hpp>
#include <pulsecast/shape/class_materials.hpp>

/// Reading of the sources of parts.
namespace PULSECAST_NAMESPACE::helios {

PULSECAST_INLINE std::vector<SceneBuilder::Loaded> SceneBuilder::read(const ObjSource& source) {
  return each(source.files, [&](const std::filesystem::path& file, std::vector<Loaded>& all) {
    const io::UpAxis up_axis = source.y_up ? io::UpAxis::y : io::UpAxis::z;
    io::ObjModel model = io::read_obj(file, {.up = up_axis, .spectra = options_.spectra}, options_.threads);
    io::add_pictures(model.mesh, model.materials, model.pictures, model.warnings, {.isolated = true});
    warn(model.warnings);
    for (const io::MaterialPictures& pictures : model.pictures) pictures.append_to(model.files);
    add_files(model.files);
    if (model.mesh.triangles.empty()) return warn({file.string() + ": is left out"});
    all.push_back({std::make_shared<const MaskedMesh<>>(std::move(model.mesh), options_.threads),
                   table(std::move(model.materials))});
  });
}

PULSECAST_INLINE std::vector<SceneBuilder::Loaded> SceneBuilder::read(const XyzSource& source) {
  io::PointCloudSettings s{
      .voxel_size = source.voxel_size, .default_normal = source.default_normal, .classes = source.material.random == 0};
  s.normals = source.estimate_normals > 0   ? io::VoxelNormals::fitted
              : source.snap_neighbor_normal ? io::VoxelNormals::nearest
                                            : io::VoxelNormals::mean;
  s.columns.separators = source.separator;
  io::TextPointColumns::Columns normal{};
  std::transform(source.normal_columns.begin(), source.normal_columns.end(), normal.begin(),
                 [](int column) { return static_cast<std::size_t>(column); });
  s.columns.normal = normal;
  s.validate();
  return each(source.files, [&](const std::filesystem::path& file, std::vector<Loaded>& all) {
    io::PointCloud cloud = io::read_point_cloud(file, s);
    if (s.normals == io::VoxelNormals::fitted && !s.default_normal)
      drop_bare(file, cloud);
    else
      warn(cloud.warnings);
    if (cloud.voxels.cells.empty())
      return warn(
          {file.string() + ": has no voxel of three points or more, as required by estimateNormals, and is left out"});
    MaterialTable materials = assign_materials(source.material, cloud.voxels, cloud.classes);
    all.push_back({std::make_shared<const VoxelGrid<OpaqueVoxels>>(cloud.voxels), std::move(materials)});
  });
}

/// Removes voxels without a fitted plane.
PULSECAST_INLINE void SceneBuilder::drop_bare(const std::filesystem::path& file, io::PointCloud& cloud) {
  VoxelData& v = cloud.voxels;
  const auto is_bare = [&](std::size_t i) { return v.normals[i] == std::array<float, 3>{}; };
  std::size_t kept = 0;
  const std::size_t all = v.normals.size();
  for (std::size_t i = 0; i < all; ++i)
    if (!is_bare(i)) {
      v.cells[kept] = v.cells[i];
      if (!cloud.classes.empty()) cloud.classes[kept] = cloud.classes[i];
      v.normals[kept++] = v.normals[i];
    }
  if (kept == all) return warn(cloud.warnings);
  if (all > 0) {
    v.cells.resize(kept);
    v.normals.resize(kept);
  }
  warn({file.string() + ": " + std::to_string(all - kept) + " of " + std::to_string(all) +
        " voxels have too few points for a normal, and are left out; defaultNormal would keep them"});
}

PULSECAST_INLINE std::vector<SceneBuilder::Loaded> SceneBuilder::read(const VoxelSource& source) {
  io::VoxelFileSettings s{.exponent = source.scaling_exponent};
  s.use = source.mode == VoxelMode::transmittive ? io::VoxelUse::transmissive
          : source.mode == VoxelMode::fixed      ? io::VoxelUse::opaque
                                                 : io::VoxelUse::scaled;
  if (source.random_shift) s.shift = options_.seed;
  s.validate();
  if (!source.leaf_angles.empty()) add_files({source.leaf_angles});
  const LeafAngles leaves =
      source.leaf_angles.empty() ? LeafAngles::spherical() : io::read_leaf_angles(source.leaf_angles);
  return each(source.files, [&](const std::filesystem::path& file, std::vector<Loaded>& all) {
    io::VoxelFile voxels = io::read_voxel_file(file, s);
    warn(voxels.warnings);
    if (voxels.voxels.cells.empty()) return warn({file.string() + ": holds no occupied voxel, and is left out"});
    MaterialTable materials = assign_materials(source.material, voxels.voxels, {});
    if (!source.leaf_angles.empty())  // a `ladlut` has 2 pi times the extinction
      for (float& density : voxels.voxels.densities) density /= static_cast<float>(2 * pi);
    if (source.mode == VoxelMode::transmittive)
      all.push_back(
          {std::make_shared<const VoxelGrid<TransmissiveVoxels>>(
               voxels.voxels, TransmissiveVoxels{leaves, options_.tilted_leaves, source.leaf_area, source.clumping}),
           materials});
    else if (source.mode == VoxelMode::fixed)
      all.push_back({std::make_shared<const VoxelGrid<OpaqueVoxels>>(voxels.voxels), materials});
    else
      all.push_back({std::make_shared<const VoxelGrid<ScaledVoxels>>(voxels.voxels), materials});
  });
}

/// Files are imported by child processes, so that a damaged one ends as an error.
PULSECAST_INLINE std::vector<SceneBuilder::Loaded> SceneBuilder::read(const MeshSource& source) {
  io::MeshFileSettings settings{
      .unit = source.unit, .materials = source.materials, .spectra = options_.spectra, .isolated = true};
  if (source.up != MeshUp::file) settings.up = source.up == MeshUp::y ? io::UpAxis::y : io::UpAxis::z;
  return each(source.files, [&](const std::filesystem::path& file, std::vector<Loaded>& all) {
    const bool city =
        text::lower(file.extension().string()) == ".gml" || text::lower(file.extension().string()) == ".citygml";
    if (city && !options_.city_models)
      throw FileError(file.string(), "", "is a CityGML file, which this program was built without");
    io::MeshFile read = city ? options_.city_models(file, settings, options_.threads)
                             : io::read_mesh_file(file, settings, options_.threads);
    warn(read.warnings);
    add_files(read.files);
    if (read.placements.empty()) warn({file.string() + ": is left out"});
    read.materials = *table(std::move(read.materials));
    for (Part<MaskedMesh<>>& part : io::parts_of(std::move(read), 0, options_.threads))
      all.push_back({std::move(part.geometry), std::move(part.materials), part.placement, std::move(part.name)});
  });
}

PULSECAST_INLINE std::vector<SceneBuilder::Loaded> SceneBuilder::read(const GeoTiffSource& source) {
  GroundMaterials materials;  // read after the first raster
  const auto part_of = [&](Raster raster) -> Loaded {
    if (!materials.table) materials = ground_materials(source);
    const std::size_t unlisted = materials.codes ? set_materials(raster, *materials.codes, materials.listed) : 0;
    if (unlisted > 0)
      warn({source.classes.string() + ": " + std::to_string(unlisted) + " of " + std::to_string(raster.pixels()) +
            " pixels have no class with a material, and get '" + materials.table->front().name + "'"});
    return {std::make_shared<const HeightField>(std::move(raster), options_.threads), materials.table};
  };
  std::vector<Raster> tiles;
  std::vector<Loaded> loaded = each(source.files, [&](const std::filesystem::path& file, std::vector<Loaded>& all) {
    if (source.mosaic)
      tiles.push_back(ground(file, source));
    else
      all.push_back(part_of(ground(file, source)));
  });
  if (source.mosaic && !tiles.empty())
    naming(source.files.front().string(), [&] { loaded.push_back(part_of(mosaic(tiles))); });
  return loaded;
}

/// Reads a raster by the extension of its file; missing heights, scale and pixels are of `source`.
PULSECAST_INLINE SceneBuilder::LoadedRaster SceneBuilder::raster(const std::filesystem::path& file,
                                                                 const GeoTiffSource& source) {
  add_files({file});
  add_files(io::world_files_of(file));
  for (const std::filesystem::path& beside : io::side_files_of(file)) add_files({beside});
  if (io::is_ascii_grid(file)) {
    io::AsciiGrid grid =
        io::read_ascii_grid(file, {.vertical_scale = source.height_scale.value_or(1), .missing = source.missing});
    warn(grid.warnings);
    return {std::move(grid.raster)};
  }
  if (io::is_png(file)) {
    io::PngHeightSettings settings{.vertical_scale = source.height_scale.value_or(1)};
    if (source.missing && *source.missing >= 0 && *source.missing <= 65535 &&
        std::floor(*source.missing) == *source.missing)
      settings.missing = static_cast<std::uint16_t>(*source.missing);
    if (source.pixel_size) settings.pixel = Vec2(*source.pixel_size);
    return {io::read_png_heights(file, settings)};
  }
  io::GeoTiff tiff =
      io::read_geotiff(file, {.vertical_scale = source.height_scale, .missing = source.missing, .packed = true});
  warn(tiff.warnings);
  return {std::move(tiff.raster), std::move(tiff.colours)};
}

PULSECAST_INLINE std::vector<PlacedRaster> SceneBuilder::rasters() {
  std::vector<PlacedRaster> all;
  for (const PartSettings& part : settings_.parts)
    if (const auto* const source = std::get_if<GeoTiffSource>(&part.source))
      for (const std::filesystem::path& file : source->files)
        all.push_back({ground(file, *source), placement_of(part, part.transform)});
  return all;
}

/// Reads a raster of heights.
PULSECAST_INLINE Raster SceneBuilder::ground(const std::filesystem::path& file, const GeoTiffSource& source) {
  LoadedRaster read = this->raster(file, source);
  if (!read.colours.empty())
    warn({file.string() + ": has a colour table, as a map of classes; its numbers are taken as heights"});
  Raster raster = std::move(read.raster);
  raster.packed.offset += source.height_offset;
  if (source.height_offset != 0)
    for (float& height : raster.heights)
      height = static_cast<float>(static_cast<double>(height) + source.height_offset);
  return raster;
}

/// Material of pixels without a class, and then, of each class, the first by name.
PULSECAST_INLINE SceneBuilder::GroundMaterials SceneBuilder::ground_materials(const GeoTiffSource& source) {
  ClassMaterials classes{.materials = {material(source.material)}};
  GroundMaterials made;
  if (!source.classes.empty()) {
    std::map<std::uint16_t, Material> by_class;
    if (!source.material.file.empty())
      for (const auto& [name, one] : io::read_mtl(source.material.file, options_.spectra).materials)
        by_class.try_emplace(one.classification, one);
    require_within("classes with a material (number)", by_class.size(), 0, 255, "");
    for (const auto& [number, one] : by_class) {
      classes.listed.push_back({static_cast<double>(number), static_cast<std::uint8_t>(classes.materials.size())});
      classes.materials.push_back(one);
    }
    LoadedRaster codes = raster(source.classes, {.pixel_size = source.pixel_size});
    if (source.class_colours && codes.colours.empty())
      warn({source.classes.string() + ": has no colour table: classcolours has no effect"});
    if (source.class_colours) colour_classes(classes, codes.raster, codes.colours);
    made.codes = std::move(codes.raster);
    made.listed = std::move(classes.listed);
  }
  made.table = table(std::move(classes.materials));
  return made;
}

}  // namespace PULSECAST_NAMESPACE::helios

#endif
