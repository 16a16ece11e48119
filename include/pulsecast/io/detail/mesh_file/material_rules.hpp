// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_MESH_FILE_MATERIAL_RULES_HPP
#define PULSECAST_IO_DETAIL_MESH_FILE_MATERIAL_RULES_HPP

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string>
#include <system_error>
#include <vector>

#include <tiny_obj_loader.h>

#include <pulsecast/io/detail/mesh_file/model.hpp>
#include <pulsecast/io/detail/mesh_file/raw_scene.hpp>
#include <pulsecast/io/detail/obj/mtl_light.hpp>
#include <pulsecast/io/mtl.hpp>
#include <pulsecast/material/material.hpp>
#include <pulsecast/material/microfacet.hpp>
#include <pulsecast/material/phong.hpp>

/// Materials of mesh files.
namespace PULSECAST_NAMESPACE::io::detail {

/// Number from an interval; one that is none becomes the lower end.
[[nodiscard]] inline double within(float value, double low, double high) noexcept {
  return value >= low ? std::min(static_cast<double>(value), high) : low;
}

/// Material from the properties of a file.
class MaterialRules {
 public:
  explicit MaterialRules(bool reflectance_of_colour) : reflectance_of_colour_(reflectance_of_colour) {}

  [[nodiscard]] Material operator()(const RawMaterial& from) const {
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
    if (reflectance_of_colour_) made.reflectance = dot(linear, Vec3(0.2126, 0.7152, 0.0722));
    made.classification = o.classification;
    made.ground = o.ground;
    gloss(o, made);
    clear(o, made);
    return made;
  }

 private:
  /// Phong's law by the rule of `read_mtl`; facets of glTF, whose slope is the square of the roughness. Source:
  /// glTF 2.0, B.2.
  static void gloss(const RawOptics& o, Material& made) {
    const double specular = within(o.specular[0], 0, 1) + within(o.specular[1], 0, 1) + within(o.specular[2], 0, 1);
    const double diffuse = within(o.colour[0], 0, 1) + within(o.colour[1], 0, 1) + within(o.colour[2], 0, 1);
    if (specular > 0 && o.shininess > 0) {
      made.law = Phong{specular / (diffuse + specular), within(o.shininess, 0, 1e6)};
    } else if (o.linear && o.roughness >= 0 && o.roughness < 1 && !(o.metallic > 0)) {
      made.law = Microfacet{std::clamp(static_cast<double>(o.roughness) * static_cast<double>(o.roughness), 1e-3, 2.0)};
    }
  }

  /// Mirrors and bodies of glass, by the rules of MTL files. Transmitted light is not scattered.
  static void clear(const RawOptics& o, Material& made) {
    tinyobj::material_t light{};
    std::fill(std::begin(light.specular), std::end(light.specular), 0.0);
    light.metallic = 0;
    light.illum = 0;
    light.ior = 1;
    const double through = std::max(1 - within(o.opacity, 0, 1), within(o.transmission, 0, 1));
    if (through > 0) {
      light.illum = 6;
      made.reflectance *= 1 - through;
      light.ior = o.index > 1 && o.index <= 4 ? static_cast<double>(o.index) : 1;
    } else if (o.metallic > 0 && o.roughness <= 0.1F) {
      light.metallic = within(o.metallic, 0, 1);
    }
    (void)set_standard_light(made, light);
    if (made.law.reflects_interface() && o.index > 1 && o.index <= 4 && !made.smooth.passes_light())
      made.smooth.inside.index = static_cast<double>(o.index);
  }

  bool reflectance_of_colour_;
};

/// Pictures of materials as files.
class PictureFinder {
 public:
  /// Adds to the warnings, and to the files that were looked for.
  PictureFinder(const std::filesystem::path& file, const RawScene& scene, bool anywhere,
                std::vector<std::string>& warnings, std::vector<std::filesystem::path>& files)
      : file_(file), scene_(scene), anywhere_(anywhere), warnings_(warnings), files_(files) {}

  [[nodiscard]] MaterialPictures operator()(const RawMaterial& of) const {
    return {.colour = source(of, of.colour),
            .opacity = source(of, of.opacity),
            .outlined_by_colour = of.optics.outlined,
            .cutoff = within(of.optics.cutoff, 0, 1)};
  }

 private:
  [[nodiscard]] PictureSource source(const RawMaterial& of, const RawPicture& picture) const {
    if (picture.name.empty()) return {};
    if (picture.embedded >= 0 && static_cast<std::size_t>(picture.embedded) < scene_.embedded.size())
      return {.file = file_.string() + ", picture " + picture.name,
              .embedded = scene_.embedded[static_cast<std::size_t>(picture.embedded)]};
    const std::filesystem::path folder = std::filesystem::absolute(file_).parent_path();
    std::string name = picture.name;
    std::replace(name.begin(), name.end(), '\\', '/');
    if (name.starts_with("file://")) name.erase(0, 7);
    std::error_code ignored;
    // as named, with the signs of an address, and by the last word alone, for files that were moved
    for (const std::filesystem::path& candidate :
         {folder / name, folder / unescaped(name), folder / std::filesystem::path(name).filename()}) {
      if (!anywhere_ && !is_inside(folder, candidate)) continue;
      files_.push_back(candidate);
      if (std::filesystem::is_regular_file(candidate, ignored)) return {.file = candidate};
    }
    warnings_.push_back(file_.string() + ": material '" + of.name + "' has the picture '" + picture.name +
                        "', which is not there" +
                        (is_inside(folder, folder / name) ? "" : " or outside the file's folder") + ": it is left out");
    return {};
  }

  const std::filesystem::path& file_;
  const RawScene& scene_;
  bool anywhere_;
  std::vector<std::string>& warnings_;
  std::vector<std::filesystem::path>& files_;
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
