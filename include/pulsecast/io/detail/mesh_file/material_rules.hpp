// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_MESH_FILE_MATERIAL_RULES_HPP
#define PULSECAST_IO_DETAIL_MESH_FILE_MATERIAL_RULES_HPP

#include <pulsecast/io/detail/mesh_file/raw_scene.hpp>
#include <pulsecast/io/mtl.hpp>
#include <pulsecast/material/microfacet.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Number from an interval; one that is none becomes the lower end.
[[nodiscard]] inline double within(float value, double low, double high) noexcept {
  return value >= low ? std::min(static_cast<double>(value), high) : low;
}

/// Phong's law as `read_mtl`; facets of glTF, of the slope roughness^2. Source: glTF 2.0, B.2.
inline void set_gloss(const RawOptics& o, Material& made) {
  const auto sum = [](const std::array<float, 3>& c) {
    return within(c[0], 0, 1) + within(c[1], 0, 1) + within(c[2], 0, 1);
  };
  const double specular = sum(o.specular), diffuse = sum(o.colour);
  if (specular > 0 && o.shininess > 0) {
    made.law = Phong{specular / (diffuse + specular), within(o.shininess, 0, 1e6)};
  } else if (o.linear && o.roughness >= 0 && o.roughness < 1 && !(o.metallic > 0)) {
    const auto roughness = static_cast<double>(o.roughness);
    made.law = Microfacet{std::clamp(roughness * roughness, 1e-3, 2.0)};
  }
}

/// Mirrors and bodies of glass, by the rules of MTL files. Transmitted light is not scattered.
inline void set_interface(const RawOptics& o, Material& made) {
  const bool has_index = o.index > 1 && o.index <= 4;
  const double index = static_cast<double>(o.index);
  const double through = std::max(1 - within(o.opacity, 0, 1), within(o.transmission, 0, 1));
  if (through > 0) {
    made.reflectance *= 1 - through;
    made.smooth = SmoothInterface::glass();
    if (has_index) made.smooth.inside = {.index = index};
  } else if (o.metallic > 0 && o.roughness <= 0.1F) {
    const double rest = 1 - std::min(made.reflectance, 1.0);
    made.smooth = SmoothInterface::mirror(std::min(within(o.metallic, 0, 1), rest));
  } else if (made.law.reflects_interface() && has_index) {
    made.smooth.inside.index = index;
  }
}

[[nodiscard]] inline Material material_of(const RawMaterial& from, bool reflectance_of_colour) {
  const RawOptics& o = from.optics;
  const bool named = !from.name.empty() && from.name != "DefaultMaterial";
  if (!named && !o.linear) return undescribed("default");
  Material made{.name = named ? from.name : "default"};
  Vec3 linear{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double share = within(o.colour[k], 0, 1);
    made.colour[static_cast<int>(k)] = o.linear ? pulsecast::detail::srgb_encoded(share) : share;
    linear[static_cast<int>(k)] = o.linear ? share : pulsecast::detail::srgb_decoded(share);
  }
  // luminance. Source: IEC 61966-2-1 (sRGB), ITU-R BT.709
  if (reflectance_of_colour) made.reflectance = dot(linear, Vec3(0.2126, 0.7152, 0.0722));
  made.classification = o.classification;
  made.ground = o.ground;
  set_gloss(o, made);
  set_interface(o, made);
  return made;
}

/// Finder of the pictures of materials as files.
struct PictureFinder {
  const std::filesystem::path& file;          ///< file of the mesh
  const RawScene& scene;                      ///< its content
  bool anywhere;                              ///< true: pictures may lie outside its folder
  std::vector<std::string>& warnings;         ///< of pictures that are not there
  std::vector<std::filesystem::path>& files;  ///< those that were looked for

  [[nodiscard]] MaterialPictures operator()(const RawMaterial& of) const {
    return {.colour = source(of, of.colour),
            .opacity = source(of, of.opacity),
            .outlined_by_colour = of.optics.outlined,
            .cutoff = within(of.optics.cutoff, 0, 1)};
  }

  [[nodiscard]] PictureSource source(const RawMaterial& of, const RawPicture& picture) const {
    if (picture.name.empty()) return {};
    if (picture.embedded >= 0 && static_cast<std::size_t>(picture.embedded) < scene.embedded.size())
      return {.file = file.string() + ", picture " + picture.name,
              .embedded = scene.embedded[static_cast<std::size_t>(picture.embedded)]};
    const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
    std::string name = picture.name;
    std::replace(name.begin(), name.end(), '\\', '/');
    if (name.starts_with("file://")) name.erase(0, 7);
    std::error_code ignored;
    // as named, with the signs of an address, and by the last word alone, for files that were moved
    for (const std::filesystem::path& candidate :
         {folder / name, folder / unescaped(name), folder / std::filesystem::path(name).filename()}) {
      if (!anywhere && !is_inside(folder, candidate)) continue;
      files.push_back(candidate);
      if (std::filesystem::is_regular_file(candidate, ignored)) return {.file = candidate};
    }
    const char* const or_outside = is_inside(folder, folder / name) ? "" : " or outside the file's folder";
    warnings.push_back(warning(file.string(), 0, "material '", of.name, "' has the picture '", picture.name,
                               "', which is not there", or_outside, ": it is left out"));
    return {};
  }
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
