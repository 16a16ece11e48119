// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_GROUND_BUILDER_HPP
#define PULSECAST_HELIOS_DETAIL_GROUND_BUILDER_HPP

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <pulsecast/helios/scene.hpp>
#include <pulsecast/helios/settings.hpp>
#include <pulsecast/io/ascii_grid.hpp>
#include <pulsecast/io/geotiff.hpp>
#include <pulsecast/io/mtl.hpp>
#include <pulsecast/io/png_heights.hpp>
#include <pulsecast/io/world_file.hpp>
#include <pulsecast/shape/class_materials.hpp>
#include <pulsecast/shape/height_field.hpp>
#include <pulsecast/shape/raster.hpp>

/// Conversion of the rasters of a survey document to parts of the library.
namespace PULSECAST_NAMESPACE::helios {

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

/// Reads a raster by the extension of its file. Numbers of missing heights, scale and size of pixels are those of
/// `source`.
PULSECAST_INLINE SceneBuilder::LoadedRaster SceneBuilder::raster(const std::filesystem::path& file,
                                                                 const GeoTiffSource& source) {
  add_files({file});
  add_files(io::world_files_of(file));
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

/// The material of pixels without a class, and then of each class the first, by name, with this number.
PULSECAST_INLINE SceneBuilder::GroundMaterials SceneBuilder::ground_materials(const GeoTiffSource& source) {
  ClassMaterials classes{.materials = {material(source.material)}};
  GroundMaterials made;
  if (!source.classes.empty()) {
    std::map<std::uint16_t, Material> by_class;
    if (!source.material.file.empty())
      for (const auto& [name, one] : io::read_mtl(source.material.file, options_.spectra).materials)
        by_class.try_emplace(one.classification, one);
    require_within("classes with a material (number)", static_cast<double>(by_class.size()), 0, 255, "");
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
