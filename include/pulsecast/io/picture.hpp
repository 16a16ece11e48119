// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_PICTURE_HPP
#define PULSECAST_IO_PICTURE_HPP

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/io/detail/material_pictures.hpp>
#include <pulsecast/material/image.hpp>
#include <pulsecast/material/material.hpp>
#include <pulsecast/shape/mesh_data.hpp>

/// Pictures of surfaces: PNG, JPEG, BMP, TGA, GIF, PSD and PNM, read by stb_image.
namespace PULSECAST_NAMESPACE::io {

/// Settings of `read_picture`.
struct PictureSettings {
  std::size_t max_pixels = std::size_t{1} << 26;  ///< maximum number of pixels
  /// True: stb_image runs in a child process, with 1.5 GB and 30 s, whose death is a `FileError`. For files that are
  /// not trusted.
  bool isolated = false;
};

/// Reads a picture, of 16 bits a channel the upper eight. Throws a `FileError` for one that is missing, damaged, or too
/// large.
[[nodiscard]] Image read_picture(const PictureSource& source, const PictureSettings& settings = {});

/// Reads the pictures of the materials of a mesh, each once: colours and reflectances into the materials, outlines into
/// the masks of the mesh. A picture that cannot be read, or a mesh without texture coordinates, is a warning, and the
/// picture is left out. Without an outline the surface is solid.
void add_pictures(MeshData& mesh, std::vector<Material>& materials, std::span<const MaterialPictures> pictures,
                  std::vector<std::string>& warnings, const PictureSettings& settings = {});

}  // namespace PULSECAST_NAMESPACE::io

#if PULSECAST_DEFINITIONS
#include <pulsecast/io/detail/picture_reader.hpp>
#endif

#endif
