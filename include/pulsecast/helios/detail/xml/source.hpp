// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_XML_SOURCE_HPP
#define PULSECAST_HELIOS_DETAIL_XML_SOURCE_HPP

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <pulsecast/base/vector.hpp>
#include <pulsecast/helios/detail/asset_search.hpp>
#include <pulsecast/helios/detail/xml/element.hpp>
#include <pulsecast/helios/detail/xml/fields.hpp>
#include <pulsecast/helios/settings.hpp>

/// Filters that load the geometry of a part.
namespace PULSECAST_NAMESPACE::helios::xml {

template <class Io>
void fields(Io& io, Of<Io, MaterialSource>& material) {
  io.file("matfile", material.file);
  io.text("matname", material.name);
  io.whole("randomMaterials", material.random, 0, 1'000'000);
  io.number("randomRange", material.random_range, units::one, 0, 1e6);
}

/// `filepath`, `efilepath`, or, as an extension, `filepaths` with `|` between them.
template <class Io>
void files(Io& io, Of<Io, std::vector<std::filesystem::path>>& paths) {
  if constexpr (Io::reads) {
    const auto take = [&](const char* name, const std::string& text, const AssetMatch& match) {
      io.take(name, text, match);
      paths.insert(paths.end(), match.files.begin(), match.files.end());
    };
    const auto one = io.given("filepath"), by_pattern = io.given("efilepath"), list = io.given("filepaths");
    if (by_pattern) {
      take("efilepath", *by_pattern, io.search().find_all(*by_pattern));
    } else if (list) {
      for (std::string_view rest = *list; paths.size() < 100'000;) {
        const std::size_t end = rest.find('|');
        take("filepaths", std::string(rest.substr(0, end)), io.search().find(std::string(rest.substr(0, end))));
        if (end == std::string_view::npos) break;
        rest.remove_prefix(end + 1);
      }
    } else if (one) {
      take("filepath", *one, io.search().find(*one));
    } else {
      io.require({"filepath"});
    }
  } else if (paths.size() == 1) {
    io.file("filepath", paths.front());
  } else {
    std::string text;
    for (const std::filesystem::path& path : paths)
      text.append(text.empty() ? "" : "|").append(std::filesystem::absolute(path).string());
    io.text("filepaths", text);
  }
}

template <class Io>
void fields(Io& io, Of<Io, ObjSource>& source) {
  files(io, source.files);
  io.choice("up", source.y_up, {{"z", false}, {"y", true}});
  io.without_effect({"recomputeVertexNormals"});
}

template <class Io>
void fields(Io& io, Of<Io, GeoTiffSource>& source) {
  files(io, source.files);
  fields(io, source.material);
  io.flag("mosaic", source.mosaic);
  io.file("classfile", source.classes);
  io.flag("classcolours", source.class_colours);
  io.number("heightScale", source.height_scale, units::metre, 1e-9, 1e6);
  io.number("heightOffset", source.height_offset, units::metre, -1e9, 1e9);
  io.number("noDataValue", source.missing, units::one, -1e300, 1e300);
  io.number("pixelSize", source.pixel_size, units::metre, 1e-6, 1e6);
}

template <class Io>
void fields(Io& io, Of<Io, XyzSource>& source) {
  files(io, source.files);
  fields(io, source.material);
  io.text("separator", source.separator);
  io.require({"voxelSize"});
  io.number("voxelSize", source.voxel_size, units::metre, 0, 1e6);
  io.vector("defaultNormal", source.default_normal, 1e6);
  io.whole("estimateNormals", source.estimate_normals, 0, 1'000'000);
  io.flag("snapNeighborNormal", source.snap_neighbor_normal);
  static constexpr std::array normals{"normalXIndex", "normalYIndex", "normalZIndex"};
  for (std::size_t i = 0; i < 3; ++i) io.whole(normals[i], source.normal_columns[i], 0, 999);
  io.without_effect({"rgbRIndex", "rgbGIndex", "rgbBIndex", "maxColorValue"}, "has no effect: voxels have no colour");
  if constexpr (Io::reads) {
    io.without_effect({"sparse"});
    if (source.voxel_size == 0) {
      source.voxel_size = 1;
      io.warn("voxelSize", "voxelSize of 0 means 1 m");
    }
    if (source.default_normal == Vec3{}) {
      source.default_normal.reset();
      io.warn("defaultNormal", "defaultNormal is zero: it has no direction, and no effect");
    }
  }
}

template <class Io>
void fields(Io& io, Of<Io, VoxelSource>& source) {
  files(io, source.files);
  fields(io, source.material);
  io.choice("intersectionMode", source.mode,
            {{"transmittive", VoxelMode::transmittive}, {"fixed", VoxelMode::fixed}, {"scaled", VoxelMode::scaled}});
  io.number("intersectionArgument", source.scaling_exponent, units::one, 0, 100);
  io.flag("randomShift", source.random_shift);
  io.file("ladlut", source.leaf_angles);
  io.number("leafArea_m2", source.leaf_area, units::one, 0, 100);
  io.number("clumping", source.clumping, units::one, 0.01, 10);
}

template <class Io>
void fields(Io& io, Of<Io, MeshSource>& source) {
  files(io, source.files);
  io.choice("up", source.up, {{"file", MeshUp::file}, {"z", MeshUp::z}, {"y", MeshUp::y}});
  io.number("unit", source.unit, units::metre, 1e-9, 1e9);
  io.file("materials", source.materials);
}

}  // namespace PULSECAST_NAMESPACE::helios::xml

#endif
