// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_MESH_FILE_RAW_SCENE_HPP
#define PULSECAST_IO_DETAIL_MESH_FILE_RAW_SCENE_HPP

#include <pulsecast/io/detail/child_process.hpp>
#include <pulsecast/io/detail/mesh_file/model.hpp>

/// Content of a mesh file as an importer has it, before materials and units, for a child process.
namespace PULSECAST_NAMESPACE::io::detail {

struct Float3 {
  float x = 0, y = 0, z = 0;
  friend bool operator==(const Float3&, const Float3&) = default;
};
using Corners3 = std::array<std::uint32_t, 3>;  ///< vertex indices of a triangle

struct Affine {
  Matrix3 linear{1};  ///< columns are the images of the axes
  Vec3 shift{};       ///< image of the origin

  [[nodiscard]] Affine operator*(const Affine& inner) const {
    return {linear * inner.linear, linear * inner.shift + shift};
  }
};

inline const Matrix3 y_up{Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(0, -1, 0)};  ///< to z up

/// Mesh of one material.
struct RawMesh {
  std::string name{};
  std::uint32_t material = 0;
  SharedArray<Float3> vertices{};
  SharedArray<Vec3> precise{};        ///< vertices of double precision, in place of those
  SharedArray<Corners3> triangles{};  ///< indices are below the number of vertices
  SharedArray<Float3> texture{};      ///< of the vertices, upward; empty without

  [[nodiscard]] std::size_t vertex_count() const noexcept { return precise.empty() ? vertices.size() : precise.size(); }

  void archive(auto& a) { a(name, material, vertices, precise, triangles, texture); }

  /// True if vertices of triangles exist, and all vertices or none have texture coordinates.
  [[nodiscard]] bool is_consistent() const {
    const auto is_vertex = [&](std::uint32_t vertex) { return vertex < vertex_count(); };
    return (texture.empty() || texture.size() == vertex_count()) &&
           std::ranges::all_of(triangles, [&](const Corners3& c) { return std::ranges::all_of(c, is_vertex); });
  }
};

/// Node that shows meshes.
struct RawNode {
  std::string name{};                   ///< names of nodes joined by `/`
  Affine place{};                       ///< to the frame of the root
  std::vector<std::uint32_t> meshes{};  ///< numbers of meshes

  void archive(auto& a) { a(name, place, meshes); }
};

/// Picture that a material names.
struct RawPicture {
  std::string name{};          ///< path as in the file, or name of an embedded one; empty: none
  std::int64_t embedded = -1;  ///< number of an embedded picture; negative: none

  void archive(auto& a) { a(name, embedded); }
};

/// Numbers of a material that are plain.
struct RawOptics {
  std::array<float, 3> colour{1, 1, 1};    ///< base colour, or diffuse colour
  std::array<float, 3> specular{0, 0, 0};  ///< specular colour of Phong's law
  float shininess = -1;                    ///< its exponent; negative: none
  float opacity = 1;                       ///< of the base colour
  float transmission = 0;                  ///< transmitted share of the light
  float index = 0;                         ///< refractive index; 0: none
  float metallic = 0, roughness = -1;      ///< of glTF; negative: none
  float cutoff = 0.5F;                     ///< opacity from which pixels are solid
  bool outlined = false;                   ///< true: holes by the opacity of the colour picture
  bool linear = false;                     ///< true: the colour is a linear share of light
  std::uint16_t classification = 0;        ///< ASPRS class
  bool ground = false;                     ///< true if it may carry set-ups
};

struct RawMaterial {
  std::string name{};
  RawOptics optics{};
  RawPicture colour{}, opacity{};  ///< pictures

  void archive(auto& a) { a(name, optics, colour, opacity); }
};

struct RawScene {
  std::vector<RawMesh> meshes{};
  std::vector<RawNode> nodes{};
  std::vector<RawMaterial> materials{};
  std::vector<std::shared_ptr<const std::vector<std::byte>>> embedded{};  ///< pictures, as files
  std::vector<std::string> warnings{};
  std::vector<std::string> files{};  ///< further files that the importer looked for
  double unit = 1;                   ///< size of a unit by the file [m]
  double applied_unit = 1;           ///< unit by the file that the importer applies already [m]
  Matrix3 upright{1};                ///< to z up, by the file
  std::string reference{};           ///< name of a reference system

  void archive(auto& a) {
    a(meshes, nodes, materials, embedded, warnings, files, unit, applied_unit, upright, reference);
  }

  /// True if all meshes have a material, and all nodes meshes.
  [[nodiscard]] bool is_consistent() const {
    const auto is_mesh = [&](std::uint32_t mesh) { return mesh < meshes.size(); };
    return std::ranges::all_of(meshes, [&](const RawMesh& mesh) { return mesh.material < materials.size(); }) &&
           std::ranges::all_of(nodes, [&](const RawNode& node) {
             return !node.meshes.empty() && std::ranges::all_of(node.meshes, is_mesh);
           });
  }
};

/// Message of a library, cut and without the bytes of the file that it may have.
[[nodiscard]] inline std::string printable(std::string message) {
  message.resize(std::min<std::size_t>(message.size(), 300));
  for (char& c : message)
    if (c < ' ' || c > '~') c = '?';
  return message;
}

/// Limits of the import of a file.
[[nodiscard]] inline ChildLimits child_limits(const std::filesystem::path& path, const ImportLimits& limits) {
  std::error_code ignored;
  const auto size = static_cast<double>(std::filesystem::file_size(path, ignored));
  const double bytes = ignored ? 0 : size;
  return {.memory = limits.memory + limits.memory_per_byte * bytes, .time = limits.time + limits.time_per_byte * bytes};
}

/// Result of an import in a child process: `import` takes a function to call with the size of each
/// further file [byte].
template <class Import>
[[nodiscard]] RawScene imported_apart(const std::filesystem::path& path, const ImportLimits& limits,
                                      const Import& import) {
  const auto opened = [&](std::uint64_t more) {
    ChildProcess::allow(limits.memory_per_byte * static_cast<double>(more));
  };
  return ChildProcess::result(path.string(), child_limits(path, limits), [&] { return import(opened); });
}

/// Scene of a file by assimp, in a child process if `settings.isolated`. A program that defines it itself is compiled
/// with PULSECAST_IMPORTS_APART, and needs no assimp.
[[nodiscard]] RawScene foreign_scene(const std::filesystem::path& path, const MeshFileSettings& settings);

/// True for a path that does not leave a folder by its words; links are followed.
[[nodiscard]] inline bool is_inside(const std::filesystem::path& folder, const std::filesystem::path& file) {
  const std::filesystem::path within = std::filesystem::absolute(file).lexically_normal().lexically_relative(
      std::filesystem::absolute(folder).lexically_normal());
  return !within.empty() && *within.begin() != "..";
}

/// Text with `%20` as a blank, and so on. Source: RFC 3986, 2.1.
[[nodiscard]] inline std::string unescaped(const std::string& text) {
  std::string made;
  for (std::size_t i = 0; i < text.size(); ++i) {
    std::string_view digits = std::string_view(text).substr(i + 1, 2);
    const bool marked = text[i] == '%' && digits.size() == 2;
    const std::optional<unsigned> code = marked ? text::take_number<unsigned>(digits, 16) : std::nullopt;
    const bool escape = code && digits.empty();
    made += escape ? static_cast<char>(*code) : text[i];
    if (escape) i += 2;
  }
  return made;
}

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
