// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SHAPE_MESH_DATA_HPP
#define PULSECAST_SHAPE_MESH_DATA_HPP

#include <pulsecast/geometry/triangle.hpp>
#include <pulsecast/shape/mask.hpp>

namespace PULSECAST_NAMESPACE {

/// Vertices and triangles of a mesh. Texture coordinates, in single precision, may jump at an edge.
struct MeshData {
  std::vector<Vec3> vertices{};                           ///< positions [m]
  std::vector<std::array<std::uint32_t, 3>> triangles{};  ///< vertices of the corners
  std::vector<std::uint32_t> materials{};                 ///< by triangle: index into the part's table; empty if all 0
  std::vector<std::array<Vec2, 3>> texture{};             ///< by triangle: coordinates of its corners, if any
  std::vector<Mask> masks{};                              ///< by material: its holes, by texture; none beyond

  /// @throws SettingError for no triangles, an index out of range, a vertex that is not finite,
  /// columns of different lengths, or masks without texture coordinates
  void validate() const {
    if (triangles.empty()) throw_setting_error("MeshData::triangles", 0, "", "at least one in number");
    validate_counts(vertices.size(), triangles.size());
    for (std::size_t i = 0; i < vertices.size(); ++i)
      for (int k = 0; k < 3; ++k)
        if (!std::isfinite(vertices[i][k]))
          reject_at("MeshData::vertices", vertices[i][k], "m", "finite; see vertex ", i, "");
    for (std::size_t i = 0; i < triangles.size(); ++i)
      for (const std::uint32_t corner : triangles[i])
        if (corner >= vertices.size())
          reject_at("MeshData::triangles", corner, "", "less than the number of vertices, ", vertices.size(),
                    "; see triangle " + std::to_string(i));
    if (!materials.empty() && materials.size() != triangles.size())
      reject_at("MeshData::materials", static_cast<double>(materials.size()), "", "as many as triangles, ",
                triangles.size(), ", or none");
    validate_texture();
  }

  /// Refuses counts beyond 32 bits before allocation. @throws SettingError
  static void validate_counts(std::size_t vertices, std::size_t triangles) {
    require_within("MeshData::vertices (number)", vertices, 0, 4294967295);
    require_within("MeshData::triangles (number)", triangles, 1, 4294967294);
  }

  /// Triangle i [m].
  [[nodiscard]] Triangle triangle(std::size_t i) const noexcept {
    const auto& corners = triangles[i];
    return {vertices[corners[0]], vertices[corners[1]], vertices[corners[2]]};
  }

 private:
  void validate_texture() const {
    if (!texture.empty() && texture.size() != triangles.size())
      reject_at("MeshData::texture", static_cast<double>(texture.size()), "", "as many as triangles, ",
                triangles.size(), ", or none");
    for (std::size_t i = 0; i < texture.size(); ++i)
      for (const Vec2& at : texture[i])
        for (int k = 0; k < 2; ++k)
          if (!(std::fabs(at[k]) <= 1e30))
            reject_at("MeshData::texture", at[k], "", "from -1e+30 to 1e+30; see triangle ", i, "");
    for (const Mask& mask : masks) {
      mask.validate();
      if (mask.width > 0 && texture.empty())
        throw_setting_error("MeshData::texture (number)", 0, "", "one a triangle, for masks");
    }
  }

  [[noreturn]] static void reject_at(const char* field, double value, const char* unit, std::string allowed,
                                     std::size_t number, const std::string& rest) {
    throw_setting_error(field, value, unit, allowed.append(std::to_string(number)).append(rest));
  }
};

}  // namespace PULSECAST_NAMESPACE

#endif
