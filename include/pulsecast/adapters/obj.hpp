// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <ios>
#include <istream>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <tiny_obj_loader.h>

#include <pulsecast/adapters/mtl.hpp>
#include <pulsecast/adapters/spectral_library.hpp>
#include <pulsecast/base/vector.hpp>
#include <pulsecast/scene/material.hpp>
#include <pulsecast/scene/triangle_mesh.hpp>

namespace pulsecast::adapters {

/// The axis of a file that points up.
enum class UpAxis : std::uint8_t {
  z,  ///< taken as it is
  y,  ///< (x, y, z) becomes (x, -z, y)
};

struct ObjSettings {
  UpAxis up = UpAxis::z;
  SpectralLibrary spectra{};  ///< what `helios_spectra` in an MTL file may name
};

/// What an OBJ file holds, all its objects and groups together.
struct ObjModel {
  MeshData mesh;                      ///< in the units of the file, which should be metres; no triangle is without area
  std::vector<Material> materials;    ///< those that triangles have, in order of first use
  std::vector<std::string> warnings;  ///< what was odd, but could be read
};

/// Reads an OBJ file and the MTL files that it names. Polygons are cut into triangles, also concave ones.
/// Throws a `FileError` with path and line at the first thing that cannot be right.
/// Limits: faces refer to vertices above them and have at most 4096 corners; coordinates stay within 1e12, where double resolves 0.1 mm,
/// and are right to some units in the last place.
[[nodiscard]] ObjModel read_obj(const std::filesystem::path& path, const ObjSettings& settings = {});

namespace detail {

inline constexpr std::size_t largest_polygon = 4096;  ///< corners; cutting takes time with their square

/// Cuts a polygon into triangles by clipping ears; a convex one becomes the fan about its first corner. Gives their corners' places in
/// the polygon, three each; empty if the outline crosses itself. Source: Meisters 1975, every simple polygon has two ears.
/// tinyobjloader 2.0 rc10 would cut them too, but loses parts of concave ones away from the origin.
[[nodiscard]] inline std::vector<std::array<std::size_t, 3>> triangulated(const std::vector<Vec3>& corners) {
  // Seen along the axis nearest to the normal, so that the outline runs counter-clockwise. Source: Newell, in Sutherland et al. 1974.
  Vec3 normal{};
  for (std::size_t i = 0; i < corners.size(); ++i) normal += cross(corners[i] - corners[0], corners[(i + 1) % corners.size()] - corners[0]);
  int axis = 2;
  for (const int k : {1, 0})
    if (std::fabs(normal[k]) > std::fabs(normal[axis])) axis = k;
  std::vector<Vec2> flat;
  for (const Vec3& corner : corners) {
    const Vec3 p = corner - corners[0];
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    flat.push_back(normal[axis] < 0 ? Vec2{p[v], p[u]} : Vec2{p[u], p[v]});
  }
  const auto left = [&](std::size_t a, std::size_t b, std::size_t c) {  // positive if the way from a over b to c turns left
    const Vec2 ab = flat[b] - flat[a], ac = flat[c] - flat[a];
    return ab.x * ac.y - ab.y * ac.x;
  };

  std::vector<std::size_t> ring(corners.size());
  std::iota(ring.begin(), ring.end(), std::size_t{0});
  const auto neighbours = [&](std::size_t i) { return std::pair{ring[(i + ring.size() - 1) % ring.size()], ring[(i + 1) % ring.size()]}; };
  const auto is_ear = [&](std::size_t i) {
    const auto [before, after] = neighbours(i);
    if (!(left(before, ring[i], after) > 0)) return false;
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const std::size_t p = ring[k];
      if (flat[p] == flat[before] || flat[p] == flat[ring[i]] || flat[p] == flat[after]) continue;
      if (left(before, ring[i], p) >= 0 && left(ring[i], after, p) >= 0 && left(after, before, p) >= 0) return false;
    }
    return true;
  };
  const auto is_straight = [&](std::size_t i) {
    const auto [before, after] = neighbours(i);
    return left(before, ring[i], after) == 0;
  };

  std::vector<std::array<std::size_t, 3>> triangles;
  std::size_t start = 1;
  while (ring.size() >= 3) {
    std::size_t i = start;
    while (i < start + ring.size() && !is_ear(i % ring.size())) ++i;
    if (i < start + ring.size()) {
      i %= ring.size();
      const auto [before, after] = neighbours(i);
      triangles.push_back({before, ring[i], after});
    } else {  // what is left may be folded flat
      for (i = 0; i < ring.size() && !is_straight(i);) ++i;
      if (i == ring.size()) return {};
    }
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(i));
    start = i;
  }
  return triangles;
}

class ObjReader : private StatementBuffer {
 public:
  ObjReader(const std::filesystem::path& path, const ObjSettings& settings)
      : StatementBuffer(path), folder_(path.parent_path()), settings_(settings) {}

  [[nodiscard]] ObjModel read() {
    tinyobj::callback_t callbacks;
    callbacks.vertex_cb = [](void* self, double x, double y, double z, double) { static_cast<ObjReader*>(self)->vertex({x, y, z}); };
    callbacks.index_cb = [](void* self, tinyobj::index_t* corners, int count) {
      static_cast<ObjReader*>(self)->face({corners, static_cast<std::size_t>(count)});
    };
    callbacks.usemtl_cb = [](void* self, const char* name, int) {
      ObjReader& reader = *static_cast<ObjReader*>(self);
      reader.use_ = {name, reader.line(), std::nullopt};
    };
    std::istream stream(this);
    stream.exceptions(std::ios::badbit);  // so that those thrown while it reads pass through
    tinyobj::LoadObjWithCallback(stream, callbacks, this);

    if (model_.mesh.triangles.empty())
      fail(flat_ > 0 ? "all its faces are without area: expected at least one that has some"
                     : "holds no face: expected at least one 'f' statement");
    if (cut_ > 0) warn(cut_, "the last line has no end: the file may have been cut short");
    if (unknown_ > 0)
      warn(first_unknown_.first, first_unknown_.second + " is not known and left out, the first of " + std::to_string(unknown_));
    if (flat_ > 0) warn(first_flat_, "a triangle without area is left out, the first of " + std::to_string(flat_));
    resolve_materials();
    return std::move(model_);
  }

 private:
  struct Use {
    std::string name = "default";
    std::size_t line = 0;
    std::optional<std::uint32_t> index;  ///< in `uses_`, once a face needs it
  };

  /// Statements that say nothing about surfaces, of those that the OBJ specification (Wavefront 1995) knows.
  static constexpr std::array<std::string_view, 15> ignored{"vn", "vt", "vp",     "vw",     "o",   "g",          "s",        "l",
                                                            "p",  "mg", "usemap", "maplib", "lod", "shadow_obj", "trace_obj"};

  std::string checked() override {
    const std::vector<std::string_view> given = words();
    if (keyword() == "v") {
      expect(given.size() >= 3 && std::all_of(given.begin(), given.begin() + 3, number_in<double>),
             "three finite numbers, none beyond 1e12");
    } else if (keyword() == "f") {
      expect(std::all_of(given.begin(), given.end(), is_corner), "corners of the form v, v/t, v//n or v/t/n, in whole numbers");
      expect(given.size() >= 3 && given.size() <= largest_polygon, "a face of 3 to 4096 corners");
    } else if (keyword() == "usemtl") {
      expect(!given.empty(), "the name of a material");
    } else if (keyword() == "mtllib") {
      libraries(given);  // tinyobjloader would read the first of several only
    } else if (std::find(ignored.begin(), ignored.end(), keyword()) == ignored.end()) {
      if (unknown_++ == 0) first_unknown_ = {line(), quoted()};
    }
    if (line_is_open() && (keyword() == "v" || keyword() == "f")) cut_ = line();
    return statement();
  }

  static bool is_corner(std::string_view word) {
    for (int k = 0; k < 3; ++k) {
      const std::size_t slash = word.find('/');
      const std::string_view part = word.substr(0, slash);
      if (!number_in<int>(part) && !(k == 1 && part.empty() && slash != word.npos)) return false;
      if (slash == word.npos) return true;
      word.remove_prefix(slash + 1);
    }
    return false;
  }

  void vertex(const Vec3& p) {
    expect(max_norm(p) <= largest_number, "three finite numbers, none beyond 1e12");
    if (model_.mesh.vertices.size() == std::numeric_limits<int>::max()) fail_here("expected fewer than 2^31 vertices");
    model_.mesh.vertices.push_back(settings_.up == UpAxis::y ? Vec3{p.x, -p.z, p.y} : p);
  }

  void face(std::span<const tinyobj::index_t> corners) {
    corners_.clear(), positions_.clear();
    const auto count = static_cast<std::int64_t>(model_.mesh.vertices.size());
    for (const tinyobj::index_t& corner : corners) {
      const std::int64_t index = corner.vertex_index < 0 ? count + corner.vertex_index : std::int64_t{corner.vertex_index} - 1;
      if (index < 0 || index >= count)
        fail_here(quoted() + " names vertex " + std::to_string(corner.vertex_index) + ": expected from 1 to the " + std::to_string(count) +
                  " vertices above, or from -1 backwards");
      corners_.push_back(static_cast<std::uint32_t>(index));
      positions_.push_back(model_.mesh.vertices[corners_.back()]);
    }
    if (corners_.size() == 3) return triangle(0, 1, 2);
    const auto triangles = triangulated(positions_);
    for (const auto& [a, b, c] : triangles) triangle(a, b, c);
    if (!triangles.empty()) return;
    warn(line(), "the outline of the polygon crosses itself: it becomes a fan about its first corner");
    for (std::size_t k = 2; k < corners_.size(); ++k) triangle(0, k - 1, k);
  }

  void triangle(std::size_t a, std::size_t b, std::size_t c) {
    const Vec3 area = cross(positions_[b] - positions_[a], positions_[c] - positions_[a]);
    if (area == Vec3{0, 0, 0}) {
      if (flat_++ == 0) first_flat_ = line();
      return;
    }
    model_.mesh.triangles.push_back({corners_[a], corners_[b], corners_[c]});
    model_.mesh.materials.push_back(material());
  }

  /// Number of the material in use; names get theirs when a triangle first needs them.
  [[nodiscard]] std::uint32_t material() {
    if (!use_.index) {
      use_.index = numbers_.try_emplace(use_.name, static_cast<std::uint32_t>(numbers_.size())).first->second;
      if (*use_.index == uses_.size()) uses_.push_back(use_);
    }
    return *use_.index;
  }

  /// `mtllib` names one file, whose name may have blanks, or several.
  void libraries(const std::vector<std::string_view>& names) {
    expect(!names.empty(), "the name of an MTL file");
    std::error_code ignored_error;
    if (std::filesystem::exists(library_path(rest()), ignored_error)) return library(rest());
    for (const std::string_view name : names) library(name);
  }

  [[nodiscard]] std::filesystem::path library_path(std::string_view name) const {
    std::string path(name);
    std::replace(path.begin(), path.end(), '\\', '/');
    return folder_ / path;
  }

  void library(std::string_view name) {
    const std::filesystem::path path = library_path(name);
    std::error_code ignored_error;
    if (!std::filesystem::is_regular_file(path, ignored_error))
      fail_here(quoted() + ": expected an MTL file at " + path.string() + ", but there is none");
    if (!read_.insert(path.string()).second) return;
    MaterialLibrary more = read_mtl(path, settings_.spectra);
    library_.merge(more.materials);  // of one name, the first counts
    model_.warnings.insert(model_.warnings.end(), more.warnings.begin(), more.warnings.end());
  }

  void resolve_materials() {
    for (const Use& use : uses_) {
      const auto found = library_.find(use.name);
      if (found == library_.end() && use.line > 0)
        warn(use.line, "no MTL file describes the material '" + use.name + "': its reflectance is taken to be 0.5");
      model_.materials.push_back(found == library_.end() ? undescribed(use.name) : found->second);
    }
  }

  void warn(std::size_t line, const std::string& text) {
    model_.warnings.push_back(path() + ", line " + std::to_string(line) + ": " + text);
  }

  std::filesystem::path folder_;
  ObjSettings settings_;
  ObjModel model_;
  std::map<std::string, Material, std::less<>> library_;
  std::set<std::string> read_;                    // MTL files
  Use use_;                                       // in force
  std::vector<Use> uses_;                         // that triangles have
  std::map<std::string, std::uint32_t> numbers_;  // of `uses_`, by name
  std::pair<std::size_t, std::string> first_unknown_;
  std::size_t unknown_ = 0, flat_ = 0, first_flat_ = 0;
  std::size_t cut_ = 0;                 // the line of a last statement without an end
  std::vector<std::uint32_t> corners_;  // of the face at hand
  std::vector<Vec3> positions_;
};

}  // namespace detail

inline ObjModel read_obj(const std::filesystem::path& path, const ObjSettings& settings) {
  return detail::ObjReader(path, settings).read();
}

}  // namespace pulsecast::adapters
