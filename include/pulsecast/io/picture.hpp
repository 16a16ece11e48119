// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_PICTURE_HPP
#define PULSECAST_IO_PICTURE_HPP

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/io/detail/material_pictures.hpp>
#include <pulsecast/material/reflectance_map.hpp>
#include <pulsecast/shape/mesh_data.hpp>

/// Pictures of surfaces: PNG, JPEG, BMP, TGA, GIF, PSD and PNM, read by stb_image.
namespace PULSECAST_NAMESPACE::io {

/// Settings of `read_picture`.
struct PictureSettings {
  std::size_t max_pixels = std::size_t{1} << 26;  ///< maximum number of pixels
  bool isolated = false;  ///< true: in a child process with 1.5 GB and 30 s; for untrusted files
};

/// Picture, of 16 bits a channel the upper 8. @throws FileError if missing, damaged or too large
[[nodiscard]] Image read_picture(const PictureSource& source, const PictureSettings& settings = {});

/// Reads the pictures of the materials of a mesh, each once: colours and reflectances into the
/// materials, outlines into the masks of the mesh. What cannot be read, or is of a mesh without
/// texture coordinates, is left out with a warning. Without an outline the surface is solid.
void add_pictures(MeshData& mesh, std::vector<Material>& materials, std::span<const MaterialPictures> pictures,
                  std::vector<std::string>& warnings, const PictureSettings& settings = {});

}  // namespace PULSECAST_NAMESPACE::io

#if PULSECAST_DEFINES(IO_PICTURE)
#include <algorithm>
#include <map>
#include <memory>

#include <stb/stb_image.h>

#include <pulsecast/base/shared_array.hpp>
#include <pulsecast/io/detail/child_process.hpp>

namespace PULSECAST_NAMESPACE::io {

namespace detail {

/// Pictures by file, each read once.
struct PictureShelf {
  std::vector<std::string>& warnings;
  const PictureSettings& settings;
  std::map<std::pair<std::filesystem::path, const void*>, std::shared_ptr<const Image>> pictures{};

  /// Picture, or null with a warning.
  [[nodiscard]] std::shared_ptr<const Image> get(const PictureSource& source) {
    const auto [known, is_new] = pictures.try_emplace({source.file, source.embedded.get()});
    try {
      if (is_new) known->second = std::make_shared<const Image>(read_picture(source, settings));
    } catch (const FileError& e) {
      warnings.push_back(std::string(e.what()) + "; it is left out");
    }
    return known->second;
  }
};

/// Outline of a material; empty if it is solid everywhere.
[[nodiscard]] inline Mask outline(const MaterialPictures& of, PictureShelf& shelf) {
  const bool by_colour = of.opacity.empty() && of.outlined_by_colour;
  const PictureSource& source = by_colour ? of.colour : of.opacity;
  if (source.empty()) return {};
  const auto picture = shelf.get(source);
  if (!picture || (by_colour && !picture->has_opacity())) return {};
  Mask mask = Mask::of(*picture, picture->has_opacity() ? picture->channels - 1 : 0, of.cutoff);
  return mask.solid_share() < 1 ? std::move(mask) : Mask{};
}

/// Picture by stb_image, in this process.
[[nodiscard]] inline Image decoded(const PictureSource& source, std::size_t max_pixels) {
  const std::filesystem::path& path = source.file;
  std::optional<MappedFile> file;
  if (!source.embedded) file.emplace(source.file);
  const std::span<const std::byte> bytes = file ? file->bytes() : std::span<const std::byte>(*source.embedded);
  if (bytes.size() > 0x7FFFFFFF) detail::fail(path, "is a picture of more than 2^31 bytes");
  const auto* const data = reinterpret_cast<const stbi_uc*>(bytes.data());
  const auto size = static_cast<int>(bytes.size());
  int width = 0, height = 0, channels = 0;
  const auto require = [&](bool read) {
    if (!read)
      detail::fail(path, "is no picture that can be read: ", stbi_failure_reason(),
                   "; expected PNG, JPEG, BMP, TGA, GIF, PSD or PNM");
  };
  require(stbi_info_from_memory(data, size, &width, &height, &channels) != 0);
  if (width < 1 || height < 1 || width > 65536 || height > 65536 ||
      static_cast<double>(width) * height > static_cast<double>(max_pixels))
    detail::fail(path, "has ", width, " x ", height, " pixels, expected at most ", max_pixels, ", and 65536 a side");
  const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
      stbi_load_from_memory(data, size, &width, &height, &channels, 0), stbi_image_free);
  require(pixels != nullptr);
  const auto whole = [](int number) { return static_cast<std::uint32_t>(number); };
  Image image{whole(width), whole(height), whole(channels)};
  const SharedBuffer<std::uint8_t> samples(std::size_t{image.width} * image.height * image.channels);
  std::copy_n(pixels.get(), samples.size(), samples.data());
  image.samples = samples;
  return image;
}

}  // namespace detail

PULSECAST_INLINE Image read_picture(const PictureSource& source, const PictureSettings& settings) {
  const auto decode = [&] { return detail::decoded(source, settings.max_pixels); };
  if (!settings.isolated) return reading(source.file, decode);
  return detail::ChildProcess::result(source.file.string(), {.memory = 1.5e9, .time = 30}, decode);
}

PULSECAST_INLINE void add_pictures(MeshData& mesh, std::vector<Material>& materials,
                                   std::span<const MaterialPictures> pictures, std::vector<std::string>& warnings,
                                   const PictureSettings& settings) {
  detail::PictureShelf shelf{warnings, settings};
  for (std::size_t i = 0; i < std::min(materials.size(), pictures.size()); ++i) {
    const MaterialPictures& of = pictures[i];
    if (of.empty()) continue;
    if (mesh.texture.empty()) {
      warnings.push_back(text::message("material '", materials[i].name,
                                       "' has pictures, which are left out, as the mesh has no texture coordinates"));
      continue;
    }
    if (!of.colour.empty()) materials[i].picture = shelf.get(of.colour);
    if (!of.reflectance.empty())
      if (const auto picture = shelf.get(of.reflectance))
        materials[i].reflectance_map = std::make_shared<const ReflectanceMap>(
            of.reflectance_pattern ? ReflectanceMap::pattern(*picture) : ReflectanceMap(*picture));
    if (Mask mask = detail::outline(of, shelf); mask.width > 0) {
      mesh.masks.resize(std::max(mesh.masks.size(), i + 1));
      mesh.masks[i] = std::move(mask);
    }
  }
}

}  // namespace PULSECAST_NAMESPACE::io

#endif

#endif
