// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_MESH_FILE_FILE_MAKER_HPP
#define PULSECAST_IO_DETAIL_MESH_FILE_FILE_MAKER_HPP

#include <pulsecast/base/parallel.hpp>
#include <pulsecast/io/detail/mesh_file/material_rules.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Transform as what is applied to the vertices, and then a placement.
struct SplitTransform {
  Matrix3 shape{1};       ///< symmetric, of determinant 1 or -1; the identity for a similarity
  Placement placement{};  ///< of the shape
  bool is_similarity = true;
};

/// Greatest absolute entry.
[[nodiscard]] inline double greatest(const Matrix3& m) noexcept {
  double most = 0;
  for (int i = 0; i < 3; ++i) most = std::fmax(most, max_norm(m[i]));
  return most;
}

[[nodiscard]] inline Matrix3 inverse_transposed(const Matrix3& m) noexcept {
  const double determinant = dot(m[0], cross(m[1], m[2]));
  return Matrix3(cross(m[1], m[2]) / determinant, cross(m[2], m[0]) / determinant, cross(m[0], m[1]) / determinant);
}

[[nodiscard]] inline Matrix3 transposed(const Matrix3& m) noexcept {
  return Matrix3(m[0][0], m[1][0], m[2][0], m[0][1], m[1][1], m[2][1], m[0][2], m[1][2], m[2][2]);
}

/// Polar decomposition of a transform: those that differ by a similarity have the same shape. Empty
/// if it flattens, or is not finite. Deviations from a similarity of up to 1e-6 are ignored, as of
/// single precision. Source: Higham 1986, SIAM J. Sci. Stat. Comput. 7(4), Newton's iteration.
[[nodiscard]] inline std::optional<SplitTransform> split(const Affine& transform) {
  constexpr double tolerance = 1e-6;
  const double determinant = dot(transform.linear[0], cross(transform.linear[1], transform.linear[2]));
  const double scale = std::cbrt(std::fabs(determinant));
  if (!(scale >= 1e-30 && scale <= 1e30) || !finite(transform.shift)) return std::nullopt;
  const Matrix3 unit = transform.linear * (1 / scale);
  if (!(greatest(unit) <= 1e6)) return std::nullopt;  // flattened to a millionth of a millionth
  Matrix3 turn = unit;
  for (int i = 0; i < 60; ++i) {
    const Matrix3 next = (turn + inverse_transposed(turn)) * 0.5, step = next - turn;
    turn = next;
    if (greatest(step) < 1e-14) break;
  }
  const double sign = determinant < 0 ? -1 : 1;
  SplitTransform made{.shape = transposed(turn) * unit * sign};
  const Rotation rotation = normalize(pulsecast::rotation_of(turn * sign));
  made.placement = {.rotation = rotation, .scale = scale, .translation = transform.shift};
  made.is_similarity = determinant > 0 && greatest(made.shape - Matrix3(1)) <= tolerance;
  if (made.is_similarity) made.shape = Matrix3(1);
  return made;
}

/// Content of a file, from what an importer has of it.
class MeshFileMaker {
 public:
  MeshFileMaker(const std::filesystem::path& path, const RawScene& scene, const MeshFileSettings& settings,
                const Workers& workers)
      : path_(path), scene_(scene), settings_(settings), workers_(workers) {}

  [[nodiscard]] MeshFile make() {
    file_.warnings = scene_.warnings;
    file_.files.assign(scene_.files.begin(), scene_.files.end());
    const Matrix3 upright = !settings_.up ? scene_.upright : *settings_.up == UpAxis::y ? y_up : Matrix3(1);
    const double unit = settings_.unit ? *settings_.unit / scene_.applied_unit : scene_.unit;
    const Affine world{upright * unit, {}};
    for (const RawNode& node : scene_.nodes) add(node, world * node.place);
    if (flat_ > 0) warn(flat_, " triangles without area are left out");
    if (reshaped_ > 0)
      warn(reshaped_, " nodes shear, mirror or stretch their meshes, which become ", shapes_, " meshes of their own");
    if (flattened_ > 0) warn(flattened_, " nodes whose transforms flatten their meshes are left out");
    if (empty_ > 0 && file_.placements.empty())
      detail::fail(path_, "has triangles, and none with an area: expected a mesh");
    if (empty_ > 0) warn(empty_, " meshes have triangles, and none with an area");
    const double rounding = farthest_ * 0x1p-24;  // of 24 bits. Source: IEEE 754-2019, binary32
    if (rounding > 1e-3)
      warn("has coordinates up to ", std::llround(farthest_), " m, which are read in single precision, to ",
           std::ceil(rounding * 1e3) / 1e3,
           " m; OBJ files are read in double precision, and small coordinates with a "
           "translation of the part keep all digits");
    if (file_.placements.empty()) warn("holds no triangle with an area");
    const PictureFinder find{path_, scene_, settings_.files_elsewhere, file_.warnings, file_.files};
    for (const std::uint32_t number : used_) {
      file_.materials.push_back(material_of(scene_.materials[number], settings_.reflectance_of_colour));
      file_.pictures.push_back(find(scene_.materials[number]));
    }
    return std::move(file_);
  }

 private:
  using Numbers = std::vector<std::uint32_t>;  ///< of meshes or materials

  void warn(const auto&... oddity) { file_.warnings.push_back(warning(path_.string(), 0, oddity...)); }

  void add(const RawNode& node, const Affine& transform) {
    std::optional<SplitTransform> split = detail::split(transform);
    if (!split) {
      ++flattened_;
      return;
    }
    const std::optional<std::size_t> mesh = mesh_of(node.meshes, *split);
    if (!mesh) return;
    measure(node, transform);
    reshaped_ += split->is_similarity ? 0 : 1;
    std::string name = node.name;
    if (name.empty() || name.ends_with('/')) name += scene_.meshes[node.meshes.front()].name;
    if (name.empty()) name = path_.stem().string();
    file_.placements.push_back({*mesh, split->placement, std::move(name)});
  }

  /// Notes the place of a node and its meshes of single precision.
  void measure(const RawNode& node, const Affine& transform) {
    for (const std::uint32_t mesh : node.meshes) {
      const RawMesh& one = scene_.meshes[mesh];
      if (!one.precise.empty()) continue;
      const auto [extent, is_new] = extents_.try_emplace(mesh, 0.0F);
      for (std::size_t i = 0; is_new && i < one.vertices.size(); ++i) {
        const Float3& v = one.vertices[i];
        extent->second = std::max({extent->second, std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
      }
      const double size = static_cast<double>(extent->second) * greatest(transform.linear);
      farthest_ = std::max(farthest_, size + max_norm(transform.shift));
    }
  }

  /// Mesh of a shape, one for all shapes that are equal within 1e-6.
  [[nodiscard]] std::optional<std::size_t> mesh_of(const Numbers& meshes, const SplitTransform& split) {
    std::array<std::int64_t, 9> key;
    for (std::size_t i = 0; i < 9; ++i)
      key[i] = std::llround(split.shape[static_cast<int>(i / 3)][static_cast<int>(i % 3)] * 1e6);
    const auto [known, is_new] = made_.try_emplace({meshes, key});
    if (is_new) known->second = made(meshes, split.shape);
    if (is_new && !split.is_similarity) ++shapes_;
    return known->second;
  }

  /// Refuses a mesh of more than a quad's vertices at one point: its numbers are not understood.
  void require_extent(const RawMesh& mesh) const {
    const auto coincide = [](const auto& all) {
      return all.size() > 4 && std::ranges::adjacent_find(all, std::not_equal_to{}) == all.end();
    };
    if (coincide(mesh.vertices) || coincide(mesh.precise))
      detail::fail(path_, "has the mesh ", text::quoted(mesh.name), " of ", mesh.vertex_count(),
                   " vertices, all at one place, as in an encoding that is not known: expected coordinates that "
                   "differ, as in an OBJ file that its program exports");
  }

  [[nodiscard]] std::optional<std::size_t> made(const Numbers& meshes, const Matrix3& shape) {
    FileMesh one;
    Numbers materials, shown;
    for (const std::uint32_t mesh : meshes) {
      if (scene_.meshes[mesh].triangles.empty()) continue;
      require_extent(scene_.meshes[mesh]);
      shown.push_back(mesh);
      const std::uint32_t material = scene_.meshes[mesh].material;
      const auto [number, is_new] = numbers_.try_emplace(material, static_cast<std::uint32_t>(used_.size()));
      if (is_new) used_.push_back(material);
      const auto place = std::find(one.materials.begin(), one.materials.end(), number->second);
      materials.push_back(static_cast<std::uint32_t>(place - one.materials.begin()));
      if (place == one.materials.end()) one.materials.push_back(number->second);
    }
    one.mesh = joined(shown, materials, shape);
    if (one.mesh.triangles.empty()) {
      empty_ += shown.size();
      return std::nullopt;
    }
    file_.meshes.push_back(std::move(one));
    return file_.meshes.size() - 1;
  }

  /// Mesh of meshes by number, each with its place in a table of materials, mapped by `shape`.
  [[nodiscard]] MeshData joined(std::span<const std::uint32_t> meshes, std::span<const std::uint32_t> materials,
                                const Matrix3& shape) {
    MeshData made;
    std::size_t vertices = 0, triangles = 0;
    bool textured = false, several = false;
    for (std::size_t k = 0; k < meshes.size(); ++k) {
      const RawMesh& from = scene_.meshes[meshes[k]];
      vertices += from.vertex_count();
      triangles += from.triangles.size();
      textured = textured || !from.texture.empty();
      several = several || materials[k] != 0;
    }
    if (triangles == 0) return made;
    MeshData::validate_counts(vertices, triangles);
    made.vertices.resize(vertices);
    made.triangles.resize(triangles);
    if (several) made.materials.resize(triangles);
    if (textured) made.texture.resize(triangles);
    const bool mirrors = dot(shape[0], cross(shape[1], shape[2])) < 0;
    std::size_t vertex = 0, triangle = 0;
    for (std::size_t k = 0; k < meshes.size(); ++k) {
      const RawMesh& from = scene_.meshes[meshes[k]];
      place(from, shape, made.vertices.data() + vertex);
      index(from, static_cast<std::uint32_t>(vertex), triangle, made, mirrors);
      if (several) std::fill_n(made.materials.data() + triangle, from.triangles.size(), materials[k]);
      vertex += from.vertex_count();
      triangle += from.triangles.size();
    }
    drop_flat(made);
    return made;
  }

  template <class Work>
  void each(std::size_t count, const Work& work) const {
    constexpr std::size_t chunk = std::size_t{1} << 16;
    for_each_index((count + chunk - 1) / chunk, workers_, [&](std::size_t c) {
      for (std::size_t i = c * chunk; i < std::min((c + 1) * chunk, count); ++i) work(i);
    });
  }

  void place(const RawMesh& from, const Matrix3& shape, Vec3* to) const {
    const bool moved = shape != Matrix3(1);
    const auto vertex = [&](std::size_t i) {
      if (!from.precise.empty()) return from.precise[i];
      const Float3& v = from.vertices[i];
      return Vec3(static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z));
    };
    each(from.vertex_count(), [&](std::size_t i) {
      const Vec3 at = vertex(i);
      if (!is_within(at, 1e12))
        detail::fail(path_, "mesh '", from.name, "': vertex ", i, " is not finite, or beyond 1e12: expected a place");
      to[i] = moved ? shape * at : at;
    });
  }

  /// Triangles and texture coordinates, from a vertex and a triangle of the mesh on.
  void index(const RawMesh& from, std::uint32_t vertex, std::size_t triangle, MeshData& to, bool turned) const {
    const auto at = [&](std::uint32_t corner) {
      const Float3& t = from.texture[corner];
      const Vec2 place(static_cast<double>(t.x), static_cast<double>(t.y));
      if (!(std::fabs(place.x) <= 1e30 && std::fabs(place.y) <= 1e30))
        detail::fail(path_, "mesh '", from.name, "': a texture coordinate of vertex ", corner, " is not finite");
      return place;
    };
    each(from.triangles.size(), [&](std::size_t i) {
      Corners3 c = from.triangles[i];
      if (turned) std::swap(c[1], c[2]);
      to.triangles[triangle + i] = {c[0] + vertex, c[1] + vertex, c[2] + vertex};
      if (!from.texture.empty()) to.texture[triangle + i] = {at(c[0]), at(c[1]), at(c[2])};
    });
  }

  void drop_flat(MeshData& mesh) {
    const auto is_flat = [&](std::size_t i) {
      const Triangle t = mesh.triangle(i);
      return cross(t.b - t.a, t.c - t.a) == Vec3{};
    };
    std::size_t kept = 0;
    const std::size_t all = mesh.triangles.size();
    for (std::size_t i = 0; i < all; ++i) {
      if (is_flat(i)) continue;
      if (!mesh.materials.empty()) mesh.materials[kept] = mesh.materials[i];
      if (!mesh.texture.empty()) mesh.texture[kept] = mesh.texture[i];
      mesh.triangles[kept++] = mesh.triangles[i];
    }
    mesh.triangles.resize(kept);
    if (!mesh.materials.empty()) mesh.materials.resize(kept);
    if (!mesh.texture.empty()) mesh.texture.resize(kept);
    flat_ += all - kept;
  }

  const std::filesystem::path& path_;
  const RawScene& scene_;
  const MeshFileSettings& settings_;
  const Workers& workers_;
  MeshFile file_;
  std::map<std::uint32_t, std::uint32_t> numbers_;  ///< of materials in use, by those of the file
  Numbers used_;
  /// Meshes by what they are made of, and their shape.
  std::map<std::pair<Numbers, std::array<std::int64_t, 9>>, std::optional<std::size_t>> made_;
  std::uint64_t reshaped_ = 0, shapes_ = 0, flattened_ = 0, empty_ = 0, flat_ = 0;
  std::map<std::uint32_t, float> extents_;  ///< greatest coordinate of each mesh in use
  double farthest_ = 0;                     ///< greatest coordinate of single precision [m]
};

/// Replaces materials, and their pictures, by those of the same names in an MTL file.
inline void replace_materials(MeshFile& file, const MeshFileSettings& settings) {
  if (settings.materials.empty()) return;
  const MaterialLibrary library = read_mtl(settings.materials, settings.spectra);
  file.files.push_back(settings.materials);
  file.warnings.insert(file.warnings.end(), library.warnings.begin(), library.warnings.end());
  for (std::size_t i = 0; i < file.materials.size(); ++i) {
    const auto found = library.materials.find(file.materials[i].name);
    if (found == library.materials.end()) continue;
    const Vec3 colour = file.materials[i].colour;
    file.materials[i] = found->second;
    file.materials[i].colour = colour;
    const auto pictures = library.pictures.find(found->first);
    if (pictures == library.pictures.end()) continue;
    file.pictures[i] = pictures->second;
    pictures->second.append_to(file.files);
  }
}

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
