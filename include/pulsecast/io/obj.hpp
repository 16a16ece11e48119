// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <ios>
#include <istream>
#include <limits>
#include <map>
#include <memory>
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

#include <pulsecast/base/parallel.hpp>
#include <pulsecast/base/vector.hpp>
#include <pulsecast/io/mtl.hpp>
#include <pulsecast/io/spectral_library.hpp>
#include <pulsecast/scene/material.hpp>
#include <pulsecast/scene/triangle_mesh.hpp>

namespace pulsecast::io {

/// Vertical axis of a file.
enum class UpAxis : std::uint8_t {
  z,  ///< coordinates unchanged
  y,  ///< (x, y, z) becomes (x, -z, y)
};

/// Settings for OBJ files.
struct ObjSettings {
  UpAxis up = UpAxis::z;      ///< vertical axis of the file
  SpectralLibrary spectra{};  ///< spectra for `helios_spectra` in MTL files
};

/// Content of an OBJ file, all objects and groups together.
struct ObjModel {
  MeshData mesh;                      ///< in units of the file, which should be metres; without triangles of zero area
  std::vector<Material> materials;    ///< materials of triangles, in order of first use
  std::vector<std::string> warnings;  ///< oddities that could still be read
};

/// Reads an OBJ file and its MTL files. Polygons, concave ones included, are triangulated. Warns if no face has an area, or an MTL file is
/// missing; its materials become `undescribed`. Uses up to `threads` threads, 0 as in `thread_count`, and holds some megabytes of the file
/// at most. Throws a `FileError` with path and line at the first error.
/// Limits: faces refer to vertices above them and have at most 4096 corners; coordinates stay within 1e12, where a double resolves 0.1 mm,
/// and are accurate to some units in the last place.
[[nodiscard]] ObjModel read_obj(const std::filesystem::path& path, const ObjSettings& settings = {}, unsigned threads = 0);

namespace detail {

inline constexpr std::size_t max_polygon_corners = 4096;  ///< upper limit; triangulation takes quadratic time

/// Triangulates a polygon by ear clipping; a convex one becomes the fan about its first corner. Returns corner indices, three a triangle;
/// empty if the outline crosses itself. Source: Meisters 1975, every simple polygon has two ears.
/// tinyobjloader 2.0 rc10 triangulates, too, but loses parts of concave polygons away from the origin.
[[nodiscard]] inline std::vector<std::array<std::size_t, 3>> triangulated(const std::vector<Vec3>& corners) {
  // projection along the axis nearest to the normal, counter-clockwise. Source: Newell, in Sutherland et al. 1974.
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
  const auto left = [&](std::size_t a, std::size_t b, std::size_t c) {  // positive if the path from a over b to c turns left
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
    } else {  // the rest may be folded flat
      for (i = 0; i < ring.size() && !is_straight(i);) ++i;
      if (i == ring.size()) return {};
    }
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(i));
    start = i;
  }
  return triangles;
}

/// Statements of part of an OBJ file, evaluated as far as they do not depend on earlier parts.
class ObjPiece : private StatementBuffer {
 public:
  /// Name of a material, line of its `usemtl`, and number once a triangle needs it.
  struct Use {
    std::string name = "default";
    std::size_t line = 0;
    std::optional<std::uint32_t> number;
  };

  /// An `mtllib` statement.
  struct Libraries {
    std::size_t line;
    std::string quoted, rest;
    std::vector<std::string> names;
  };

  /// First error and its line.
  struct Failure {
    std::size_t line = std::numeric_limits<std::size_t>::max();
    std::exception_ptr error;
  };

  /// Text about a line.
  struct Note {
    std::size_t line;
    std::string text;
  };

  ObjPiece(const std::string& path, std::string text, std::size_t lines_before, UpAxis up)
      : StatementBuffer(path, std::move(text), lines_before), up_(up) {}

  /// Reads up to the first error.
  void read() {
    tinyobj::callback_t callbacks;
    callbacks.vertex_cb = [](void* self, double x, double y, double z, double) { static_cast<ObjPiece*>(self)->vertex({x, y, z}); };
    callbacks.index_cb = [](void* self, tinyobj::index_t* corners, int count) {
      static_cast<ObjPiece*>(self)->face({corners, static_cast<std::size_t>(count)});
    };
    callbacks.usemtl_cb = [](void* self, const char* name, int) {
      ObjPiece& piece = *static_cast<ObjPiece*>(self);
      piece.uses.push_back({name, piece.line(), std::nullopt});
    };
    try {
      std::istream stream(this);
      stream.exceptions(std::ios::badbit);  // lets exceptions pass that are thrown while reading
      tinyobj::LoadObjWithCallback(stream, callbacks, this);
    } catch (...) {
      failure = {line(), std::current_exception()};
    }
  }

  /// Triangulates the faces up to the first error. `all` has the vertices of this piece and the `before` vertices of earlier ones.
  void triangulate(std::span<const Vec3> all, std::size_t before) {
    triangles.reserve(faces_.size()), triangle_uses.reserve(faces_.size());
    std::span<const int> rest = corners_;
    for (const Face& face : faces_) {
      const auto given = rest.first(face.corners);
      rest = rest.subspan(face.corners);
      numbers_.clear(), positions_.clear();
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

  std::vector<Vec3> vertices;
  std::vector<Use> uses = std::vector<Use>(1);  ///< the first is in force from earlier pieces
  std::vector<Libraries> libraries;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> triangle_uses;  ///< index into `uses` for each triangle
  std::vector<Note> crossings;               ///< polygons whose outline crosses itself
  std::optional<Note> first_unknown, first_flat;
  std::size_t unknown = 0, flat = 0;
  std::size_t open_line = 0;  ///< line of a last statement without end; 0 if there is none
  Failure failure;

 private:
  /// Polygon of a face.
  struct Face {
    std::size_t line;
    std::uint32_t corners, above, use;  ///< number of corners; vertices of this piece above it; index into `uses`
  };

  /// Statements of the OBJ specification (Wavefront 1995) that do not concern surfaces.
  static constexpr std::array<std::string_view, 15> ignored{"vn", "vt", "vp",     "vw",     "o",   "g",          "s",        "l",
                                                            "p",  "mg", "usemap", "maplib", "lod", "shadow_obj", "trace_obj"};

  void check(std::string& ready) override {
    const std::vector<std::string_view>& given = words();
    if (keyword() == "v") {
      require(given.size() >= 3 && std::all_of(given.begin(), given.begin() + 3, number_in<double>),
              "three finite numbers, none beyond 1e12");
    } else if (keyword() == "f" && given.size() < 3 && !line_is_open()) {
      add_flat(line());
      return;
    } else if (keyword() == "f") {
      require(std::all_of(given.begin(), given.end(), is_corner), "corners of the form v, v/t, v//n or v/t/n, in whole numbers");
      require(given.size() >= 3 && given.size() <= max_polygon_corners, "a face of 3 to 4096 corners");
    } else if (keyword() == "usemtl" && given.empty()) {
      uses.push_back({"default", line(), std::nullopt});
      return;
    } else if (keyword() != "usemtl") {
      if (keyword() == "mtllib" && !given.empty()) {  // tinyobjloader would read only the first of several
        libraries.push_back({line(), quoted(), std::string(rest()), {given.begin(), given.end()}});
      } else if (std::find(ignored.begin(), ignored.end(), keyword()) == ignored.end()) {
        if (unknown++ == 0) first_unknown = {line(), quoted()};
      }
      return;
    }
    if (line_is_open() && keyword() != "usemtl") open_line = line();
    ready = statement();
  }

  /// Counts a face without area.
  void add_flat(std::size_t line) {
    ++flat;
    if (!first_flat || line < first_flat->line) first_flat = {line, {}};
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
    require(max_norm(p) <= max_number, "three finite numbers, none beyond 1e12");
    vertices.push_back(up_ == UpAxis::y ? Vec3{p.x, -p.z, p.y} : p);
  }

  void face(std::span<const tinyobj::index_t> given) {
    for (const tinyobj::index_t& corner : given) corners_.push_back(corner.vertex_index);
    faces_.push_back({line(), static_cast<std::uint32_t>(given.size()), static_cast<std::uint32_t>(vertices.size()),
                      static_cast<std::uint32_t>(uses.size() - 1)});
  }

  /// Records that a face refers to a missing vertex.
  void reject(std::size_t face_line, int corner, std::int64_t count) {
    try {
      rewind();
      while (next_statement() && line() < face_line) continue;
      fail_here(quoted() + " refers to vertex " + std::to_string(corner) + ": expected from 1 to the " + std::to_string(count) +
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
    crossings.push_back({face.line, "the outline of the polygon crosses itself: it becomes a fan about its first corner"});
    for (std::size_t k = 2; k < numbers_.size(); ++k) triangle(face, 0, k - 1, k);
  }

  void triangle(const Face& face, std::size_t a, std::size_t b, std::size_t c) {
    const Vec3 area = cross(positions_[b] - positions_[a], positions_[c] - positions_[a]);
    if (area == Vec3{0, 0, 0}) {
      add_flat(face.line);
      return;
    }
    triangles.push_back({numbers_[a], numbers_[b], numbers_[c]});
    triangle_uses.push_back(face.use);
  }

  UpAxis up_;
  std::vector<Face> faces_;
  std::vector<int> corners_;            // of all faces, as numbered in the file
  std::vector<std::uint32_t> numbers_;  // of the current face
  std::vector<Vec3> positions_;
};

/// Reader of a file in windows of some pieces. Pieces are read in parallel, and triangulated in parallel once the vertices before them are
/// known; results are joined in the order of the file.
class ObjReader {
 public:
  ObjReader(const std::filesystem::path& path, const ObjSettings& settings, unsigned threads,
            std::size_t piece_bytes = StatementFile::piece_bytes)
      : file_(path), folder_(path.parent_path()), settings_(settings), threads_(thread_count(threads)), piece_bytes_(piece_bytes) {}

  [[nodiscard]] ObjModel read() {
    while (read_window()) continue;
    MeshData& mesh = model_.mesh;
    if (open_line_ > 0) warn(open_line_, "the last line has no line end: the file may be truncated");
    if (unknown_ > 0)
      warn(first_unknown_->line, first_unknown_->text + " is not known and left out, the first of " + std::to_string(unknown_));
    if (flat_ > 0) warn(first_flat_->line, "a face without area is left out, the first of " + std::to_string(flat_));
    if (mesh.triangles.empty())
      model_.warnings.push_back(file_.path() + ": holds no face with an area: expected at least one 'f' statement of such a one");
    resolve_materials();
    return std::move(model_);
  }

 private:
  using Note = ObjPiece::Note;
  using Use = ObjPiece::Use;

  /// Reads the next window; false at the end of the file.
  bool read_window() {
    std::vector<std::unique_ptr<ObjPiece>> pieces;
    while (pieces.size() < std::size_t{4} * threads_) {
      std::string text = file_.next(piece_bytes_);
      if (text.empty()) break;
      const auto lines = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
      pieces.push_back(std::make_unique<ObjPiece>(file_.path(), std::move(text), lines_, settings_.up));
      lines_ += lines;
    }
    for_each_index(pieces.size(), threads_, [&](std::size_t i) { pieces[i]->read(); });
    std::vector<Vec3>& vertices = model_.mesh.vertices;
    std::vector<std::size_t> before;  // number of vertices before each piece
    for (const auto& piece : pieces) {
      before.push_back(vertices.size());
      vertices.insert(vertices.end(), piece->vertices.begin(), piece->vertices.end());
      if (vertices.size() > std::numeric_limits<int>::max()) file_.fail("has too many vertices: expected fewer than 2^31");
    }
    for_each_index(pieces.size(), threads_, [&](std::size_t i) { pieces[i]->triangulate(vertices, before[i]); });
    for (const auto& piece : pieces) add(*piece);
    return !pieces.empty();
  }

  void add(ObjPiece& piece) {
    auto crossing = piece.crossings.begin();
    const auto warn_before = [&](std::size_t line) {
      for (; crossing != piece.crossings.end() && crossing->line < line; ++crossing) warn(crossing->line, crossing->text);
    };
    for (const ObjPiece::Libraries& statement : piece.libraries) {
      if (statement.line > piece.failure.line) break;
      warn_before(statement.line);
      libraries(statement);
    }
    if (piece.failure.error) std::rethrow_exception(piece.failure.error);
    warn_before(std::numeric_limits<std::size_t>::max());

    piece.uses.front() = use_;
    MeshData& mesh = model_.mesh;
    mesh.triangles.insert(mesh.triangles.end(), piece.triangles.begin(), piece.triangles.end());
    for (const std::uint32_t use : piece.triangle_uses) mesh.materials.push_back(material(piece.uses[use]));
    use_ = piece.uses.back();
    if (unknown_ == 0) first_unknown_ = piece.first_unknown;
    if (flat_ == 0) first_flat_ = piece.first_flat;
    unknown_ += piece.unknown, flat_ += piece.flat;
    open_line_ = std::max(open_line_, piece.open_line);
  }

  /// Number of a material in use, assigned when a triangle first needs it.
  [[nodiscard]] std::uint32_t material(Use& use) {
    if (!use.number) {
      use.number = numbers_.try_emplace(use.name, static_cast<std::uint32_t>(numbers_.size())).first->second;
      if (*use.number == uses_.size()) uses_.push_back(use);
    }
    return *use.number;
  }

  /// Reads the files of `mtllib`: one file, whose name may have blanks, or several.
  void libraries(const ObjPiece::Libraries& statement) {
    std::error_code ignored_error;
    if (std::filesystem::exists(library_path(statement.rest), ignored_error)) return library(statement.rest, statement);
    for (const std::string& name : statement.names) library(name, statement);
  }

  [[nodiscard]] std::filesystem::path library_path(std::string path) const {
    std::replace(path.begin(), path.end(), '\\', '/');
    return folder_ / path;
  }

  void library(const std::string& name, const ObjPiece::Libraries& statement) {
    const std::filesystem::path path = library_path(name);
    std::error_code ignored_error;
    if (!std::filesystem::is_regular_file(path, ignored_error)) {
      warn(statement.line, statement.quoted + ": expected an MTL file at " + path.string() + ", but there is none");
      return;
    }
    if (!read_.insert(path.string()).second) return;  ///< the first of equal names counts
    MaterialLibrary more = read_mtl(path, settings_.spectra);
    library_.merge(more.materials);  // of one name, the first counts
    model_.warnings.insert(model_.warnings.end(), more.warnings.begin(), more.warnings.end());
  }

  void resolve_materials() {
    for (const Use& use : uses_) {
      const auto found = library_.find(use.name);
      if (found == library_.end() && use.line > 0)
        warn(use.line, "no MTL file describes the material '" + use.name + "': a reflectance of 0.5 is assumed");
      model_.materials.push_back(found == library_.end() ? undescribed(use.name) : found->second);
    }
  }

  void warn(std::size_t line, const std::string& text) {
    model_.warnings.push_back(file_.path() + ", line " + std::to_string(line) + ": " + text);
  }

  StatementFile file_;
  std::filesystem::path folder_;
  ObjSettings settings_;
  unsigned threads_;
  std::size_t piece_bytes_, lines_ = 0;  // `lines_`: number of lines read
  ObjModel model_;
  std::map<std::string, Material, std::less<>> library_;
  std::set<std::string> read_;                    // paths of MTL files
  Use use_;                                       // in force
  std::vector<Use> uses_;                         // in use by triangles
  std::map<std::string, std::uint32_t> numbers_;  // indices into `uses_` by name
  std::optional<Note> first_unknown_, first_flat_;
  std::size_t unknown_ = 0, flat_ = 0;
  std::size_t open_line_ = 0;
};

}  // namespace detail

inline ObjModel read_obj(const std::filesystem::path& path, const ObjSettings& settings, unsigned threads) {
  return detail::ObjReader(path, settings, threads).read();
}

}  // namespace pulsecast::io
