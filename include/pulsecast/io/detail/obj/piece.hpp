// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_OBJ_PIECE_HPP
#define PULSECAST_IO_DETAIL_OBJ_PIECE_HPP

#include <exception>
#include <istream>

#include <tiny_obj_loader.h>

#include <pulsecast/io/detail/obj/polygon.hpp>
#include <pulsecast/io/detail/obj/statements.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Statements of part of an OBJ file, evaluated as far as they do not depend on earlier parts.
class ObjPiece : private StatementBuffer {
 public:
  /// Name of a material, line of its `usemtl`, and number once a triangle needs it.
  struct Use {
    std::string name = "default";
    std::size_t line = 0;
    std::optional<std::uint32_t> number;
  };

  struct Libraries {
    std::size_t line;
    std::string quoted, rest;
  };

  static constexpr std::size_t no_line = std::numeric_limits<std::size_t>::max();

  ObjPiece(const std::string& path, std::string text, std::size_t lines_before, bool textured = false)
      : StatementBuffer(path, std::move(text), lines_before), textured_(textured) {}

  /// Reads up to the first error.
  void read() {
    tinyobj::callback_t callbacks;
    callbacks.vertex_cb = [](void* self, double x, double y, double z, double) {
      static_cast<ObjPiece*>(self)->vertex({x, y, z});
    };
    callbacks.index_cb = [](void* self, tinyobj::index_t* corners, int count) {
      static_cast<ObjPiece*>(self)->face({corners, static_cast<std::size_t>(count)});
    };
    callbacks.usemtl_cb = [](void* self, const char* name, int) { static_cast<ObjPiece*>(self)->use(name); };
    try {
      std::istream stream(this);
      stream.exceptions(std::ios::badbit);  // passes on exceptions thrown while reading
      tinyobj::LoadObjWithCallback(stream, callbacks, this);
    } catch (...) {
      failure = {line(), std::current_exception()};
    }
  }

  /// Triangulates the faces up to the first error. `all`: `before` vertices of earlier pieces, and
  /// those of this one, z up. `all_places`, `places_before`: texture coordinates.
  void triangulate(std::span<const Vec3> all, std::size_t before, std::span<const Vec2> all_places = {},
                   std::size_t places_before = 0) {
    triangles.reserve(faces_.size());
    triangle_uses.reserve(faces_.size());
    std::size_t first = 0;
    for (const Face& face : faces_) {
      const auto given = std::span(corners_).subspan(first, face.corners);
      if (textured_)
        take_places(face, std::span(place_corners_).subspan(first, face.corners), all_places, places_before);
      first += face.corners;
      numbers_.clear();
      positions_.clear();
      const auto count = static_cast<std::int64_t>(before + face.above);
      for (const int corner : given) {
        const std::int64_t index = corner < 0 ? count + corner : std::int64_t{corner} - 1;
        if (index < 0 || index >= count) return reject(face.line, corner, count);
        numbers_.push_back(static_cast<std::uint32_t>(index));
        positions_.push_back(all[numbers_.back()]);
      }
      cut(face);
    }
  }

  std::vector<Vec3> vertices;                   ///< vertices as in the file
  std::vector<Vec2> places;                     ///< texture coordinates
  std::vector<Use> uses = std::vector<Use>(1);  ///< the first is in force from earlier pieces
  std::vector<Libraries> libraries;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> triangle_uses;  ///< index into `uses` for each triangle
  std::vector<std::array<Vec2, 3>> texture;  ///< texture coordinates of each triangle, if read
  std::vector<std::size_t> without_place;    ///< by use: corners without texture coordinates
  StatementNotes notes{obj_rules};
  struct {
    std::size_t line = no_line;
    std::exception_ptr error;
  } failure;  ///< first error

 private:
  struct Face {
    std::size_t line;
    std::uint32_t corners, above, use;  ///< their number; vertices above; index into `uses`
    std::uint32_t places_above;         ///< texture coordinates of this piece above it
  };

  void check(std::string& ready) override {
    const std::vector<std::string_view>& given = words();
    if (keyword() == "v") {
      require(given.size() >= 3 && std::all_of(given.begin(), given.begin() + 3, number_in<double>),
              "three finite numbers, none beyond 1e12");
      if (given.size() >= 5) keep("v x y z r g b");
      if ((given.size() == 4 || given.size() == 7) && given[3] != "1" && number_in<double>(given[3]) != 1)
        keep("v x y z w");
    } else if (keyword() == "f" && given.size() < 3 && !line_is_open()) {
      return notes.keep("f without area", path(), line(), "");
    } else if (keyword() == "f") {
      require(std::ranges::all_of(given, is_corner), "corners of the form v, v/t, v//n or v/t/n, in whole numbers");
      require(given.size() >= 3 && given.size() <= max_polygon_corners, "a face of 3 to 4096 corners");
    } else if (keyword() == "usemtl" && given.empty()) {
      return use("default");
    } else if (keyword() == "vt" && textured_) {
      return place(given);
    } else if (keyword() != "usemtl") {
      if (keyword() == "mtllib" && !given.empty()) {  // tinyobjloader reads only the first
        libraries.push_back({line(), quoted(), std::string(rest())});
      } else if (keyword() != "vn") {                   // of which there are many
        keep(keyword() == "mtllib" ? "*" : keyword());  // which names no file
      }
      return;
    }
    if (line_is_open() && keyword() != "usemtl") notes.keep("cut line", path(), line(), "");
    ready = statement();
  }

  void keep(std::string_view name) { notes.keep(name, path(), line(), statement()); }

  void remark() override {
    if (const std::string_view kind = kind_of_comment(statement()); !kind.empty()) keep(text::message("# ", kind));
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

  void use(const char* name) { uses.push_back({name, line(), std::nullopt}); }

  void vertex(const Vec3& p) {
    require(is_within(p, max_number), "three finite numbers, none beyond 1e12");
    vertices.push_back(p);
  }

  void place(const std::vector<std::string_view>& given) {
    Vec2 at{};
    require(!given.empty() && given.size() <= 3, "one to three texture coordinates");
    for (std::size_t k = 0; k < std::min(given.size(), std::size_t{2}); ++k) {
      const auto number = number_in<double>(given[k]);
      require(number && std::fabs(*number) <= max_number, "finite texture coordinates, none beyond 1e12");
      at[static_cast<int>(k)] = *number;
    }
    places.push_back(at);
  }

  void face(std::span<const tinyobj::index_t> given) {
    for (const tinyobj::index_t& corner : given) corners_.push_back(corner.vertex_index);
    if (textured_)
      for (const tinyobj::index_t& corner : given) place_corners_.push_back(corner.texcoord_index);
    const auto whole = [](std::size_t count) { return static_cast<std::uint32_t>(count); };
    faces_.push_back(
        {line(), whole(given.size()), whole(vertices.size()), whole(uses.size() - 1), whole(places.size())});
  }

  /// Takes the texture coordinates of a face; (0, 0) where it has none, or refers to missing ones.
  void take_places(const Face& face, std::span<const int> given, std::span<const Vec2> all, std::size_t before) {
    face_places_.clear();
    const auto count = static_cast<std::int64_t>(before + face.places_above);
    without_place.resize(uses.size());
    for (const int corner : given) {
      const std::int64_t index = corner < 0 ? count + corner : std::int64_t{corner} - 1;
      const bool known = index >= 0 && index < count;
      face_places_.push_back(known ? all[static_cast<std::size_t>(index)] : Vec2{});
      without_place[face.use] += known ? 0 : 1;
    }
  }

  void reject(std::size_t face_line, int corner, std::int64_t count) {
    try {
      rewind();
      while (next_statement() && line() < face_line) continue;
      fail_here(quoted(), " refers to vertex ", corner, ": expected from 1 to the ", count,
                " vertices above, or from -1 backwards");
    } catch (...) {
      failure = {face_line, std::current_exception()};
    }
  }

  /// Triangulates the current polygon.
  void cut(const Face& face) {
    if (numbers_.size() == 3) return triangle(face, 0, 1, 2);
    const auto pieces = triangulated(positions_);
    for (const auto& [a, b, c] : pieces) triangle(face, a, b, c);
    if (!pieces.empty()) return;
    notes.keep("f that crosses itself", path(), face.line, "");
    for (std::size_t k = 2; k < numbers_.size(); ++k) triangle(face, 0, k - 1, k);
  }

  void triangle(const Face& face, std::size_t a, std::size_t b, std::size_t c) {
    const Vec3 area = cross(positions_[b] - positions_[a], positions_[c] - positions_[a]);
    if (area == Vec3{0, 0, 0}) return notes.keep("f without area", path(), face.line, "");
    triangles.push_back({numbers_[a], numbers_[b], numbers_[c]});
    triangle_uses.push_back(face.use);
    if (textured_) texture.push_back({face_places_[a], face_places_[b], face_places_[c]});
  }

  bool textured_;
  std::vector<Face> faces_;
  std::vector<int> corners_;            ///< of all faces, as numbered in the file
  std::vector<int> place_corners_;      ///< texture coordinates of those, if they are read
  std::vector<std::uint32_t> numbers_;  ///< vertices of the current face
  std::vector<Vec2> face_places_;       ///< texture coordinates of the current face
  std::vector<Vec3> positions_;         ///< positions of those
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
