// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_MESH_FILE_RAW_MATERIAL_HPP
#define PULSECAST_IO_DETAIL_MESH_FILE_RAW_MATERIAL_HPP

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>
#include <assimp/scene.h>

#include <pulsecast/io/detail/mesh_file/raw_scene.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Material with the set of texture coordinates of its pictures.
struct ImportedMaterial {
  RawMaterial material{};
  unsigned channel = 0;
  bool moved_picture = false;  ///< true if texture coordinates are transformed
};

class MaterialImport {
 public:
  MaterialImport(const aiScene& scene, const aiMaterial& from, bool gltf) : scene_(scene), from_(from), gltf_(gltf) {}

  [[nodiscard]] ImportedMaterial read() const {
    ImportedMaterial made;
    RawMaterial& m = made.material;
    if (const auto name = get<aiString>(AI_MATKEY_NAME)) m.name = name->C_Str();
    RawOptics& o = m.optics;
    std::optional<aiColor4D> base = get<aiColor4D>(AI_MATKEY_BASE_COLOR);
    o.linear = gltf_;
    if (!base) base = get<aiColor4D>(AI_MATKEY_COLOR_DIFFUSE);
    if (base) o.colour = {base->r, base->g, base->b};
    if (const auto specular = get<aiColor4D>(AI_MATKEY_COLOR_SPECULAR); specular && !gltf_)
      o.specular = {specular->r, specular->g, specular->b};
    o.shininess = get(AI_MATKEY_SHININESS).value_or(-1);
    o.index = get(AI_MATKEY_REFRACTI).value_or(0);
    o.transmission = get(AI_MATKEY_TRANSMISSION_FACTOR).value_or(0);
    if (const auto metallic = get(AI_MATKEY_METALLIC_FACTOR)) {
      o.metallic = *metallic;
      o.roughness = get(AI_MATKEY_ROUGHNESS_FACTOR).value_or(-1);
    }
    picture(aiTextureType_BASE_COLOR, m.colour, made);
    if (m.colour.name.empty()) picture(aiTextureType_DIFFUSE, m.colour, made);
    if (gltf_) {
      blend(base ? base->a : 1, o);
    } else {
      o.opacity = get(AI_MATKEY_OPACITY).value_or(1);
      picture(aiTextureType_OPACITY, m.opacity, made);
      o.outlined = !m.opacity.name.empty() && m.opacity.name == m.colour.name;
      if (o.outlined) m.opacity = {};
    }
    return made;
  }

 private:
  /// Opacity by the mode of a glTF material. Source: glTF 2.0, 3.9.4.
  void blend(float opacity, RawOptics& o) const {
    const std::string word = get<aiString>(AI_MATKEY_GLTF_ALPHAMODE).value_or(aiString()).C_Str();
    if (word == "BLEND") o.opacity = opacity;
    o.outlined = word == "BLEND" || word == "MASK";
    const float cutoff = get(AI_MATKEY_GLTF_ALPHACUTOFF).value_or(0.5F);
    if (word == "MASK" && opacity > 0) o.cutoff = cutoff / opacity;
    if (word == "MASK" && opacity < cutoff) o.opacity = 0;
  }

  template <class Value = float>
  [[nodiscard]] std::optional<Value> get(const char* key, unsigned type, unsigned index) const {
    Value found{};
    return from_.Get(key, type, index, found) == aiReturn_SUCCESS ? std::optional(found) : std::nullopt;
  }

  void picture(aiTextureType type, RawPicture& to, ImportedMaterial& made) const {
    const auto path = get<aiString>(AI_MATKEY_TEXTURE(type, 0));
    if (!path || path->length == 0) return;
    to.name = path->C_Str();
    if (const aiTexture* const embedded = scene_.GetEmbeddedTexture(path->C_Str()))
      to.embedded = std::find(scene_.mTextures, scene_.mTextures + scene_.mNumTextures, embedded) - scene_.mTextures;
    if (const auto channel = get<int>(AI_MATKEY_UVWSRC(type, 0)); channel >= 0)
      made.channel = static_cast<unsigned>(*channel);
    if (const auto moved = get<aiUVTransform>(AI_MATKEY_UVTRANSFORM(type, 0)))
      made.moved_picture |= moved->mTranslation != aiVector2D() || moved->mScaling != aiVector2D(1, 1) ||
                            moved->mRotation < 0 || moved->mRotation > 0;
  }

  const aiScene& scene_;
  const aiMaterial& from_;
  bool gltf_;
};

/// Picture inside a file, as a file of its own.
[[nodiscard]] inline std::shared_ptr<const std::vector<std::byte>> embedded_picture(const aiTexture& texture) {
  using Bytes = std::vector<std::byte>;
  const auto* const data = reinterpret_cast<const std::byte*>(texture.pcData);
  if (texture.mHeight == 0) return std::make_shared<const Bytes>(data, data + texture.mWidth);
  // pixels of blue, green, red and opacity as a Targa file. Source: Truevision, TGA 2.0, 1991
  const std::size_t pixels = std::size_t{texture.mWidth} * texture.mHeight;
  Bytes file(18 + 4 * pixels);
  if (texture.mWidth > 65535 || texture.mHeight > 65535) return std::make_shared<const Bytes>();
  const auto put = [&](std::size_t at, unsigned value) { file[at] = static_cast<std::byte>(value & 0xFF); };
  put(2, 2);
  put(12, texture.mWidth);
  put(13, texture.mWidth >> 8);
  put(14, texture.mHeight);
  put(15, texture.mHeight >> 8);
  put(16, 32);
  put(17, 0x28);  // eight bits of opacity, rows from the top
  std::copy_n(data, 4 * pixels, file.begin() + 18);
  return std::make_shared<const Bytes>(std::move(file));
}

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
