// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_OBJ_PIECE_HPP
#define PULSECAST_IO_DETAIL_OBJ_PIECE_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <limits>
#include <vector>

#include <pulsecast/io/detail/obj/polygon.hpp>
#include <pulsecast/io/detail/obj/statements.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Statements of part of an OBJ file, evaluated as far as they do not depend on earlier parts.
class ObjPiece : private Statements {
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

  /// Lines with the same oddity: their number, the first of them, and its text.
  struct Notes {
    std::size_t count = 0, line = no_line;
    std::string text{};

    void add(const Notes& more) {
      const std::size_t all = count + more.count;
      if (more.line < line) *this = more;
      count = all;
    }
  };

  ObjPiece(const std::string& path, std::string text, std::size_t lines_before, bool textured = false)
      : Statements(path, std::move(text), lines_before), textured_(textured) {}

  /// Reads up to the first error.
  void read() {
    try {
      while (next_statement()) take();
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
  std::vector<std::size_t> crossings;        ///< lines of polygons whose outline crosses itself
  Notes unknown, flat, coloured;             ///< unknown statements, faces without an area, vertices with colours
  std::size_t open_line = 0;                 ///< line of a last statement without end; 0: none
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

  /// Statements of the OBJ specification (Wavefront 1995) that do not concern surfaces.
  static constexpr std::array<std::string_view, 13> ignored{"vn", "vt", "vp", "vw",  "o",          "g",        "s",
                                                            "l",  "p",  "mg", "lod", "shadow_obj", "trace_obj"};

  void take() {
    const std::vector<std::string_view>& given = words();
    const std::string_view key = keyword();
    if ((key == "v" || key == "f") && line_is_open()) open_line = line();
    if (key == "v") {
      constexpr const char* expected = "three finite numbers, none beyond 1e12";
      require(given.size() >= 3, expected);
      vertices.emplace_back(number(given[0], expected), number(given[1], expected), number(given[2], expected));
      if (given.size() >= 6) coloured.add({1, line()});
    } else if (key == "f") {
      given.size() < 3 && !line_is_open() ? flat.add({1, line()}) : face(given);
    } else if (key == "usemtl") {
      uses.push_back({given.empty() ? "default" : std::string(rest()), line(), std::nullopt});
    } else if (key == "vt" && textured_) {
      constexpr const char* expected = "finite texture coordinates, none beyond 1e12";
      require(!given.empty() && given.size() <= 3, "one to three texture coordinates");
      places.emplace_back(number(given[0], expected), given.size() > 1 ? number(given[1], expected) : 0);
    } else if (key == "mtllib" && !given.empty()) {
      libraries.push_back({line(), quoted(), std::string(rest())});
    } else if (std::ranges::find(ignored, key) == ignored.end()) {
      unknown.add({1, line(), quoted()});
    }
  }

  [[nodiscard]] double number(std::string_view word, const char* expected) const {
    const std::optional<double> value = text::finite_number_in(word);
    require(value && std::fabs(*value) <= max_number, expected);
    return *value;
  }

  /// Numbers of the vertex, texture coordinates and normal of a corner, 0 for none; empty for other words.
  [[nodiscard]] static std::optional<std::array<int, 3>> corner_in(std::string_view word) {
    std::array<int, 3> numbers{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t slash = word.find('/');
      const std::optional<int> number = text::number_in<int>(word.substr(0, slash));
      if (!number && !(k == 1 && slash == 0)) return std::nullopt;
      numbers[k] = number.value_or(0);
      if (slash == word.npos) return numbers;
      word.remove_prefix(slash + 1);
    }
    return std::nullopt;
  }

  void face(const std::vector<std::string_view>& given) {
    for (const std::string_view word : given) {
      const std::optional<std::array<int, 3>> corner = corner_in(word);
      require(corner.has_value(), "corners of the form v, v/t, v//n or v/t/n, in whole numbers");
      corners_.push_back((*corner)[0]);
      if (textured_) place_corners_.push_back((*corner)[1]);
    }
    require(given.size() >= 3 && given.size() <= max_polygon_corners, "a face of 3 to 4096 corners");
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
    crossings.push_back(face.line);
    for (std::size_t k = 2; k < numbers_.size(); ++k) triangle(face, 0, k - 1, k);
  }

  void triangle(const Face& face, std::size_t a, std::size_t b, std::size_t c) {
    const Vec3 area = cross(positions_[b] - positions_[a], positions_[c] - positions_[a]);
    if (area == Vec3{0, 0, 0}) return flat.add({1, face.line});
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
