// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_PICTURE_HPP
#define PULSECAST_IO_PICTURE_HPP

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/scene/image.hpp>
#include <pulsecast/scene/material.hpp>
#include <pulsecast/scene/triangle_mesh.hpp>

/// Pictures of surfaces: PNG, JPEG, BMP, TGA, GIF, PSD and PNM, read by stb_image.
namespace PULSECAST_NAMESPACE::io {

/// Picture that a material names: a file, or bytes inside the file of the mesh.
struct PictureSource {
  std::filesystem::path file{};                              ///< path of the file; of embedded bytes, a name for messages; empty: none
  std::shared_ptr<const std::vector<std::byte>> embedded{};  ///< content of the file if it is embedded

  [[nodiscard]] bool empty() const noexcept { return file.empty() && !embedded; }
};

/// Pictures of a material, not read yet.
struct MaterialPictures {
  PictureSource colour{};           ///< colour of points
  PictureSource opacity{};          ///< outline: by its opacity, or by its grey or red without one
  PictureSource reflectance{};      ///< reflectance
  bool outlined_by_colour = false;  ///< true if the opacity of the colour picture is the outline; without effect if it has none
  double cutoff = 0.5;              ///< opacity from which a surface is solid, in [0, 1]
};

/// Reads a picture. Throws a `FileError` for a file that is missing, damaged, or has more than `max_pixels` pixels.
[[nodiscard]] Image read_picture(const PictureSource& source, std::size_t max_pixels = std::size_t{1} << 28);

/// Reads the pictures of the materials of a mesh, each once: colours and reflectances into the materials, outlines into the masks of the
/// mesh. A picture that cannot be read is a warning, and left out.
void add_pictures(MeshData& mesh, std::vector<Material>& materials, std::span<const MaterialPictures> pictures,
                  std::vector<std::string>& warnings);

}  // namespace PULSECAST_NAMESPACE::io

#if PULSECAST_DEFINITIONS
#include <pulsecast/io/detail/picture_reader.hpp>
#endif

#endif
